// Scenes of a game's actors: cars that race over hills, characters that walk about. Their bots'
// commands and queries are timed with the steps.
#include <lockstone/character.h>
#include <lockstone/vector_math.h>

#include "tools/bench/speed/speed_scene.h"
#include "tools/scenes/build.h"
#include "tools/scenes/scene.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using scenes::millimetres;

constexpr std::uint64_t k_seed = 1;
constexpr std::uint64_t k_walking = 1;  // user data of characters
constexpr int k_row = 20, k_walkers = 200;

World make_race(BroadPhaseKind broad_phase) {
  WorldDef def = scenes::k_race.define();
  def.broad_phase = broad_phase;
  World world = make_speed_world(def, scenes::k_race.assets(k_seed));
  scenes::k_race.build(world, k_seed);
  return world;
}

void drive_racers(World& world) {
  scenes::k_race.drive(world, k_seed);
}

// On 80 m by 80 m, with a crate beside every second one.
World make_walkers(BroadPhaseKind broad_phase) {
  World world = make_speed_world(speed_def(broad_phase, 512, 8192, 4096));
  scenes::add_ground(world, 40_m);
  BodyDef walker{.motion = MotionType::kinematic, .shape = Shape::capsule(0.5_m, 0.3_m)};
  walker.filter = {.category = 2, .mask = 0};  // queries see it, nothing touches it
  walker.user_data = k_walking;
  for (int i = 0; i < k_walkers; ++i) {
    walker.position = {millimetres(-36'000 + i % k_row * 3800), 0.85_m,
                       millimetres(-36'000 + i / k_row * 7600)};
    scenes::add(world, walker);
    if (i % 2 == 0)
      scenes::add(world, scenes::loose(Shape::box(0.4_m, 0.4_m, 0.4_m),
                                       walker.position + Vec3<Position>{1.5_m, -0.45_m, 1.5_m}));
  }
  return world;
}

// Straight on for 2.5 s; home from near the edge of the ground.
Vec3<Unit> direction_of(const World& world, std::uint32_t body, const Vec3<Position>& at) {
  if (abs(at.x) > 38_m || abs(at.z) > 38_m) return normalized(Vec3<Position>{-at.x, {}, -at.z});
  const std::uint64_t drawn =
      scenes::mix((std::uint64_t{body} << 32) + (world.tick() + body) / 150);
  const Angle angle = Angle::from_ratio(static_cast<std::int64_t>(drawn % 6283), 1000);
  return rotate(to_matrix(from_axis_angle(scenes::k_y_axis, angle)), scenes::k_x_axis);
}

// One move of each in a tick, as a game makes that keeps the last one.
void drive_walkers(World& world) {
  constexpr Length k_stride = 0.045_m, k_drop = 0.05_m;
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyHandle body = world.body_at(i);
    const BodyView view = world.body(body);
    if (view.user_data != k_walking) continue;
    CharacterDef def;
    def.shape = view.shape;
    def.filter.ignore = body;
    const Vec3<Unit> ahead = direction_of(world, i, view.position);
    const Vec3<Length> way{rounded<Length>(ahead.x * k_stride), -k_drop,
                           rounded<Length>(ahead.z * k_stride)};
    const CharacterMove move = move_character(world, def, view.position, way, true);
    apply_pushes(world, def, move);
    scenes::order(world, MoveKinematic{body, move.position, view.orientation});
  }
}

}  // namespace

constinit const SpeedScene k_race{
    "race", "16 cars race over hills, driven by bots", 300, make_race, drive_racers, true};
constinit const SpeedScene k_walkers_200{
    "walkers", "200 characters walk about among 100 crates", 300, make_walkers, drive_walkers,
    true};

}  // namespace lockstone::bench
