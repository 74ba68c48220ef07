// Bodies, joints and contacts in double, which every method of the comparison moves.
#pragma once

#include <memory>
#include <vector>

#include <lockstone/hull.h>
#include <lockstone/shape.h>

#include "tools/bench/baselines/solvers/vectors.h"

namespace lockstone::bench::trial {

struct Body {
  Shape shape;
  std::shared_ptr<const Hull> hull;
  double mass = 0;     // kg; 0: fixed
  Mat3 local_inertia;  // kg m², about the centre, in the body's axes
  double radius = 0;   // m, around the centre
  Vec3 position;
  Quat rotation;
  Vec3 velocity;
  Vec3 spin;  // rad/s
  // Follow from the rotation: see update.
  Mat3 axes, inertia, inverse_inertia;
  bool touches_others = true;
  Vec3 previous_velocity;  // of block descent

  [[nodiscard]] bool fixed() const { return mass == 0; }
  [[nodiscard]] Vec3 to_world(const Vec3& local) const { return axes * local; }
  [[nodiscard]] Vec3 to_local(const Vec3& world) const { return transposed(axes) * world; }
};

void update(Body& body);

enum class JointKind { ball, hinge, slider, weld };

struct Joint {
  JointKind kind = JointKind::ball;
  int a = 0, b = 0;
  Vec3 anchor_a, anchor_b;  // local
  Mat3 frame_a, frame_b;    // local; x is the axis
  bool motor = false;
  double speed = 0;          // rad/s or m/s
  double max_effort = 1e30;  // N m or N
  bool limited = false;
  double lower = 0, upper = 0;
  double spring_rate = 0;     // rad/s; 0: none
  double spring_damping = 0;  // ratio
  std::array<double, 8> impulse{};
  std::array<double, 8> stiffness{};  // of block descent
};

struct Contact {
  int a = 0, b = 0;
  std::uint32_t feature = 0;
  Vec3 normal, anchor_a, anchor_b;  // anchors turn with the bodies: local
  Vec3 arm_a, arm_b;                // of the tick's start, world axes
  double rest_separation = 0;       // separation minus the anchors' distance along the normal
  double separation = 0;            // now
  double friction = 0, restitution = 0;
  double approach = 0;  // normal velocity at the tick's start
  double peak = 0;      // greatest normal impulse of the tick
  Mat3 frame;           // x: normal, y and z: tangents
  std::array<double, 3> impulse{};
  std::array<double, 3> stiffness{};  // of block descent
};

struct System {
  std::vector<Body> bodies;
  std::vector<Joint> joints;
  std::vector<Contact> contacts;
  Vec3 gravity{0, -9.81, 0};
  double friction = 0.6, restitution = 0;
  double margin = 0.02;  // m: contacts are made before bodies touch

  int add_box(const Vec3& half, const Vec3& position, double density, const Quat& rotation = {});
  int add_sphere(double radius, const Vec3& position, double density);
  int add_capsule(double half_height, double radius, const Vec3& position, double density,
                  const Quat& rotation = {});
  int add_hull(const std::vector<Vec3>& points, const Vec3& position, double density,
               const Quat& rotation = {});
  int add_ground();
  void set_mass(int body, double mass);
  int add_joint(JointKind kind, int a, int b, const Vec3& at, const Vec3& axis = {0, 0, 1});
  [[nodiscard]] double kinetic_energy() const;
  [[nodiscard]] double energy() const;
};

// Finds the contacts of the bodies' present poses by the core's own narrow phase; contacts keep
// their impulses by feature.
void collide(System& system);

// Separation at the present poses.
[[nodiscard]] double separation(const System& system, const Contact& contact);

// Moves the body by its velocity; turning it never raises its kinetic energy.
void move(Body& body, double h);

}  // namespace lockstone::bench::trial
