// Platforms that one jumps onto from below: boxes, balls and characters go up through them and
// land.
#include <lockstone/character.h>

#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr std::uint64_t k_character = 1, k_lift = 2, k_jumper = 3;
constexpr std::uint32_t k_seen_only = 2;  // category: queries see it, nothing touches it
constexpr std::uint64_t k_hop_ticks = 70, k_lift_ticks = 150;
constexpr Length k_fall = Length::from_ratio(981, 360000);  // g over a tick, squared
constexpr Length k_jump = Length::from_ratio(15, 100);      // 9 m/s

const Shape k_shape = Shape::capsule(0.5_m, 0.3_m);

void add_platform(World& world, const BodyDef& def) {
  const BodyHandle platform = add(world, def);
  order(world, SetOneWay{platform, {.direction = k_y_axis}});
}

void add_platforms(World& world) {
  for (int i = 0; i < 3; ++i) {
    const Position y = millimetres(2500 * (i + 1));
    add_platform(world, fixed_box({millimetres(i % 2 * 2000 - 4000), y, {}}, {3_m, 0.1_m, 2_m}));
  }
  BodyDef tilted = fixed_box({4.5_m, 3_m, {}}, {2_m, 0.1_m, 2_m});
  tilted.orientation = from_axis_angle(k_z_axis, 0.3_rad);
  add_platform(world, tilted);
  BodyDef lift = fixed_box({8.5_m, 0.3_m, {}}, {1.2_m, 0.1_m, 1.2_m});
  lift.motion = MotionType::kinematic;
  lift.user_data = k_lift;
  add_platform(world, lift);
}

void add_jumpers(World& world) {
  for (int i = 0; i < 14; ++i) {
    const Vec3<Position> at{millimetres(i % 7 * 1900 - 6000), 0.4_m,
                            millimetres(i / 7 * 1600 - 800)};
    BodyDef def = loose(i % 2 == 0 ? Shape::box(0.3_m, 0.3_m, 0.3_m) : Shape::sphere(0.35_m), at);
    def.user_data = k_jumper;
    add(world, def);
  }
}

void add_characters(World& world) {
  for (int i = 0; i < 4; ++i) {
    BodyDef def = fixed(k_shape, {millimetres(i * 1700 - 5000), 0.82_m, millimetres(i % 2 * 900)});
    def.motion = MotionType::kinematic;
    def.filter = {.category = k_seen_only, .mask = 0};
    def.user_data = k_character;
    add(world, def);
  }
}

void build_one_way(World& world, std::uint64_t) {
  add_ground(world, 14_m);
  add_platforms(world);
  add_characters(world);
  add_jumpers(world);
}

// The speed of the character's body is its own: upwards it began with a jump.
void move_character_of(World& world, BodyHandle body) {
  CharacterDef character;
  character.shape = k_shape;
  character.filter.mask = 1;
  const Vec3<Position> from = world.position(body);
  const Velocity speed = world.velocity(body).y;
  Length rise = Length::from_raw(static_cast<std::int32_t>((speed.raw >> 12) / 60)) - k_fall;
  const CharacterMove standing = move_character(world, character, from, {}, false);
  const bool hops = world.tick() % k_hop_ticks == body.index % 7 * 10;
  if (standing.grounded) rise = hops ? k_jump : Length{};
  const CharacterCarry carry = carried_by(world, character, standing);
  const CharacterMove move = move_character(world, character, standing.position, {{}, rise, {}},
                                            rise <= Length{}, carry.motion);
  order(world, MoveKinematic{body, move.position, {}});
}

void drive_one_way(World& world, std::uint64_t seed) {
  for (std::uint32_t i = 0; i < world.body_limit(); ++i) {
    const BodyHandle body = world.body_at(i);
    if (body.is_null()) continue;
    const std::uint64_t role = world.body(body).user_data;
    if (role == k_character) move_character_of(world, body);
    if (role == k_lift && world.tick() % k_lift_ticks == 0) {
      const bool rises = world.tick() / k_lift_ticks % 2 == 0;
      order(world, SetVelocity{body, {{}, rises ? 2_mps : -2_mps, {}}});
    }
    if (role != k_jumper || (world.tick() + i * 13) % (2 * k_hop_ticks) != 0) continue;
    const std::uint64_t drawn = mix(seed ^ mix((std::uint64_t{i} << 32) + world.tick()));
    const auto across = Velocity::from_ratio(static_cast<std::int64_t>(drawn % 3000) - 1500, 1000);
    order(world, SetVelocity{body, {across, 8.5_mps, {}}});
  }
}

}  // namespace

constinit const Scene k_one_way{
    .name = "one-way",
    .description = "boxes, balls and characters jump onto platforms from below",
    .golden_ticks = 300,
    .define = small_world,
    .builder = build_one_way,
    .drive = drive_one_way};

}  // namespace lockstone::scenes
