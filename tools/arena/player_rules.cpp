// The actions of a player.
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

constexpr SolverVelocity k_push_speed = 5_mps;
constexpr SolverVelocity k_push_lift = 1.5_mps;
constexpr SolverVelocity k_shot_speed = 17_mps;
constexpr SolverVelocity k_shot_lift = 2_mps;
constexpr Mass k_push_mass = 90_kg;  // heavier bodies get the impulse of this mass
constexpr Length k_reach = 1.1_m;
constexpr Length k_push_radius = 0.9_m;

constexpr std::uint8_t k_push_wait_ticks = 25;
constexpr std::uint8_t k_shot_wait_ticks = 30;
constexpr std::uint16_t k_shot_life_ticks = 240;
constexpr std::uint16_t k_rival_ticks = 300;

void push(Arena& arena, std::size_t slot, const Vec3<Unit>& aim) {
  World& world = arena.world;
  PlayerRecord& player = arena.state.players[slot];
  std::array<BodyHandle, 32> found{};
  const Vec3<Position> center = moved(world.position(player.body), along(aim, k_reach));
  const QueryFilter filter{.mask = k_player_bit | k_loose_bit | k_buggy_bit, .ignore = player.body};
  const std::size_t count = world.overlap_sphere(center, k_push_radius, found, filter);
  Vec3<SolverVelocity> change = along(aim, k_push_speed);
  change.y = k_push_lift;
  for (std::size_t i = 0; i < count; ++i) {
    const Tag tag = tag_of(world, found[i]);
    if (tag.kind == Kind::player && tag.number < arena.config.players) {
      knock(arena.state.players[tag.number], change);
    } else {
      const Mass mass = min(world.mass(found[i]), k_push_mass);
      order(world, ApplyImpulse{found[i], impulse_for(mass, change)});
    }
    claim(arena, found[i], slot);
  }
  player.push_wait = k_push_wait_ticks;
}

ShotRecord* free_shot(GameState& state, std::size_t slot) {
  for (std::size_t i = 0; i < k_shots_per_player; ++i) {
    ShotRecord& shot = state.shots[slot * k_shots_per_player + i];
    if (shot.body.is_null()) return &shot;
  }
  return nullptr;
}

void shoot(Arena& arena, std::size_t slot, const Vec3<Unit>& aim) {
  PlayerRecord& player = arena.state.players[slot];
  ShotRecord* shot = free_shot(arena.state, slot);
  if (shot == nullptr) return;
  Vec3<SolverVelocity> velocity = along(aim, k_shot_speed);
  velocity.y = k_shot_lift;
  BodyDef def;
  def.shape = Shape::sphere(0.2_m);
  def.position = moved(arena.world.position(player.body), along(aim, 0.7_m));
  def.velocity = master_velocity(velocity);
  def.material.density = 400_kgpm3;
  def.events.hit_speed = 3_mps;
  def.filter = {.category = k_shot_bit, .group = -static_cast<std::int32_t>(slot) - 1};
  def.user_data = Tag{Kind::snowball, static_cast<std::uint16_t>(shot - arena.state.shots.data()),
                      static_cast<std::uint8_t>(slot + 1)}
                      .pack();
  const Result<BodyHandle> body = arena.world.create_body(def);
  if (!body) return;  // the store is full: on every peer alike
  *shot = {body.value(), k_shot_life_ticks};
  player.shot_wait = k_shot_wait_ticks;
}

void count_down(PlayerRecord& player) {
  for (std::uint8_t* wait : {&player.jump_wait, &player.push_wait, &player.shot_wait}) {
    if (*wait > 0) --*wait;
  }
  if (player.rival_ticks > 0 && --player.rival_ticks == 0) player.rival = 0;
}

void act(Arena& arena, std::size_t slot, const Input& input, std::uint8_t pressed) {
  PlayerRecord& player = arena.state.players[slot];
  const Vec3<Unit> aim = direction_of(input.yaw);
  if ((pressed & k_push) != 0 && player.push_wait == 0) push(arena, slot, aim);
  if ((pressed & k_shoot) != 0 && player.shot_wait == 0) shoot(arena, slot, aim);
}

}  // namespace

void claim(Arena& arena, BodyHandle body, std::size_t slot) {
  Tag tag = tag_of(arena.world, body);
  const auto owner = static_cast<std::uint8_t>(slot + 1);
  if (tag.kind == Kind::player && tag.number < arena.config.players) {
    PlayerRecord& victim = arena.state.players[tag.number];
    victim.rival = owner;
    victim.rival_ticks = k_rival_ticks;
  } else if (tag.is_loose()) {
    tag.owner = owner;
    order(arena.world, SetUserData{body, tag.pack()});
  }
}

void control_player(Arena& arena, std::size_t slot, const PlayerInput& from) {
  PlayerRecord& player = arena.state.players[slot];
  count_down(player);
  if (!arena.world.exists(player.body)) return;
  if (player.respawn_ticks > 0) return;
  // Nobody sits in an absent slot: the character brakes and stands.
  const Input input = from.origin == InputOrigin::absent ? Input{} : Input::decode(from.bytes);
  if (from.origin != InputOrigin::absent) player.yaw = input.yaw;
  if (from.origin == InputOrigin::absent) leave_buggy(arena, slot);
  const auto pressed = static_cast<std::uint8_t>(input.buttons & ~player.buttons);
  if (ride(arena, slot, input, pressed)) {
    player.buttons = input.buttons;
    return;
  }
  walk(arena, slot, input, (input.buttons & k_jump) != 0 && player.jump_wait == 0);
  act(arena, slot, input, pressed);
  carry(arena, slot, (input.buttons & k_grab) != 0);
  player.buttons = input.buttons;
}

}  // namespace lockstone::arena
