// Players on foot: characters that walk, push and are pushed.
#include <span>

#include <lockstone/literals.h>

#include "tools/arena/integers.h"
#include "tools/arena/motion.h"
#include "tools/arena/rules.h"
#include "tools/arena/tags.h"

namespace lockstone::arena {
namespace {

using namespace lockstone::literals;

constexpr SolverVelocity k_walk_speed = 6_mps;
constexpr SolverVelocity k_ground_change = 0.9_mps;  // of velocity, a tick
constexpr SolverVelocity k_air_change = 0.12_mps;
constexpr SolverVelocity k_jump_speed = 5.5_mps;
constexpr SolverVelocity k_gravity = 0.1635_mps;  // a tick
constexpr SolverVelocity k_most_speed = 30_mps;   // of a character, whatever hits it
constexpr SolverVelocity k_bump_speed = 3_mps;    // with which a buggy throws up
constexpr Mass k_heavy = 2000_kg;                 // heavier bodies stop a player alike
constexpr Impulse k_most_impulse = 1000_Ns;       // of a snowball
constexpr std::uint8_t k_jump_wait_ticks = 20;
constexpr Unit k_all = Unit::from_integer(1), k_half = Unit::from_ratio(1, 2);

// The character of a player, which does not meet its own body and the object that it carries.
CharacterDef character_of(const PlayerRecord& player) {
  CharacterDef def = character_def();
  def.filter.mask = k_scenery_bit | k_player_bit | k_loose_bit | k_buggy_bit;
  def.filter.ignore = player.body;
  def.filter.accept = [](void* held, BodyHandle body) {
    return body != *static_cast<const BodyHandle*>(held);
  };
  return def;
}

// The stick as a vector of length ≤ 1.
Vec3<Unit> stick_direction(const Input& input) {
  const std::int32_t x = input.move_x, z = input.move_z;
  const auto length =
      static_cast<std::int32_t>(integer_sqrt(static_cast<std::uint64_t>(x * x + z * z)));
  const std::int32_t full = length > 127 ? length + 1 : 127;
  return {Unit::from_ratio(x, full), {}, Unit::from_ratio(z, full)};
}

Vec3<Length> in_a_tick(const Vec3<SolverVelocity>& velocity, std::int64_t rate) {
  const auto way = [rate](SolverVelocity v) {
    return rounded<Length>(Position::from_raw(raw::round_divide(rounded<Velocity>(v).raw, rate)));
  };
  return {way(velocity.x), way(velocity.y), way(velocity.z)};
}

// Of a way in a tick.
Vec3<SolverVelocity> speed_of(const Vec3<Length>& way, std::int64_t rate) {
  const auto speed = [rate](Length length) {
    return saturated<SolverVelocity>(Velocity::from_raw(rounded<Position>(length).raw * rate));
  };
  return {speed(way.x), speed(way.y), speed(way.z)};
}

// Of the place where a body meets a character.
Vec3<SolverVelocity> velocity_at(const BodyView& body, const Vec3<Position>& point) {
  const auto turning = cross(body.angular_velocity, offset_between(body.centre_of_mass, point));
  Vec3<Velocity> velocity = body.velocity;
  for (int axis = 0; axis < 3; ++axis)
    velocity[axis] += rounded<Velocity>(turning[axis]);
  return solver_velocity(velocity);
}

// Of 1024 to a kilogram.
std::int64_t in_grams(Mass mass) {
  return mass.raw >> (Mass::frac_bits - 10);
}

// The share of a closing speed that a character loses to a body: all of it to one that nothing
// moves, half of it to another player, else by the masses.
Unit share_of(const BodyView& body) {
  if (Tag::unpack(body.user_data).kind == Kind::player) return k_half;
  if (body.motion != MotionType::dynamic) return k_all;
  const std::int64_t theirs = in_grams(min(body.mass.mass, k_heavy));
  return Unit::from_ratio(theirs, theirs + in_grams(character_def().mass));
}

// A buggy that runs into a player throws it up, and its driver is the player's rival.
void bump(Arena& arena, std::size_t slot, SolverVelocity closing) {
  const std::uint32_t driver = arena.state.game.driver;
  if (driver == 0 || closing < k_bump_speed) return;
  knock(arena.state.players[slot], {{}, k_bump_speed, {}});
  claim(arena, arena.state.players[slot].body, driver - std::size_t{1});
}

// The other half of apply_pushes: inelastic impacts with all that stopped the character or ran
// into it. They do not lift it.
void meet(Arena& arena, std::size_t slot, const CharacterMove& move) {
  PlayerRecord& player = arena.state.players[slot];
  for (const CharacterHit& hit : std::span(move.hits).first(move.hit_count)) {
    if (!arena.world.exists(hit.body)) continue;
    touch(arena, player.body, hit.body);
    if (move.stepped && hit.normal.y < character_def().min_ground_slope) continue;
    const BodyView body = arena.world.body(hit.body);
    const Vec3<SolverVelocity> apart = velocity_at(body, hit.point) - player.velocity;
    const SolverVelocity closing = rounded<SolverVelocity>(dot(hit.normal, apart));
    if (closing <= SolverVelocity{}) continue;
    const SolverVelocity top = max(player.velocity.y, SolverVelocity{});
    knock(player, along(hit.normal, rounded<SolverVelocity>(share_of(body) * closing)));
    player.velocity.y = min(player.velocity.y, top);
    if (hit.body == arena.level.buggy) bump(arena, slot, closing);
  }
}

}  // namespace

CharacterDef character_def() {
  CharacterDef def;
  def.shape = Shape::capsule(0.5_m, 0.4_m);
  def.mass = 80_kg;
  return def;
}

CollisionFilter filter_on_foot(std::size_t slot) {
  return {.category = k_player_bit,
          .mask = k_shot_bit | k_zone_bit,
          .group = -static_cast<std::int32_t>(slot) - 1};
}

void knock(PlayerRecord& player, const Vec3<SolverVelocity>& change) {
  player.velocity = shortened(shortened(player.velocity, k_most_speed) + change, k_most_speed);
}

void walk(Arena& arena, std::size_t slot, const Input& input, bool jumps) {
  World& world = arena.world;
  PlayerRecord& player = arena.state.players[slot];
  const std::int64_t rate = world.def().tick_rate;
  CharacterDef character = character_of(player);
  BodyHandle held = player.held;
  character.filter.context = &held;
  const Vec3<Position> place = world.position(player.body);
  const CharacterMove stood = move_character(world, character, place, {}, false);
  const CharacterCarry carry = carried_by(world, character, stood);
  const Vec3<SolverVelocity> ground = shortened(speed_of(carry.motion, rate), k_most_speed);

  Vec3<SolverVelocity> change = along(stick_direction(input), k_walk_speed) + ground -
                                shortened(player.velocity, k_most_speed);
  change.y = {};
  knock(player, shortened(change, stood.grounded ? k_ground_change : k_air_change));
  if (jumps && stood.grounded) {
    player.velocity.y = max(player.velocity.y, ground.y) + k_jump_speed;
    player.jump_wait = k_jump_wait_ticks;
  }
  player.velocity.y -= k_gravity;

  const CharacterMove move = move_character(
      world, character, place, in_a_tick(player.velocity - ground, rate), true, carry.motion);
  meet(arena, slot, move);
  if (move.grounded) player.velocity.y = max(player.velocity.y, ground.y);
  apply_pushes(world, character, move);
  order(world, MoveKinematic{player.body, move.position, Quat{}});
}

void knock_by_snowballs(Arena& arena) {
  const World& world = arena.world;
  for (const HitEvent& hit : hit_events(world)) {
    if (!world.exists(hit.a) || !world.exists(hit.b)) continue;
    const Tag a = tag_of(world, hit.a), b = tag_of(world, hit.b);
    const bool forth = a.kind == Kind::snowball && b.kind == Kind::player;
    const bool back = b.kind == Kind::snowball && a.kind == Kind::player;
    if (!forth && !back) continue;
    const Tag victim = forth ? b : a, ball = forth ? a : b;
    if (victim.number >= arena.config.players) continue;
    const Vec3<Unit> away = forth ? hit.normal : -hit.normal;
    PlayerRecord& player = arena.state.players[victim.number];
    const Impulse impulse = min(hit.normal_impulse, k_most_impulse);
    const auto speed = SolverVelocity::from_ratio(impulse.raw >> (Impulse::frac_bits - 10),
                                                  in_grams(character_def().mass));
    knock(player, along(away, speed));
    if (ball.owner != 0) claim(arena, player.body, ball.owner - std::size_t{1});
  }
}

}  // namespace lockstone::arena
