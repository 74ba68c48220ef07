// The buggy: anybody may get into it, drive it, and get out again.
#include <algorithm>

#include <lockstone/literals.h>

#include "tools/arena/integers.h"
#include "tools/arena/level.h"
#include "tools/arena/motion.h"
#include "tools/arena/rules.h"
#include "tools/arena/tags.h"

namespace lockstone::arena {
namespace {

using namespace lockstone::literals;

constexpr Length k_ride_reach = 2.2_m;
constexpr Position k_lost_height = -6_m;
constexpr SolverVelocity k_top_speed = 11_mps;
constexpr SolverVelocity k_slow = 1.5_mps;
constexpr std::uint32_t k_lying_ticks = 120;
constexpr std::int32_t k_quarter_turn = 16384, k_full_lock = 8192;  // 1/65536 turns

constexpr Unit k_one = Unit::from_integer(1);

bool drives(const Arena& arena, std::size_t slot) {
  return arena.state.game.driver == slot + 1;
}

Vec3<Position> beside(const Arena& arena, const Vec3<Length>& offset) {
  const Transform pose = pose_of(arena.world, arena.level.buggy);
  return moved(pose.position, rounded<Length>(rotate(to_matrix(pose.orientation), offset)));
}

void put(Arena& arena, PlayerRecord& player, const Vec3<Position>& place) {
  const Vec3<Velocity> velocity = arena.world.velocity(arena.level.buggy);
  order(arena.world, Teleport{player.body, place, Quat{}});
  order(arena.world, SetVelocity{player.body, velocity});
  player.velocity = solver_velocity(velocity);
}

bool enter(Arena& arena, std::size_t slot) {
  World& world = arena.world;
  const PlayerRecord& player = arena.state.players[slot];
  if (arena.state.game.driver != 0 || !world.exists(arena.level.buggy)) return false;
  const Vec3<Length> way =
      offset_between(world.position(player.body), world.position(arena.level.buggy));
  if (squared_raw(way) > squared_raw({k_ride_reach, {}, {}})) return false;
  release(arena, slot);
  arena.state.game.driver = static_cast<std::uint32_t>(slot + 1);
  // While it sits there the player meets nothing, and nothing sees it.
  order(world, SetFilter{player.body, {.category = 0, .mask = 0}});
  return true;
}

// The stick says where to go, as on foot; behind, the buggy backs away with its wheels turned the
// other way.
VehicleControls controls_for(const Arena& arena, const Input& input) {
  const Transform pose = pose_of(arena.world, arena.level.buggy);
  const Mat3 axes = to_matrix(pose.orientation);
  const Vec3<Length> stick{
      Length::from_ratio(input.move_x, 127), {}, Length::from_ratio(input.move_z, 127)};
  const Vec3<SolverVelocity> velocity = solver_velocity(arena.world.velocity(arena.level.buggy));
  const SolverVelocity ahead = rounded<SolverVelocity>(dot(axes.x, velocity));
  VehicleControls controls;
  controls.handbrake = (input.buttons & k_jump) != 0 ? k_one : Unit{};
  if (input.move_x == 0 && input.move_z == 0) {
    controls.brake = Unit::from_ratio(1, 2);
    controls.handbrake = abs(ahead) < k_slow ? k_one : controls.handbrake;
    return controls;
  }
  const Vec3<Length> seen = rounded<Length>(rotate_inverse(axes, stick));
  const std::int32_t aside = yaw_of(seen.x.raw, seen.z.raw);
  const bool backs = std::abs(aside) > k_quarter_turn + k_quarter_turn / 4;
  if (backs && ahead > k_slow) {
    controls.brake = k_one;
    return controls;
  }
  controls.gear = backs ? -1 : 1;
  controls.steer =
      backs ? (aside > 0 ? -k_one : k_one)
            : Unit::from_ratio(std::clamp(aside, -k_full_lock, k_full_lock), k_full_lock);
  const SolverVelocity most = backs ? k_top_speed / 3 : k_top_speed;
  if (abs(ahead) < most) controls.throttle = Unit::from_ratio(3, 4);
  return controls;
}

void stand_up(Arena& arena, const Vec3<Position>& place, const Quat& orientation) {
  const BodyHandle buggy = arena.level.buggy;
  order(arena.world, Teleport{buggy, place, orientation});
  order(arena.world, SetVelocity{buggy, {}});
  order(arena.world, SetAngularVelocity{buggy, {}});
  order(arena.world, SetVehicle{buggy, buggy_wheels()});
  arena.state.game.lying_ticks = 0;
}

}  // namespace

void leave_buggy(Arena& arena, std::size_t slot) {
  if (!drives(arena, slot)) return;
  arena.state.game.driver = 0;
  order(arena.world, SetFilter{arena.state.players[slot].body, filter_on_foot(slot)});
  order(arena.world, DriveVehicle{arena.level.buggy, {.handbrake = k_one}});
  put(arena, arena.state.players[slot], beside(arena, {{}, 1_m, -1.4_m}));
}

bool ride(Arena& arena, std::size_t slot, const Input& input, std::uint8_t pressed) {
  const bool changes = (pressed & k_ride) != 0;
  if (drives(arena, slot)) {
    if (changes) leave_buggy(arena, slot);
    if (changes) return false;
  } else if (!changes || !enter(arena, slot)) {
    return false;
  }
  put(arena, arena.state.players[slot], beside(arena, {-0.2_m, 1.15_m, {}}));
  order(arena.world, DriveVehicle{arena.level.buggy, controls_for(arena, input)});
  return true;
}

void look_after_buggy(Arena& arena) {
  World& world = arena.world;
  const BodyHandle buggy = arena.level.buggy;
  if (!world.exists(buggy)) return;
  if (arena.state.game.driver != 0) {
    // Loose bodies that it hits are the driver's.
    const std::size_t driver = arena.state.game.driver - std::size_t{1};
    for (const HitEvent& hit : hit_events(world)) {
      if (hit.a == buggy && world.exists(hit.b)) claim(arena, hit.b, driver);
      if (hit.b == buggy && world.exists(hit.a)) claim(arena, hit.a, driver);
    }
  }
  const Transform pose = pose_of(world, buggy);
  if (pose.position.y < k_lost_height) {
    if (arena.state.game.driver != 0) leave_buggy(arena, arena.state.game.driver - std::size_t{1});
    const BodyDef start = buggy_def();
    return stand_up(arena, start.position, start.orientation);
  }
  const bool lies = to_matrix(pose.orientation).y.y < Unit::from_ratio(3, 10);
  arena.state.game.lying_ticks = lies ? arena.state.game.lying_ticks + 1 : 0;
  if (arena.state.game.lying_ticks < k_lying_ticks) return;
  stand_up(arena, moved(pose.position, {{}, 1_m, {}}), buggy_def().orientation);
}

}  // namespace lockstone::arena
