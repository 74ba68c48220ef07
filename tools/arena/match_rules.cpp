// The tick, and the rules that need no player: machines, goals, falls.
#include <algorithm>
#include <utility>

#include <lockstone/literals.h>

#include "tools/arena/integers.h"
#include "tools/arena/level.h"
#include "tools/arena/rules.h"
#include "tools/arena/tags.h"

namespace lockstone::arena {
namespace {

using namespace lockstone::literals;

constexpr Position k_fall_height = -6_m;
constexpr Velocity k_ferry_speed = 1.5_mps;
constexpr std::uint16_t k_respawn_ticks = 60;
constexpr std::uint16_t k_hill_point_ticks = 60;
constexpr std::int32_t k_knock_off_points = 5;

void drive_machines(Arena& arena) {
  if (arena.level.ferry.is_null()) return;
  // It starts in the middle of its way: half a leg forth, then whole legs back and forth.
  const std::uint64_t leg = (arena.world.tick() + k_ferry_leg_ticks / 2) / k_ferry_leg_ticks;
  const Velocity speed = leg % 2 == 0 ? k_ferry_speed : -k_ferry_speed;
  order(arena.world, SetVelocity{arena.level.ferry, {{}, {}, speed}});
}

// Crates give 1 point, balls 2, barrels 3.
std::int32_t points_for(Kind kind) {
  return static_cast<std::int32_t>(kind) - static_cast<std::int32_t>(Kind::crate) + 1;
}

void stop(World& world, BodyHandle body) {
  order(world, SetVelocity{body, {}});
  order(world, SetAngularVelocity{body, {}});
}

// A loose body reappears high above a random place of the field, and nobody owns it.
void reappear(Arena& arena, BodyHandle body) {
  release_from_all(arena, body);
  Random random(arena.state.game.random);
  const std::int32_t x = random.between(-12'000, 12'000);
  const std::int32_t z = random.between(-17'000, 17'000);
  const std::int32_t y = random.between(6'000, 9'000);
  arena.state.game.random = random.state();
  order(arena.world, Teleport{body, {millimetres(x), millimetres(y), millimetres(z)}, Quat{}});
  stop(arena.world, body);
  Tag tag = tag_of(arena.world, body);
  tag.owner = 0;
  order(arena.world, SetUserData{body, tag.pack()});
}

void enter_goal(Arena& arena, BodyHandle body) {
  const Tag tag = tag_of(arena.world, body);
  if (!tag.is_loose()) return;
  if (tag.owner >= 1 && tag.owner <= arena.config.players) {
    add_score(arena.state.players[tag.owner - 1U], points_for(tag.kind));
    ++arena.state.game.goals;
  }
  reappear(arena, body);
}

void hold_hill(Arena& arena, BodyHandle body) {
  const Tag tag = tag_of(arena.world, body);
  if (tag.kind != Kind::player || tag.number >= arena.config.players) return;
  PlayerRecord& player = arena.state.players[tag.number];
  if (++player.hill_ticks < k_hill_point_ticks) return;
  player.hill_ticks = 0;
  add_score(player, 1);
}

void enter_zone(Arena& arena, const ContactEvent& event) {
  for (const auto& [zone, body] : {std::pair{event.a, event.b}, std::pair{event.b, event.a}}) {
    if (zone != arena.level.goals[0] && zone != arena.level.goals[1]) continue;
    enter_goal(arena, body);
  }
}

void stay_in_zone(Arena& arena, const ContactEvent& event) {
  if (event.a == arena.level.hill) hold_hill(arena, event.b);
  if (event.b == arena.level.hill) hold_hill(arena, event.a);
}

void fall(Arena& arena, std::size_t slot) {
  PlayerRecord& player = arena.state.players[slot];
  release(arena, slot);
  leave_buggy(arena, slot);
  player.respawn_ticks = k_respawn_ticks;
  ++arena.state.game.falls;
  add_score(player, -1);
  const bool knocked = player.rival >= 1 && player.rival <= arena.config.players;
  if (knocked && player.rival != slot + 1) {
    add_score(arena.state.players[player.rival - 1U], k_knock_off_points);
  }
  player.rival = 0;
}

void return_player(Arena& arena, std::size_t slot) {
  PlayerRecord& player = arena.state.players[slot];
  if (!arena.world.exists(player.body)) return;
  if (player.respawn_ticks == 0) {
    if (arena.world.position(player.body).y < k_fall_height) fall(arena, slot);
    return;
  }
  if (--player.respawn_ticks > 0) return;
  order(arena.world, Teleport{player.body, spawn_point(slot), Quat{}});
  stop(arena.world, player.body);
  player.velocity = {};
}

void melt(Arena& arena, ShotRecord& shot) {
  if (shot.body.is_null()) return;
  if (shot.ticks_left > 0) --shot.ticks_left;
  if (shot.ticks_left > 0) return;
  order(arena.world, DestroyBody{shot.body});
  shot = {};
}

}  // namespace

// A player or a snowball that hits something owns it.
void touch(Arena& arena, BodyHandle by, BodyHandle body) {
  const Tag hand = tag_of(arena.world, by);
  Tag tag = tag_of(arena.world, body);
  if (!tag.is_loose()) return;
  std::uint8_t owner = 0;
  if (hand.kind == Kind::player) owner = static_cast<std::uint8_t>(hand.number + 1);
  if (hand.kind == Kind::snowball) owner = hand.owner;
  if (owner == 0 || owner == tag.owner) return;
  tag.owner = owner;
  order(arena.world, SetUserData{body, tag.pack()});
}

void add_score(PlayerRecord& player, std::int32_t points) {
  player.score = std::clamp(player.score + points, -k_max_score, k_max_score);
}

void score_events(Arena& arena) {
  for (const ContactEvent& event : arena.world.events()) {
    // An earlier event may have ended in a body's move, never in its end; still, be certain.
    if (!arena.world.exists(event.a) || !arena.world.exists(event.b)) continue;
    if (event.kind == EventKind::contact_begin) {
      touch(arena, event.a, event.b);
      touch(arena, event.b, event.a);
    } else if (event.kind == EventKind::trigger_enter) {
      enter_zone(arena, event);
    } else if (event.kind == EventKind::trigger_stay) {
      stay_in_zone(arena, event);
    }
  }
}

void retire(Arena& arena) {
  for (std::size_t slot = 0; slot < arena.config.players; ++slot)
    return_player(arena, slot);
  for (const BodyHandle body : arena.level.loose) {
    const bool exists = arena.world.exists(body);
    if (exists && arena.world.position(body).y < k_fall_height) reappear(arena, body);
  }
  for (ShotRecord& shot : arena.state.shots)
    melt(arena, shot);
}

StepReport advance(Arena& arena, std::span<const PlayerInput> inputs) {
  drive_machines(arena);  // before the players, whom they carry
  for (std::size_t slot = 0; slot < arena.config.players; ++slot) {
    control_player(arena, slot, inputs[slot]);
  }
  const StepReport report = arena.history.step();
  score_events(arena);
  knock_by_snowballs(arena);
  look_after_buggy(arena);
  retire(arena);
  return report;
}

}  // namespace lockstone::arena
