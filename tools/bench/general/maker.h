// Building blocks for the scenes of families: random numbers, bodies, joints.
#pragma once

#include "tools/bench/general/scene.h"
#include "tools/bench/general/vectors.h"

namespace lockstone::bench {

/// SplitMix64: the same numbers everywhere, for no distribution of a standard library is.
class SceneRandom {
 public:
  explicit SceneRandom(std::uint64_t seed) : state_(seed) {}
  [[nodiscard]] std::uint64_t bits();
  /// In [low, high).
  [[nodiscard]] double between(double low, double high);
  /// The same, evenly in the logarithm; both above 0.
  [[nodiscard]] double log_between(double low, double high);
  /// From low to high, both included.
  [[nodiscard]] int count(int low, int high);
  [[nodiscard]] bool chance(double share) { return between(0, 1) < share; }

 private:
  std::uint64_t state_;
};

class SceneMaker {
 public:
  SceneMaker(std::string_view family, std::uint64_t seed, int cap);

  GeneralScene scene;
  SceneRandom random;

  /// A random count within the cap. Families take every count of theirs from here.
  [[nodiscard]] int count(int low, int high);
  /// A unit vector.
  [[nodiscard]] Triple direction();
  /// Within ± size a component.
  [[nodiscard]] Triple jitter(double size);
  [[nodiscard]] Turn any_turn();

  int add(GeneralBody body);
  int box(const Triple& half_extents, const Triple& at, double density = 1000);
  int ball(double radius, const Triple& at, double density = 1000);
  /// Its core is along y.
  int capsule(double radius, double half_core, const Triple& at, double density = 1000);
  int hull(std::vector<Triple> points, const Triple& at, double density = 1000);
  /// 200 m square, its top at y = 0.
  int ground();
  /// A fixed body without contacts, from which joints hang.
  int anchor(const Triple& at);
  GeneralBody& body(int index) { return scene.bodies[static_cast<std::size_t>(index)]; }
  void fix(int index) { body(index).motion = Motion::fixed; }
  void turn(int index, const Turn& by) { body(index).orientation = by; }
  /// Of all bodies so far.
  void set_friction(double friction);
  void set_density(int index, double density) { body(index).density = density; }
  void set_mass(int index, double mass);
  void watch(int index) { scene.watched.push_back(index); }

  /// At a place of the world, as the bodies stand now; x of its frames is along `axis`.
  GeneralJoint& join(Link link, int a, int b, const Triple& at, const Triple& axis = {0, 0, 1});
  GeneralJoint& rod(int a, int b, const Triple& at_a, const Triple& at_b);

  /// The error of the family and its bound.
  void judge(Judge judge, double bound, double seconds);

 private:
  int cap_;
};

/// A trunk, a head and four limbs of two parts each.
void add_ragdoll(SceneMaker& maker, const Triple& at);

/// A box, ball or capsule of about this size, m.
int any_body(SceneMaker& m, double size, const Triple& at, double density);

/// Place `i` of layers of side × side, `pitch` apart, over the origin.
[[nodiscard]] Triple cell(int i, int side, double pitch);

/// A box as a part of a compound.
[[nodiscard]] GeneralPart slab(const Triple& half, const Triple& at,
                               const Turn& turn = {0, 0, 0, 1});

/// Four fixed walls around a square of this half width, over the ground.
void pen(SceneMaker& m, double half, double high);

/// A pile that has to sleep by the end.
void heap(SceneMaker& m, double seconds);

/// The families of each kind.
void add_loop_families(std::vector<Family>& all);
void add_drive_families(std::vector<Family>& all);
void add_stack_families(std::vector<Family>& all);
void add_wall_families(std::vector<Family>& all);
void add_friction_families(std::vector<Family>& all);
void add_impact_families(std::vector<Family>& all);
void add_handling_families(std::vector<Family>& all);
void add_motion_families(std::vector<Family>& all);
void add_rest_families(std::vector<Family>& all);
void add_machine_families(std::vector<Family>& all);
void add_furniture_families(std::vector<Family>& all);
void add_jumble_families(std::vector<Family>& all);
void add_event_families(std::vector<Family>& all);
void add_driven_families(std::vector<Family>& all);
void add_strike_families(std::vector<Family>& all);
void add_shape_families(std::vector<Family>& all);

}  // namespace lockstone::bench
