// A net of balls, hung along one edge. Numbers, sizes and places are those of Box3D's benchmark
// "joint grid" (Erin Catto, shared/benchmarks.c).
#include <lockstone/literals.h>

#include "tools/bench/speed/speed_scene.h"
#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using namespace literals;

constexpr int k_side = 100;

World make_joint_grid(BroadPhaseKind broad_phase) {
  WorldDef def = speed_def(broad_phase, k_side * k_side, 200'000, 1024);
  def.joint_capacity = 2 * k_side * k_side;
  def.sleep_ms = 0;
  World world = make_speed_world(def);
  const auto at = [&](int column, int row) {
    return world.body_at(static_cast<std::uint32_t>(row * k_side + column));
  };
  const auto tie = [&](BodyHandle a, BodyHandle b, Length x, Length y) {
    JointDef joint = JointDef::of(JointKind::ball, a, b);
    joint.frame_a.position = {x, y, {}};
    joint.frame_b.position = {-x, -y, {}};
    scenes::order(world, CreateJoint{joint});
  };
  for (int row = 0; row < k_side; ++row) {
    for (int column = 0; column < k_side; ++column) {
      BodyDef ball = scenes::loose(
          Shape::sphere(0.4_m), {Position::from_integer(column), Position::from_integer(-row), {}});
      ball.filter.mask = 0;
      if (row == 0) ball.motion = MotionType::static_body;
      scenes::add(world, ball);
      if (row == 0) continue;
      if (column > 0) tie(at(column - 1, row), at(column, row), 0.5_m, {});
      tie(at(column, row - 1), at(column, row), {}, -0.5_m);
    }
  }
  return world;
}

}  // namespace

constinit const SpeedScene k_joint_grid{"joint-grid", "100 x 100 balls in a net of 19,701 joints",
                                        100, make_joint_grid};

}  // namespace lockstone::bench
