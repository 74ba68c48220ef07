// Towers that fall asleep, and events that wake them, one after the other.
#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

// In the order of creation, which nothing changes.
constexpr std::uint32_t k_floor_index = 1;
constexpr std::uint32_t k_lift_index = 2;

constexpr std::uint64_t k_floor_goes = 70;
constexpr std::uint64_t k_ball_comes = 100;
constexpr std::uint64_t k_lift_starts = 130;
constexpr std::uint64_t k_lift_stops = 160;

void build_sleep(World& world, std::uint64_t, const SceneValues& values) {
  const int towers = values[0], stacked = values[1];
  add_ground(world, 30_m);
  add(world, fixed_box({-12_m, 0.25_m, {}}, {1.5_m, 0.25_m, 1.5_m}));
  BodyDef lift = fixed_box({-8_m, 0.25_m, {}}, {1.5_m, 0.25_m, 1.5_m});
  lift.motion = MotionType::kinematic;
  add(world, lift);
  add_stack(world, {-12_m, 0.5_m, {}}, stacked);
  add_stack(world, {-8_m, 0.5_m, {}}, stacked);
  for (int i = 0; i < towers; ++i)
    add_stack(world, {millimetres(-4000 + 3000 * i), {}, {}}, stacked);
}

void drive_sleep(World& world, std::uint64_t seed) {
  const auto lift_at = [&](Velocity speed) {
    order(world, SetVelocity{world.body_at(k_lift_index), {{}, speed, {}}});
  };
  switch (world.tick()) {
    case k_floor_goes:
      order(world, Teleport{world.body_at(k_floor_index), {-20_m, 0.25_m, {}}, {}});
      break;
    case k_ball_comes: {
      Random random(seed);
      BodyDef ball = loose(Shape::sphere(0.5_m), {-4_m, 3_m, 12_m});
      ball.velocity = {Velocity::from_ratio(random.between(-500, 500), 1000), {}, -14_mps};
      add(world, ball);
      break;
    }
    case k_lift_starts:
      lift_at(0.5_mps);
      break;
    case k_lift_stops:
      lift_at({});
      break;
    default:
      break;
  }
}

}  // namespace

constinit const Scene k_sleep{
    .name = "sleep",
    .description = "towers fall asleep; a floor, a ball, a lift wake them",
    .golden_ticks = 300,
    .define = small_world,
    .builder = build_sleep,
    .drive = drive_sleep,
    .own_parameters = {{{"towers", 6, 1, 11}, {"boxes each", 4, 1, 20}}}};

}  // namespace lockstone::scenes
