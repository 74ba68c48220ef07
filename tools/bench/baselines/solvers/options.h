// Settings of the methods that are compared.
#pragma once

namespace lockstone::bench::trial {

enum class Method { soft, proximal, descent };

struct Options {
  Method method = Method::soft;
  int substeps = 4;
  // Soft steps.
  int iterations = 1;   // with bias
  int relaxations = 1;  // without
  double contact_hertz = 30;
  double contact_damping = 10;
  double joint_hertz = 60;
  double joint_damping = 2;
  double push = 3;       // m/s: fastest push out of an overlap
  double carry = 0;      // soft rows are pulled towards this times the last substep's impulse
  double soft_leak = 0;  // taken from that impulse first, of the impulse g h / w
  double stiffen = 0;    // extra stiffness of contacts that carry many times the lighter body
  // Proximal problem.
  double give = 1e-3;     // ε: compliance over a row's weight
  double overload = 200;  // times its weight's impulse: from twice that on contacts give less
  double joint_give = 1.0 / 4096;
  double keep_normal = 0.9;  // κ
  double keep_tangent = 1;
  double leak = 0.5;    // most that a normal's centre loses, of the impulse g h / w of its weight
  int newton = 3;       // direct steps a phase
  int joint_steps = 3;  // of them, least where there are joints
  int first_sweeps = 2;
  int sweeps = 4;
  double tolerance = 1e-4;  // m/s
  double least_gain = 0;  // stop when a direct step lowers D by less than this times m g² h² / 2
  bool reuse = true;      // keep a factor while matrix and active set stay
  bool geometric = true;
  bool half_kick = false;
  bool scale_warm_start = true;
  double beta = 9;               // 1/s: overlap worked off
  bool nonlinear = true;         // joints: residual at the predicted pose
  int largest_direct = 1 << 30;  // rows; larger islands take soft steps
  int round_impulse = 0;         // bits after the point of w λ, m/s; 0: off
  int round_factor = 0;          // bits of mantissa; 0: off
  int round_pose = 0;            // bits after the point of positions and rotations; 0: off
  // Vertex block descent.
  int descents = 5;
  double least_stiffness = 0.3;  // of m / h²
  double ramp = 500;             // of m / h² a metre
  double forget_impulse = 0.99;
  double forget_stiffness = 0.999;
};

}  // namespace lockstone::bench::trial
