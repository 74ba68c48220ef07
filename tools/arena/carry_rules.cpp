// Taking, carrying and throwing.
#include <array>

#include <lockstone/literals.h>

#include "tools/arena/input.h"
#include "tools/arena/integers.h"
#include "tools/arena/motion.h"
#include "tools/arena/rules.h"
#include "tools/arena/tags.h"

namespace lockstone::arena {
namespace {

using namespace lockstone::literals;

constexpr Length k_grab_reach = 1.2_m;
constexpr Length k_grab_radius = 1_m;
constexpr Length k_carry_distance = 1.15_m;
constexpr Length k_carry_height = 0.5_m;
constexpr Length k_lose_distance = 3_m;
constexpr Mass k_carry_mass = 120_kg;
constexpr int k_carry_pull = 10;  // per second: a distance of 1 m is closed at 10 m/s
constexpr SolverVelocity k_carry_speed = 12_mps;
constexpr SolverVelocity k_throw_speed = 11_mps;
constexpr SolverVelocity k_throw_lift = 3.5_mps;

constexpr std::uint32_t k_all = 0xffffffff;

bool is_held(const Arena& arena, BodyHandle body) {
  for (std::size_t slot = 0; slot < arena.config.players; ++slot) {
    if (arena.state.players[slot].held == body) return true;
  }
  return false;
}

// The nearest body in front that may be taken; the lower index when two are as near.
BodyHandle find_grabbable(const Arena& arena, const PlayerRecord& player) {
  const World& world = arena.world;
  const Vec3<Position> center =
      moved(world.position(player.body), along(direction_of(player.yaw), k_grab_reach));
  std::array<BodyHandle, 32> found{};
  const std::size_t count =
      world.overlap_sphere(center, k_grab_radius, found, {.mask = k_loose_bit});
  BodyHandle best{};
  std::int64_t best_distance = 0;
  for (std::size_t i = 0; i < count; ++i) {
    if (world.mass(found[i]) > k_carry_mass || is_held(arena, found[i])) continue;
    const std::int64_t distance = squared_raw(offset_between(center, world.position(found[i])));
    if (!best.is_null() && distance >= best_distance) continue;
    best = found[i];
    best_distance = distance;
  }
  return best;
}

void take(Arena& arena, std::size_t slot) {
  PlayerRecord& player = arena.state.players[slot];
  const BodyHandle body = find_grabbable(arena, player);
  if (body.is_null()) return;
  player.held = body;
  Tag tag = tag_of(arena.world, body);
  tag.owner = static_cast<std::uint8_t>(slot + 1);
  order(arena.world, SetUserData{body, tag.pack()});
  // The carrier's own group: the two do not collide while this lasts.
  order(arena.world, SetFilter{body, {k_loose_bit, k_all, -static_cast<std::int32_t>(slot) - 1}});
}

Vec3<Length> way_to_hand(const Arena& arena, const PlayerRecord& player) {
  Vec3<Length> hand = along(direction_of(player.yaw), k_carry_distance);
  hand.y = k_carry_height;
  const Vec3<Position> target = moved(arena.world.position(player.body), hand);
  return offset_between(arena.world.position(player.held), target);
}

// Velocity proportional to the way, limited: a carried body pushes others aside, not through walls.
void pull(Arena& arena, std::size_t slot) {
  const PlayerRecord& player = arena.state.players[slot];
  const Vec3<Length> way = way_to_hand(arena, player);
  const std::int64_t limit = squared_raw({k_lose_distance, {}, {}});
  if (squared_raw(way) > limit) return release(arena, slot);
  const auto speed = [](Length distance) {
    return SolverVelocity::from_raw(distance.raw * k_carry_pull);
  };
  const Vec3<SolverVelocity> wanted{speed(way.x), speed(way.y), speed(way.z)};
  const Vec3<SolverVelocity> velocity = shortened(wanted, k_carry_speed);
  order(arena.world, SetVelocity{player.held, master_velocity(velocity)});
  order(arena.world, SetAngularVelocity{player.held, {}});
}

void throw_held(Arena& arena, std::size_t slot) {
  const PlayerRecord& player = arena.state.players[slot];
  const BodyHandle body = player.held;
  Vec3<SolverVelocity> velocity = along(direction_of(player.yaw), k_throw_speed);
  velocity.y = k_throw_lift;
  release(arena, slot);
  order(arena.world, SetVelocity{body, master_velocity(velocity)});
}

}  // namespace

void release(Arena& arena, std::size_t slot) {
  BodyHandle& held = arena.state.players[slot].held;
  if (arena.world.exists(held)) order(arena.world, SetFilter{held, {k_loose_bit, k_all, 0}});
  held = {};
}

void release_from_all(Arena& arena, BodyHandle body) {
  for (std::size_t slot = 0; slot < arena.config.players; ++slot) {
    if (arena.state.players[slot].held == body) release(arena, slot);
  }
}

void carry(Arena& arena, std::size_t slot, bool wants) {
  PlayerRecord& player = arena.state.players[slot];
  if (!arena.world.exists(player.held)) player.held = {};
  if (player.held.is_null()) {
    const bool pressed = wants && (player.buttons & k_grab) == 0;
    if (pressed) take(arena, slot);
  } else if (!wants) {
    throw_held(arena, slot);
    return;
  }
  if (!player.held.is_null()) pull(arena, slot);
}

}  // namespace lockstone::arena
