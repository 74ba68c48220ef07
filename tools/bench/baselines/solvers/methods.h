// The methods that are compared: each takes one island through one substep.
#pragma once

#include <map>
#include <vector>

#include "tools/bench/baselines/solvers/block_factor.h"
#include "tools/bench/baselines/solvers/options.h"
#include "tools/bench/baselines/solvers/problem.h"
#include "tools/bench/baselines/solvers/system.h"

namespace lockstone::bench::trial {

struct Counts {
  long phases = 0, direct_steps = 0, factors = 0, unconverged = 0, sweeps = 0, banked = 0;
  double least_pivot = 1e300, greatest_pivot = 0, greatest_jump = 0;
  long blocks = 0;
};

// Soft constraints, a relaxing pass without bias; see box2d.org/posts/2024/02/solver2d.
class SoftSteps {
 public:
  SoftSteps(System& system, Problem& problem, const Options& options, double h)
      : system_(system), problem_(problem), options_(options), h_(h) {}
  void substep();
  void restitution();

 private:
  struct Softness {
    double bias_rate = 0, mass_scale = 1, impulse_scale = 0;
  };
  [[nodiscard]] Softness softness(double hertz, double damping) const;
  void make_groups();
  void pass(bool bias);
  void solve_group(std::size_t first, std::size_t count, bool bias);
  void solve_drive(Row& row, bool bias);
  void solve_contact(std::size_t row, bool bias);
  [[nodiscard]] Softness stiffened(Softness soft, const Row& row) const;

  System& system_;
  Problem& problem_;
  const Options& options_;
  double h_;
  std::vector<std::pair<std::size_t, std::size_t>> groups_;  // first row and count, of joints
};

// One proximal problem, solved to convergence: Gauss-Seidel iterations find the active set, direct
// steps with an exact line search on the dual solve for it.
class Proximal {
 public:
  Proximal(System& system, Problem& problem, BlockFactor& factor, const Options& options, double h,
           Counts& counts);
  void substep();

 private:
  void fall(double seconds);
  void set_gives();
  void set_centres();
  void scale_warm_start();
  void set_biases(bool bias);
  void set_joint_errors();
  void phase(bool bias);
  double sweep();
  double sweep_one(std::size_t row);
  void mark_active();
  void factor();
  bool direct_step();
  void candidate(const std::vector<Vec6>& change, std::vector<double>& next) const;
  double search(const std::vector<double>& next);
  void stiffen();
  void round_impulses();

  System& system_;
  Problem& problem_;
  BlockFactor& factor_;
  const Options& options_;
  double h_;
  Counts& counts_;
  std::vector<char> factored_;  // active set of the factor at hand; empty: none
  std::vector<double> residual_;
  double gain_ = 0;
  double mass_ = 0;
  bool jointed_ = false;
};

// Augmented vertex block descent (Giles, Diaz, Yuksel 2025).
class Descent {
 public:
  Descent(System& system, Problem& problem, const Options& options, double h);
  void substep();

 private:
  struct Pose {
    Vec3 position;
    Quat rotation;
  };
  void begin();
  void begin_row(Row& row);
  void predict();
  void refresh_joints();
  void descend(int unknown);
  void update_dual(std::size_t row);
  void finish();
  [[nodiscard]] Vec6 shift(int unknown, const Pose& from) const;
  [[nodiscard]] double error(const Row& row) const;
  [[nodiscard]] double force(std::size_t row) const;
  [[nodiscard]] double pull(std::size_t row) const;

  System& system_;
  Problem& problem_;
  const Options& options_;
  double h_;
  std::vector<std::vector<int>> rows_of_;
  std::vector<double> stiffness_, start_error_;
  std::vector<Pose> start_;
  std::vector<Vec6> inertial_, moved_, base_;  // from the start, mass normalised
};

}  // namespace lockstone::bench::trial
