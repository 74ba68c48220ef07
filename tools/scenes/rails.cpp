// A roller coaster with a chain lift, beads on wires, and ratchets under a rain of balls.
#include <array>
#include <vector>

#include <lockstone/path.h>
#include <lockstone/rotation.h>

#include "tools/scenes/assets.h"
#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr std::uint64_t k_cart = 0xca27;  // user data of the joint of the last cart
constexpr Length k_lift_begin = 10_m, k_lift_end = 34_m;

PathPoint knot(std::int32_t x_mm, std::int32_t y_mm, std::int32_t z_mm, std::int32_t bank = 0) {
  PathPoint point{{millimetres_long(x_mm), millimetres_long(y_mm), millimetres_long(z_mm)}};
  point.up = {{}, Unit::from_integer(1), Unit::from_ratio(bank, 100)};
  return point;
}

AssetPtr path_through(std::span<const PathPoint> points, bool closed) {
  const PathResult made = Path::build(points, closed);
  LKS_CHECK(made.ok());
  return made.path;
}

// Up a straight, down into a banked turn, over two hills, and back.
AssetPtr track() {
  return path_through(
      std::array{knot(-14000, 1000, 6000), knot(-6000, 1500, 6000), knot(2000, 5000, 6000),
                 knot(9000, 8500, 6000), knot(14000, 8800, 4500, -30), knot(16000, 7500, 0, -60),
                 knot(13000, 4000, -5000, 60), knot(7000, 1200, -6000), knot(1000, 3200, -6000),
                 knot(-4500, 900, -6000), knot(-10500, 2500, -6000), knot(-17000, 1500, -4500, 60),
                 knot(-20000, 1000, 0, 0), knot(-18500, 1000, 4500, 0)},
      true);
}

AssetPtr wire() {
  return path_through(std::array{knot(-4000, 3500, 0), knot(-2000, 1500, 400), knot(0, 1000, 0),
                                 knot(2000, 1500, -400), knot(4000, 3500, 0)},
                      false);
}

std::vector<AssetPtr> rail_assets(std::uint64_t) {
  return {track(), wire()};
}

const Path& as_path(const AssetPtr& asset) {
  return static_cast<const Path&>(*asset);
}

// For the eye alone.
void lay_ties(World& world, const Path& path, Length from, Length to) {
  for (Length at = from; at < to; at += 1.2_m) {
    const Transform place = path.at(at);
    BodyDef tie = fixed(Shape::box(0.08_m, 0.5_m, 0.05_m), place.position);
    tie.orientation = place.orientation;
    tie.filter.mask = 0;
    add(world, tie);
  }
}

JointDef on_path(BodyHandle ground, BodyHandle body, const AssetPtr& path) {
  JointDef joint = JointDef::of(JointKind::path, ground, body);
  joint.path = path->id();
  return joint;
}

void add_train(World& world, BodyHandle ground, const AssetPtr& asset) {
  constexpr Length k_cart_spacing = 2.4_m;
  BodyHandle last;
  for (int i = 0; i < 3; ++i) {
    const Transform place = as_path(asset).at(12_m + k_cart_spacing * i);
    BodyDef cart = loose(Shape::box(0.9_m, 0.5_m, 0.3_m), place.position);
    cart.orientation = place.orientation;
    cart.allow_sleep = false;
    const BodyHandle body = add(world, cart);
    JointDef joint = on_path(ground, body, asset);
    for (AngularAxis& axis : joint.angular)
      axis.mode = AxisMode::locked;
    joint.user_data = i == 2 ? k_cart : 0;
    order(world, CreateJoint{joint});
    if (i > 0) {
      JointDef bar = JointDef::of(JointKind::distance, last, body);
      bar.frame_a.position.x = 1_m;
      bar.frame_b.position.x = -1_m;
      bar.linear[0] = {.target = k_cart_spacing - 2_m, .hertz = 10_r};
      order(world, CreateJoint{bar});
    }
    last = body;
  }
}

void build_coaster(World& world, std::uint64_t seed) {
  const std::vector<AssetPtr> assets = rail_assets(seed);
  const BodyHandle ground = add(world, fixed_box({{}, -0.5_m, {}}, {24_m, 0.5_m, 24_m}));
  const Path& rail = as_path(assets[0]);
  lay_ties(world, rail, {}, rail.length());
  lay_ties(world, as_path(assets[1]), {}, as_path(assets[1]).length());
  add_train(world, ground, assets[0]);
  for (int i = 0; i < 3; ++i) {
    const Transform place = as_path(assets[1]).at(Length(0.5_m) + Length(2.5_m) * i);
    const BodyHandle bead = add(world, loose(Shape::sphere(0.25_m), place.position));
    order(world, CreateJoint{on_path(ground, bead, assets[1])});
  }
}

// A chain pulls the first cart up the hill.
void drive_coaster(World& world, std::uint64_t) {
  for (std::uint32_t i = 0; i < world.joint_limit(); ++i) {
    const JointHandle joint = world.joint_at(i);
    if (joint.is_null() || world.joint(joint).user_data != k_cart) continue;
    const Length at = world.joint(joint).offset.x;
    LinearAxis pull;
    if (at > k_lift_begin && at < k_lift_end) {
      pull.speed = 6_mps;
      pull.max_effort = Force::from_integer(60'000);
    }
    order(world, SetLinearAxis{joint, 0, pull});
  }
}

// A bar that balls turn: its ratchet lets it turn one way alone.
void add_turnstile(World& world, std::int32_t x_mm, int teeth) {
  const Vec3<Position> at{millimetres(x_mm), 2_m, {}};
  const BodyHandle post = add(world, fixed_box(at, {0.1_m, 0.1_m, 0.1_m}));
  const BodyHandle bar = add(world, loose(Shape::box(1.2_m, 0.08_m, 0.5_m), at));
  JointDef joint = JointDef::of(JointKind::ratchet, post, bar);
  joint.frame_a.orientation = joint.frame_b.orientation = from_directions(k_x_axis, k_z_axis);
  joint.ratio = Number::from_integer(teeth);
  joint.angular[0].max_effort = Torque::from_integer(20);
  order(world, CreateJoint{joint});
}

void build_ratchets(World& world, std::uint64_t seed) {
  add_ground(world, 8_m);
  constexpr std::array k_teeth{3, 8, 24, 1000};
  for (std::size_t i = 0; i < k_teeth.size(); ++i)
    add_turnstile(world, static_cast<std::int32_t>(i) * 3000 - 4500, k_teeth[i]);
  Random random(mix(seed));
  for (int i = 0; i < 60; ++i) {
    const std::int32_t x = random.between(-5700, 5700), z = random.between(-400, 400);
    add(world,
        loose(Shape::sphere(0.2_m), {millimetres(x), millimetres(3500 + 250 * i), millimetres(z)}));
  }
}

}  // namespace

constinit const Scene k_coaster{
    .name = "coaster",
    .description = "a chain lifts a train of three carts on a track; beads swing on a wire",
    .golden_ticks = 300,
    .define = small_world,
    .builder = build_coaster,
    .drive = drive_coaster,
    .assets = rail_assets};
constinit const Scene k_ratchets{"ratchets", "balls fall on bars whose ratchets turn one way", 300,
                                 small_world, build_ratchets};

}  // namespace lockstone::scenes
