#include "tools/arena/bots.h"

#include <lockstone/literals.h>

#include "tools/arena/integers.h"
#include "tools/arena/motion.h"
#include "tools/arena/tags.h"

namespace lockstone::arena {
namespace {

using namespace lockstone::literals;

constexpr std::uint64_t k_epoch_ticks = 200;  // a bot changes its mind this often
constexpr Length k_near = 2_m;
constexpr Length k_throw_range = 5.5_m;
constexpr Position k_safe = 17_m;  // further out, a bot turns back

enum class Mood : std::uint8_t { haul, hunt, climb, wander, drive };

/// A bot's view of the game in one tick.
struct View {
  const Arena& arena;
  std::size_t slot;
  std::uint64_t tick;
  std::uint64_t whim;  ///< random bits, the same for a whole epoch
  Vec3<Position> place;

  [[nodiscard]] const PlayerRecord& self() const { return arena.state.players[slot]; }
  [[nodiscard]] Vec3<Length> way_to(const Vec3<Position>& target) const {
    return offset_between(place, target);
  }
};

Mood mood_of(const View& view) {
  constexpr Mood k_moods[] = {Mood::haul, Mood::haul,  Mood::haul,   Mood::hunt,
                              Mood::hunt, Mood::climb, Mood::wander, Mood::drive};
  return k_moods[view.whim % 8];
}

bool within(const Vec3<Length>& way, Length distance) {
  return squared_raw({way.x, {}, way.z}) <= squared_raw({distance, {}, {}});
}

// Full stick and aim along the way.
void head(Input& input, const Vec3<Length>& way) {
  input.yaw = yaw_of(way.x.raw, way.z.raw);
  const Vec3<Unit> direction = direction_of(input.yaw);
  input.move_x = static_cast<std::int8_t>(rounded<Number>(direction.x).raw * 127 / (1 << 20));
  input.move_z = static_cast<std::int8_t>(rounded<Number>(direction.z).raw * 127 / (1 << 20));
}

// A press of `button` for one tick in `period`, out of step with the other bots.
void tap(Input& input, const View& view, Button button, std::uint64_t period) {
  if ((view.tick + view.slot * 7) % period == 0) input.buttons |= button;
}

Vec3<Position> goal_of(const View& view) {
  return {Position::from_integer(view.slot % 2 == 0 ? 18 : -18), 1_m, {}};
}

// The nearest of a few bodies that this epoch's whim points at.
BodyHandle choose_loose(const View& view) {
  constexpr std::size_t k_candidates = 24;
  BodyHandle best{};
  std::int64_t best_distance = 0;
  for (std::size_t i = 0; i < k_candidates && !view.arena.level.loose.empty(); ++i) {
    const std::size_t pick = mix(view.whim + i) % view.arena.level.loose.size();
    const BodyHandle body = view.arena.level.loose[pick];
    if (!view.arena.world.exists(body)) continue;
    const std::int64_t distance = squared_raw(view.way_to(view.arena.world.position(body)));
    if (!best.is_null() && distance >= best_distance) continue;
    best = body;
    best_distance = distance;
  }
  return best;
}

void carry_to_goal(Input& input, const View& view) {
  const Vec3<Length> way = view.way_to(goal_of(view));
  head(input, way);
  if (!within(way, k_throw_range)) input.buttons |= k_grab;  // else let go: a throw
  tap(input, view, k_jump, 45);
}

void haul(Input& input, const View& view) {
  if (!view.self().held.is_null()) return carry_to_goal(input, view);
  const BodyHandle body = choose_loose(view);
  if (body.is_null()) return;
  const Vec3<Length> way = view.way_to(view.arena.world.position(body));
  head(input, way);
  if (within(way, k_near) && view.tick % 8 != 0) input.buttons |= k_grab;
  tap(input, view, k_jump, 50);
  tap(input, view, k_push, 70);
}

BodyHandle nearest_player(const View& view) {
  BodyHandle best{};
  std::int64_t best_distance = 0;
  for (std::size_t slot = 0; slot < view.arena.config.players; ++slot) {
    const BodyHandle body = view.arena.state.players[slot].body;
    if (slot == view.slot || !view.arena.world.exists(body)) continue;
    const std::int64_t distance = squared_raw(view.way_to(view.arena.world.position(body)));
    if (!best.is_null() && distance >= best_distance) continue;
    best = body;
    best_distance = distance;
  }
  return best;
}

void wander(Input& input, const View& view) {
  const auto turn = static_cast<std::int16_t>(mix(view.whim + view.tick / 60) & 0xffff);
  head(input, along(direction_of(turn), Length(1_m)));
  tap(input, view, k_jump, 40);
  tap(input, view, k_shoot, 55);
  tap(input, view, k_push, 35);
}

void hunt(Input& input, const View& view) {
  const BodyHandle body = nearest_player(view);
  if (body.is_null()) return wander(input, view);
  const Vec3<Length> way = view.way_to(view.arena.world.position(body));
  head(input, way);
  if (within(way, k_near)) tap(input, view, k_push, 6);
  tap(input, view, k_shoot, 40);
  tap(input, view, k_jump, 60);
}

void climb(Input& input, const View& view) {
  // Up a ramp: first in front of it, then straight on.
  const bool aligned = abs(view.place.z) < 1_m;
  const Position side = view.place.x.raw < 0 ? Position(-9.5_m) : Position(9.5_m);
  const bool low = view.place.y < 1.6_m;
  const Vec3<Position> target =
      low && !aligned ? Vec3<Position>{side, 1_m, {}} : Vec3<Position>{{}, 2_m, {}};
  const Vec3<Length> way = view.way_to(target);
  if (!within(way, Length(0.5_m))) head(input, way);
  tap(input, view, k_push, 30);
}

// Round the field, an eighth of a turn ahead of where it is.
void drive_round(Input& input, const View& view) {
  const int here = yaw_of(view.place.x.raw, view.place.z.raw);
  const auto next = static_cast<std::int16_t>(static_cast<std::uint16_t>(here + 8192));
  const Vec3<Length> target = along(direction_of(next), Length(13_m));
  head(input, view.way_to(moved({}, target)));
}

// To the buggy, if nobody sits in it.
void drive(Input& input, const View& view) {
  const std::uint32_t driver = view.arena.state.game.driver;
  if (driver == view.slot + 1) return drive_round(input, view);
  const BodyHandle buggy = view.arena.level.buggy;
  if (driver != 0 || !view.arena.world.exists(buggy)) return wander(input, view);
  const Vec3<Length> way = view.way_to(view.arena.world.position(buggy));
  head(input, way);
  if (within(way, k_near)) tap(input, view, k_ride, 8);
  tap(input, view, k_jump, 50);
}

// Two sides are open; a bot that does not carry anything keeps away from them.
void keep_inside(Input& input, const View& view) {
  const bool outside = abs(view.place.x) > k_safe || abs(view.place.z) > k_safe;
  if (outside && view.self().held.is_null()) head(input, view.way_to({}));
}

}  // namespace

Input bot_input(const Arena& arena, std::uint64_t seed, std::size_t slot) {
  const std::uint64_t tick = arena.world.tick();
  Input input;
  input.sequence = static_cast<std::uint16_t>(tick & 0xffff);
  const BodyHandle body = arena.state.players[slot].body;
  if (!arena.world.exists(body)) return input;
  const std::uint64_t epoch = (tick + slot * 53) / k_epoch_ticks;
  const View view{arena, slot, tick, mix(seed ^ mix(slot * 0x10001 + epoch * 0x1000003)),
                  arena.world.position(body)};
  const Mood mood = mood_of(view);
  if (mood != Mood::drive && arena.state.game.driver == slot + 1) tap(input, view, k_ride, 8);
  switch (mood) {
    case Mood::haul:
      haul(input, view);
      break;
    case Mood::hunt:
      hunt(input, view);
      break;
    case Mood::climb:
      climb(input, view);
      break;
    case Mood::wander:
      wander(input, view);
      break;
    case Mood::drive:
      drive(input, view);
      break;
  }
  keep_inside(input, view);
  return input;
}

}  // namespace lockstone::arena
