#include "tools/fuzz/random_scene.h"

#include <algorithm>
#include <array>
#include <span>
#include <vector>

#include <fmt/format.h>

#include "tools/fuzz/random_features.h"
#include "tools/scenes/assets.h"

namespace lockstone::fuzz {
namespace {

using namespace lockstone::literals;
using arena::mix;
using arena::Random;

template <class T, std::size_t Count>
const T& pick(Random& random, const std::array<T, Count>& choices) {
  return choices[random.below(Count)];
}

// Within ±reach of 0, most often far less, sometimes 0.
std::int64_t signed_log(Random& random, std::int64_t reach) {
  if (chance(random, 6)) return 0;
  const std::int64_t size = log_between(random, std::max<std::int64_t>(reach >> 20, 1), reach);
  return chance(random, 2) ? size : -size;
}

template <class Quantity>
Vec3<Quantity> random_vector(Random& random, Quantity reach) {
  Vec3<Quantity> v;
  for (int i = 0; i < 3; ++i)
    v[i].raw = static_cast<typename Quantity::Representation>(signed_log(random, reach.raw));
  return v;
}

Length random_size(Random& random, Length most) {
  return Length::from_raw(
      static_cast<std::int32_t>(log_between(random, k_min_shape_size.raw, most.raw)));
}

WorldDef random_def(Random& random) {
  constexpr std::array<std::uint16_t, 6> k_rates{10, 30, 60, 60, 120, 480};
  constexpr std::array<std::uint16_t, 4> k_sleeps{0, 50, 500, 60'000};
  WorldDef def;
  def.body_capacity = 28;
  def.joint_capacity = 24;
  def.vehicle_capacity = 3;
  def.terrain_tile_capacity = 12;
  def.pair_capacity = chance(random, 10) ? 20 : 2048;
  def.contact_capacity = chance(random, 10) ? 10 : 1024;
  def.tick_rate = pick(random, k_rates);
  def.substeps = static_cast<std::uint8_t>(random.between(1, chance(random, 4) ? 16 : 6));
  def.sleep_ms = pick(random, k_sleeps);
  if (chance(random, 3)) def.gravity = random_vector(random, Acceleration::from_integer(200));
  if (chance(random, 6)) def.speed_limit = Velocity::from_integer(random.between(1, 20));
  return def;
}

AssetPtr random_field(Random& random) {
  constexpr int k_side = 9;
  std::vector<Length> heights;
  for (int i = 0; i < k_side * k_side; ++i)
    heights.push_back(scenes::millimetres_long(random.between(-800, 800)));
  std::vector<std::uint8_t> holes;
  for (int i = 0; i < (k_side - 1) * (k_side - 1); ++i)
    holes.push_back(chance(random, 10) ? 1 : 0);
  HeightFieldDef def;
  def.columns = def.rows = k_side;
  def.heights = heights;
  def.holes = holes;
  def.cell_x = random_size(random, 8_m);
  def.cell_z = random_size(random, 8_m);
  def.origin = {-(def.cell_x * 4), {}, -(def.cell_z * 4)};
  return HeightField::build(def).height_field;
}

AssetPtr rounded(const AssetPtr& hull, Random& random) {
  const auto* sharp = dynamic_cast<const Hull*>(hull.get());
  LKS_CHECK(sharp != nullptr);
  const Length radius = random_size(random, 1_m);
  const HullResult made = Hull::build(sharp->vertices(), HullOptions::rounded(radius, 128));
  return made.ok() ? made.hull : hull;
}

std::vector<AssetPtr> random_assets(Random& random) {
  std::vector<AssetPtr> assets;
  const int hulls = random.between(0, 3);
  for (int i = 0; i < hulls; ++i) {
    scenes::Point half;
    for (int axis = 0; axis < 3; ++axis)
      half[axis] = max(random_size(random, 3_m), Length::from_ratio(1, 100));
    const int points = random.between(8, 40);
    assets.push_back(scenes::random_hull(random, half, points));
    if (chance(random, 3)) assets.back() = rounded(assets.back(), random);
  }
  if (chance(random, 2)) assets.push_back(scenes::dumbbell());
  if (chance(random, 3)) assets.push_back(scenes::chair());
  if (chance(random, 3)) assets.push_back(scenes::bowl(4_m, 1.5_m, 6, 12));
  if (chance(random, 4)) assets.push_back(scenes::wall_mesh(5_m, 3_m));
  if (chance(random, 3)) assets.push_back(random_field(random));
  return assets;
}

bool is_never_dynamic(ShapeKind kind) {
  return kind == ShapeKind::half_space || kind == ShapeKind::mesh ||
         kind == ShapeKind::height_field;
}

Shape random_shape(Random& random, std::span<const AssetPtr> assets, bool with_rims) {
  const Length most = Length::from_integer(chance(random, 8) ? 200 : 2);
  const Length x = random_size(random, most);
  const Length y = random_size(random, most);
  const Length z = random_size(random, most);
  if (!assets.empty() && chance(random, 3))
    return assets[random.below(static_cast<std::uint32_t>(assets.size()))]->shape();
  if (with_rims && chance(random, 3)) switch (random.below(4)) {
      case 0:
        return Shape::cylinder(x, y);
      case 1:
        return Shape::cone(x, y);
      case 2:
        return Shape::tapered_capsule(x, y, z);
      default:
        return Shape::rounded_box(x, y, z, min(x, y));
    }
  switch (random.below(9)) {
    case 0:
    case 1:
      return Shape::sphere(x);
    case 2:
    case 3:
      return Shape::capsule(x, y);
    case 4:
      return Shape::half_space();
    case 5:
      return Shape::box(x, x, x);
    default:
      return Shape::box(x, y, z);
  }
}

Surface random_surface(Random& random) {
  Surface surface;
  surface.friction = Coefficient::from_ratio(random.between(0, 199), 100);
  surface.restitution = Coefficient::from_ratio(random.between(0, 4), 4);
  surface.rolling_resistance = Coefficient::from_ratio(random.between(0, 4), 100);
  surface.friction_rule = static_cast<CombineRule>(random.below(6));
  surface.restitution_rule = static_cast<CombineRule>(random.below(6));
  return surface;
}

AxisLocks random_locks(Random& random) {
  const std::uint32_t bits = random.below(64);
  return {(bits & 1) != 0, (bits & 2) != 0,  (bits & 4) != 0,
          (bits & 8) != 0, (bits & 16) != 0, (bits & 32) != 0};
}

// Where things are put: in one point, close together, far apart, or far from the origin.
struct Neighbourhood {
  Vec3<Position> middle{};
  Position spread{};

  explicit Neighbourhood(Random& random) {
    constexpr std::array<int, 6> k_spreads{0, 1, 3, 3, 10, 100};
    spread = Position::from_integer(pick(random, k_spreads));
    if (chance(random, 6)) middle = random_vector(random, k_world_limit);
  }

  [[nodiscard]] Vec3<Position> place(Random& random) const {
    Vec3<Position> place = middle;
    for (int i = 0; i < 3; ++i) {
      if (spread.raw > 0) place[i].raw += signed_log(random, spread.raw);
      place[i] = clamp(place[i], -k_world_limit, k_world_limit);
    }
    return place;
  }
};

BodyDef random_body(Random& random, const Neighbourhood& around, std::span<const AssetPtr> assets,
                    bool with_rims) {
  BodyDef def;
  def.shape = random_shape(random, assets, with_rims);
  if (chance(random, 5)) def.motion = MotionType::static_body;
  if (chance(random, 8)) def.motion = MotionType::kinematic;
  if (is_never_dynamic(def.shape.kind) && def.motion == MotionType::dynamic)
    def.motion = MotionType::static_body;
  def.position = around.place(random);
  if (!chance(random, 4)) def.orientation = scenes::random_orientation(random);
  if (def.motion != MotionType::static_body && chance(random, 2)) {
    def.velocity = random_vector(random, Velocity::from_integer(250));
    def.angular_velocity = random_vector(random, AngularVelocity::from_integer(1000));
  }
  const Surface surface = random_surface(random);
  def.material.friction = surface.friction;
  def.material.restitution = surface.restitution;
  def.material.rolling_resistance = surface.rolling_resistance;
  def.material.friction_rule = surface.friction_rule;
  def.material.density.raw = static_cast<std::int32_t>(log_between(random, 256, 256 * 20'000));
  if (chance(random, 6)) def.filter.group = random.between(-2, 2);
  if (chance(random, 6)) def.linear_damping = Rate::from_integer(random.between(0, 100));
  if (chance(random, 6)) def.angular_damping = Rate::from_integer(random.between(0, 100));
  if (chance(random, 8) && def.motion == MotionType::dynamic) def.locks = random_locks(random);
  def.is_trigger = chance(random, 8);
  def.fixed_rotation = chance(random, 10);
  def.is_bullet = chance(random, 5);
  def.allow_sleep = !chance(random, 10);
  return def;
}

LinearAxis random_linear(Random& random) {
  LinearAxis axis;
  axis.mode = static_cast<AxisMode>(random.below(3));
  axis.lower = Length::from_ratio(random.between(-2000, 100), 1000);
  axis.upper = axis.lower + Length::from_ratio(random.between(0, 2000), 1000);
  axis.hertz = chance(random, 2) ? Number::from_integer(random.between(0, 1000)) : Number{};
  axis.target = Length::from_ratio(random.between(-1000, 1000), 1000);
  axis.speed = SolverVelocity::from_integer(random.between(-20, 20));
  if (chance(random, 2)) axis.max_effort.raw = log_between(random, 1, std::int64_t{1} << 50);
  return axis;
}

AngularAxis random_angular(Random& random) {
  AngularAxis axis;
  axis.mode = static_cast<AxisMode>(random.below(3));
  axis.lower = Angle::from_ratio(random.between(-300, 10), 100);
  axis.upper =
      min(axis.lower + Angle::from_ratio(random.between(0, 300), 100), Angle::from_ratio(31, 10));
  axis.hertz = chance(random, 2) ? Number::from_integer(random.between(0, 1000)) : Number{};
  axis.speed = Rate::from_integer(random.between(-50, 50));
  if (chance(random, 2)) axis.max_effort.raw = log_between(random, 1, std::int64_t{1} << 50);
  return axis;
}

JointFrame random_frame(Random& random) {
  JointFrame frame;
  frame.position = random_vector(random, Length::from_integer(2));
  frame.orientation = scenes::random_orientation(random);
  return frame;
}

JointDef random_joint(const World& world, Random& random) {
  const auto kind = static_cast<JointKind>(random.between(1, static_cast<int>(JointKind::rack)));
  const BodyHandle a = any_body(world, random);
  const BodyHandle b = any_body(world, random);
  JointDef def = JointDef::of(kind, a, b);
  def.frame_a = random_frame(random);
  def.frame_b = random_frame(random);
  const int axes = random.between(0, 3);
  for (int i = 0; i < axes; ++i) {
    def.linear[random.below(3)] = random_linear(random);
    def.angular[random.below(3)] = random_angular(random);
  }
  if (chance(random, 4)) def.ratio = Number::from_ratio(random.between(-3000, 3000), 1000);
  if (chance(random, 6)) def.break_force.raw = log_between(random, 1, std::int64_t{1} << 50);
  def.collide = chance(random, 3);
  return def;
}

// Commands that change the future of a body.
Command random_push(const World& world, BodyHandle body, Random& random) {
  switch (random.below(8)) {
    case 0:
      return SetVelocity{body, random_vector(random, Velocity::from_integer(280))};
    case 1:
      return SetAngularVelocity{body, random_vector(random, AngularVelocity::from_integer(10'000))};
    case 2:
      return ApplyImpulse{body, random_vector(random, Impulse::from_integer(1 << 30))};
    case 3:
      return ApplyForce{body, random_vector(random, Force::from_integer(1 << 30))};
    case 4:
      return ApplyTorque{body, random_vector(random, Torque::from_integer(1 << 30))};
    case 5: {
      const Vec3<Position> place = world.body(body).position;
      const Quat turn = scenes::random_orientation(random);
      return Teleport{body, place + random_vector(random, Position::from_integer(2)), turn};
    }
    case 6:
      return SetGravityScale{body, Number::from_integer(random.between(-4, 4))};
    default:
      return ApplyAngularImpulse{body,
                                 random_vector(random, AngularImpulse::from_integer(1 << 30))};
  }
}

Command random_setting(BodyHandle body, Random& random) {
  switch (random.below(7)) {
    case 0:
      return SetMaterial{body, random_surface(random)};
    case 1:
      return SetFilter{body, {1, 0xffffffff, random.between(-1, 1)}};
    case 2:
      return SleepBody{body};
    case 3:
      return WakeBody{body};
    case 4:
      return SetAllowSleep{body, chance(random, 2)};
    case 5:
      return SetAxisLocks{body, random_locks(random)};
    default:
      return DestroyBody{body};
  }
}

}  // namespace

Command random_command(const World& world, Random& random) {
  const std::uint32_t kind = random.below(10);
  if (kind == 0) return CreateJoint{random_joint(world, random)};
  if (kind == 1) return DestroyJoint{any_joint(world, random)};
  if (kind == 2) {
    const JointHandle joint = any_joint(world, random);
    const auto axis = static_cast<std::uint8_t>(random.below(3));
    return SetAngularAxis{joint, axis, random_angular(random)};
  }
  const BodyHandle body = any_body(world, random);
  if (body.is_null()) return WakeBody{body};
  return kind < 7 ? random_push(world, body, random) : random_setting(body, random);
}

std::string difference_of_events(const World& a, const World& b) {
  const auto same_event = [](const ContactEvent& x, const ContactEvent& y) {
    return x.kind == y.kind && x.a == y.a && x.b == y.b && x.approach_speed == y.approach_speed &&
           x.tag_a == y.tag_a && x.tag_b == y.tag_b;
  };
  const auto same_joint = [](const JointEvent& x, const JointEvent& y) {
    return x.joint == y.joint && x.a == y.a && x.b == y.b && x.user_data == y.user_data;
  };
  if (!std::ranges::equal(a.events(), b.events(), same_event)) return "events differ";
  if (!std::ranges::equal(hit_events(a), hit_events(b))) return "hits differ";
  if (!std::ranges::equal(a.joint_events(), b.joint_events(), same_joint))
    return "events of joints differ";
  return {};
}

RandomScene::RandomScene(std::uint64_t seed, std::uint64_t index, bool with_rims)
    : seed_(mix(seed) ^ mix(~index)), with_rims_(with_rims) {
  Random random(seed_);
  def_ = random_def(random);
  std::vector<AssetPtr> assets = random_assets(random);
  assets.push_back(random_path(seed_));
  assets.push_back(random_panels());
  assets.push_back(random_level());
  assets_ = std::make_shared<const AssetSet>(std::move(assets));
}

World RandomScene::make(BroadPhaseKind broad_phase) const {
  WorldDef def = def_;
  def.broad_phase = broad_phase;
  World world = std::move(World::create(def, assets_).value());
  Random random(mix(seed_ ^ 1));
  const Neighbourhood around(random);
  const int bodies = random.between(1, 24);
  std::vector<AssetPtr> shapes(assets_->all().begin(), assets_->all().end());
  const AssetId floor = random_panels()->id(), level = random_level()->id();
  std::erase_if(shapes, [&](const AssetPtr& asset) {
    return asset->kind() == ShapeKind::path || asset->id() == floor || asset->id() == level;
  });
  for (int i = 0; i < bodies; ++i)
    (void)world.create_body(random_body(random, around, shapes, with_rims_));
  const int joints = chance(random, 2) ? random.between(1, 20) : 0;
  for (int i = 0; i < joints; ++i)
    (void)world.create_joint(random_joint(world, random));
  return world;
}

void RandomScene::drive(World& world) const {
  drive_features(world, seed_);
  Random random(mix(seed_ ^ mix(world.tick() + 2)));
  if (!chance(random, 4)) return;
  const int commands = random.between(1, 3);
  for (int i = 0; i < commands; ++i)
    (void)world.apply(random_command(world, random));
}

std::string RandomScene::text() const {
  return fmt::format("{} ticks/s, {} substeps, {} assets, room for {} pairs and {} contacts",
                     def_.tick_rate, def_.substeps, assets_->all().size(), def_.pair_capacity,
                     def_.contact_capacity);
}

}  // namespace lockstone::fuzz
