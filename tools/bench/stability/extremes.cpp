// Slender bodies, fast spins, the edge of the world.
#include <array>

#include <lockstone/literals.h>
#include <lockstone/testing/floating.h>

#include "tools/bench/stability/stability_scene.h"

namespace lockstone::bench {
namespace {

using namespace literals;

// Needles and plates whose moments differ by up to 10,000 : 1 fall into a pile.
StabilityResult slender(double seconds) {
  SceneRun scene(k_usual_setting, contact_world());
  scene.add(ground());
  for (int i = 0; i < 24; ++i) {
    const Shape shape =
        i % 2 == 0 ? Shape::box(0.7_m, 0.007_m, 0.007_m) : Shape::box(0.5_m, 0.005_m, 0.5_m);
    BodyDef def = body_at(shape, i % 3 * 0.2 - 0.2, 0.3 + 0.15 * i, i % 4 * 0.2 - 0.3);
    def.orientation = from_axis_angle({{}, {}, 1_r}, Angle::from_ratio(i * 37 % 100, 100));
    scene.add(def);
  }
  const auto [speed] = worst_of(scene, seconds, greatest_speed);
  return stability_of(
      scene, {{"greatest speed", "m/s", speed, 15},
              {"lowest centre below the floor", "m", greatest_depth(scene.world()), 0.005}});
}

// Twice the energy of turning, over the mass, of a box.
double turning_energy(const BodyView& body, const std::array<double, 3>& half) {
  const Mat3 axes = to_matrix(body.orientation);
  double energy = 0;
  for (int i = 0; i < 3; ++i) {
    double rate = 0;
    for (int k = 0; k < 3; ++k)
      rate += testing::to_double(axes.column(i)[k]) * testing::to_double(body.angular_velocity[k]);
    const double a = half[static_cast<std::size_t>((i + 1) % 3)];
    const double b = half[static_cast<std::size_t>((i + 2) % 3)];
    energy += (a * a + b * b) / 3 * rate * rate;
  }
  return energy;
}

// A box of three different moments that spins as fast as its surface may move.
StabilityResult spin(double seconds) {
  WorldDef def = contact_world();
  def.gravity = {};
  SceneRun scene(k_usual_setting, def);
  BodyDef box = body_at(Shape::box(0.1_m, 0.2_m, 0.3_m), 0, 0, 0);
  box.angular_velocity = fixed<AngularVelocity>(150, 900, 150);
  const BodyHandle body = scene.add(box);
  scene.step();  // the first tick limits bodies that are too fast
  const std::array<double, 3> half{0.1, 0.2, 0.3};
  const double before = turning_energy(scene.world().body(body), half);
  const auto energy_off = [&](const World& world) {
    return std::abs(turning_energy(world.body(body), half) / before - 1);
  };
  const auto [off, norm] = worst_of(scene, seconds, energy_off, worst_norm);
  return stability_of(scene, {{"energy of turning, relative", "", off, 0.1},
                              {"quaternion's length off 1", "", norm, 1e-8}});
}

// Thrown at each of its six sides.
StabilityResult edge(double seconds) {
  WorldDef def = contact_world();
  def.gravity = {};
  SceneRun scene(k_usual_setting, def);
  for (int i = 0; i < 12; ++i) {
    BodyDef ball = body_at(Shape::sphere(0.5_m), 3 * i, 0, 0);
    const int axis = i % 3;
    const bool low = i % 6 < 3;
    ball.position[axis] = low ? -k_world_limit + 10_m : k_world_limit - 10_m;
    ball.velocity[axis] = Velocity::from_integer(low ? -300 : 300);
    scene.add(ball);
  }
  const auto most_beyond = [](const World& world) {
    double most = 0;
    for_bodies(world, [&](const BodyView& body) {
      for (int i = 0; i < 3; ++i)
        most = std::max(most, testing::to_double(abs(body.position[i]) - k_world_limit));
    });
    return most;
  };
  const auto [beyond] = worst_of(scene, seconds, most_beyond);
  return stability_of(scene, {{"beyond the edge", "m", beyond, 0},
                              {"speed left", "m/s", greatest_speed(scene.world()), 300}});
}

constexpr StabilityRow k_rows[] = {
    {"slender", "needles and plates fall into a pile", 600, slender},
    {"spin", "a box spins at the limit of speed", 600, spin},
    {"edge", "balls are thrown out of the world", 600, edge},
};

}  // namespace

std::span<const StabilityRow> extreme_rows() {
  return k_rows;
}

}  // namespace lockstone::bench
