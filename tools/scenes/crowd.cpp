// Characters that walk about: up stairs and ramps, round a turntable, with lifts and ferries, into
// crates.
#include <lockstone/character.h>
#include <lockstone/vector_math.h>

#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr std::uint64_t k_character = 1, k_lift = 2, k_ferry = 3;
constexpr std::uint32_t k_seen_only = 2;  // category: queries see it, nothing touches it
constexpr std::uint64_t k_turn_ticks = 150, k_lift_ticks = 120;
constexpr Length k_stride = 0.045_m;                        // a tick
constexpr Length k_fall = Length::from_ratio(981, 360000);  // g over a tick, squared

const Shape k_shape = Shape::capsule(0.5_m, 0.3_m);

void add_stairs(World& world) {
  for (int i = 0; i < 6; ++i)
    add(world, fixed_box({millimetres(3000 + i * 400), millimetres(100 + i * 100), -4_m},
                         {0.2_m, millimetres_long(100 + i * 100), 2_m}));
  add(world, fixed_box({7.2_m, 0.6_m, -4_m}, {2_m, 0.6_m, 2_m}));
  BodyDef ramp = fixed_box({7.2_m, 0.5_m, 0.4_m}, {2_m, 0.1_m, 2.6_m});
  ramp.orientation = from_axis_angle(k_x_axis, 0.25_rad);
  add(world, ramp);
}

void add_machines(World& world) {
  BodyDef table = fixed_box({-5_m, 0.1_m, -4_m}, {2.5_m, 0.1_m, 2.5_m});
  table.motion = MotionType::kinematic;
  table.angular_velocity = {{}, 0.6_rps, {}};
  add(world, table);
  BodyDef lift = fixed_box({-5_m, 0.1_m, 4_m}, {1.5_m, 0.1_m, 1.5_m});
  lift.motion = MotionType::kinematic;
  lift.user_data = k_lift;
  add(world, lift);
}

void add_crates(World& world, std::uint64_t seed) {
  Random random(seed);
  for (int i = 0; i < 16; ++i) {
    const Vec3<Position> at{millimetres(-1500 + i % 4 * 1000), millimetres(300 + i / 8 * 600),
                            millimetres(3500 + i % 8 / 4 * 1000)};
    BodyDef crate = loose(Shape::box(0.3_m, 0.3_m, 0.3_m), at);
    crate.material.density =
        Density::from_integer(60 + static_cast<std::int64_t>(random.below(120)));
    add(world, crate);
  }
}

void add_characters(World& world) {
  for (int i = 0; i < 24; ++i) {
    BodyDef def = fixed(
        k_shape, {millimetres(-2500 + i % 6 * 1000), 0.82_m, millimetres(-2000 + i / 6 * 1100)});
    def.motion = MotionType::kinematic;
    def.filter = {.category = k_seen_only, .mask = 0};
    def.user_data = k_character;
    add(world, def);
  }
}

void build_crowd(World& world, std::uint64_t seed) {
  add_ground(world, 12_m);
  add_stairs(world);
  add_machines(world);
  add_crates(world, seed);
  add_characters(world);
}

// Straight on for a while; home from near the edge of the ground.
Vec3<Unit> direction_of(const World& world, std::uint64_t seed, std::uint32_t body,
                        const Vec3<Position>& at) {
  if (abs(at.x) > 10_m || abs(at.z) > 10_m) return normalized(Vec3<Position>{-at.x, {}, -at.z});
  const std::uint64_t drawn =
      mix(seed ^ mix((std::uint64_t{body} << 32) + world.tick() / k_turn_ticks));
  const Angle angle = Angle::from_ratio(static_cast<std::int64_t>(drawn % 6283), 1000);
  return rotate(to_matrix(from_axis_angle(k_y_axis, angle)), k_x_axis);
}

// The motion of the coming tick: it walks, and falls as it fell.
Vec3<Length> request_of(const World& world, std::uint64_t seed, std::uint32_t body,
                        const BodyView& view) {
  const Vec3<Unit> ahead = direction_of(world, seed, body, view.position);
  const Position drop = Position::from_raw(
      raw::round_divide(min(view.velocity.y, Velocity{}).raw, world.def().tick_rate));
  return {rounded<Length>(ahead.x * k_stride), saturated<Length>(drop) - k_fall,
          rounded<Length>(ahead.z * k_stride)};
}

void walk(World& world, std::uint64_t seed, BodyHandle body, std::uint32_t index) {
  const BodyView view = world.body(body);
  CharacterDef def;
  def.shape = view.shape;
  def.filter.ignore = body;
  const CharacterMove stood = move_character(world, def, view.position, {}, false);
  const CharacterCarry carry = carried_by(world, def, stood);
  const CharacterMove move = move_character(
      world, def, view.position, request_of(world, seed, index, view), true, carry.motion);
  apply_pushes(world, def, move);
  order(world, MoveKinematic{body, move.position, multiply(carry.turn, view.orientation)});
}

void drive_crowd(World& world, std::uint64_t seed) {
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyHandle body = world.body_at(i);
    const std::uint64_t role = world.body(body).user_data;
    if (role == k_lift && world.tick() % k_lift_ticks == 0) {
      const bool rises = world.tick() / k_lift_ticks % 2 == 0;
      order(world, SetVelocity{body, {{}, rises ? 0.8_mps : -0.8_mps, {}}});
    }
    if (role == k_ferry && world.tick() % k_lift_ticks == 0) {
      const bool goes = world.tick() / k_lift_ticks % 2 == 0;
      order(world, SetVelocity{body, {goes ? 1.2_mps : -1.2_mps, {}, {}}});
    }
    if (role == k_character) walk(world, seed, body, i);
  }
}

// Five steps of 0.2 m from all sides.
void add_terraces(World& world) {
  for (int i = 0; i < 5; ++i) {
    const Length half = millimetres_long(2600 - i * 450);
    add(world, fixed_box({6.5_m, millimetres(100 + i * 200), 5.5_m}, {half, 0.1_m, half}));
  }
}

// Ramps of 15°, 30°, 45° and 60°: nobody walks up the last one.
void add_ramps(World& world) {
  for (int i = 0; i < 4; ++i) {
    BodyDef ramp = fixed_box({-7.5_m, 0.2_m, millimetres(500 + i * 2400)}, {2.5_m, 0.25_m, 1_m});
    ramp.orientation = from_axis_angle(k_z_axis, Angle::from_ratio(-262 * (i + 1), 1000));
    add(world, ramp);
  }
}

void add_platforms(World& world) {
  for (int i = 0; i < 3; ++i) {
    BodyDef ferry =
        fixed_box({millimetres(-7000 + i * 5500), 0.15_m, millimetres(-5600 - i * 1800)},
                  {1.8_m, 0.15_m, 1_m});
    ferry.motion = MotionType::kinematic;
    ferry.user_data = k_ferry;
    add(world, ferry);
  }
  for (int i = 0; i < 2; ++i) {
    BodyDef lift = fixed_box({millimetres(-8000 + i * 16000), 0.1_m, -3_m}, {1.2_m, 0.1_m, 1.2_m});
    lift.motion = MotionType::kinematic;
    lift.user_data = k_lift;
    add(world, lift);
  }
  BodyDef table = fixed_box({-1_m, 0.1_m, 6_m}, {1.6_m, 0.1_m, 1.6_m});
  table.motion = MotionType::kinematic;
  table.angular_velocity = {{}, -0.8_rps, {}};
  add(world, table);
}

void build_characters(World& world, std::uint64_t /*seed*/) {
  add_ground(world, 12_m);
  add_terraces(world);
  add_ramps(world);
  add_platforms(world);
  const Shape shapes[] = {k_shape, Shape::cylinder(0.7_m, 0.3_m), Shape::sphere(0.4_m)};
  for (int i = 0; i < 48; ++i) {  // they fall onto everything
    BodyDef def = fixed(
        shapes[i % 3], {millimetres(-7700 + i % 8 * 2200), 4_m, millimetres(-7000 + i / 8 * 2600)});
    def.motion = MotionType::kinematic;
    def.filter = {.category = k_seen_only, .mask = 0};
    def.user_data = k_character;
    add(world, def);
  }
}

}  // namespace

constinit const Scene k_crowd{
    .name = "crowd",
    .description = "characters on stairs, a ramp, a turntable and a lift; crates that they push",
    .golden_ticks = 240,
    .define = small_world,
    .builder = build_crowd,
    .drive = drive_crowd};

constinit const Scene k_characters{
    .name = "characters",
    .description = "48 characters of three shapes on steps, ramps, ferries, lifts and a turntable",
    .golden_ticks = 240,
    .define = small_world,
    .builder = build_characters,
    .drive = drive_crowd};

}  // namespace lockstone::scenes
