// Commands that change a body itself: its type of motion, its shape, its mass, whether it takes
// part.
#include <algorithm>

#include <gtest/gtest.h>

#include <lockstone/compound.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;
using test::metres_per_second;

constexpr Length k_half = 0.5_m;

BodyHandle add_crate(World& world, Position x, Position y) {
  return test::add(world, test::dynamic_body(Shape::box(k_half, k_half, k_half), x, y, {}));
}

// Two crates, one on the other, at rest or asleep on the ground.
struct Stack {
  Stack(int ticks, std::uint16_t sleep_ms)
      : world(test::make_world({.body_capacity = 16, .sleep_ms = sleep_ms})) {
    ground = test::add_ground(world);
    lower = add_crate(world, {}, 0.5_m);
    upper = add_crate(world, {}, 1.5_m);
    test::step(world, ticks);
  }
  World world;
  BodyHandle ground, lower, upper;
};

double of(MomentOfInertia x) {
  return static_cast<double>(x.raw) / static_cast<double>(1 << 28);
}
double of(Mass x) {
  return static_cast<double>(x.raw) / 4294967296.0;
}

void expect_valid(const World& world) {
  const WorldFault fault = world.find_fault();
  EXPECT_FALSE(fault) << fault.what << ' ' << fault.index;
}

void expect_refused(World& world, const Command& command, Status status) {
  const std::uint64_t before = world.hash().total;
  EXPECT_EQ(world.apply(command), status);
  EXPECT_EQ(world.hash().total, before);
  EXPECT_FALSE(world.explain(command).field.empty());
}

TEST(BodyView, HoldsAllThatADefinitionSets) {
  World world = test::make_world();
  BodyDef def = test::dynamic_body(Shape::box(1_m, 0.5_m, 0.25_m), {}, {}, {});
  def.gravity_scale = Number::from_ratio(1, 2);
  def.linear_damping = 0.25_rps;
  def.angular_damping = 0.5_rps;
  def.speed_limit = {40_mps, 6_rps};
  const BodyView view = world.body(test::add(world, def));
  EXPECT_EQ(view.gravity_scale, def.gravity_scale);
  EXPECT_EQ(view.linear_damping, def.linear_damping);
  EXPECT_EQ(view.angular_damping, def.angular_damping);
  EXPECT_EQ(view.speed_limit.linear, def.speed_limit.linear);
  EXPECT_NEAR(static_cast<double>(view.speed_limit.angular.raw) / 4294967296.0, 6, 1e-5);
  EXPECT_NEAR(of(view.mass.mass), 1000, 1e-5);
  EXPECT_NEAR(of(view.mass.inertia.x), 1000.0 / 3 * (0.25 + 0.0625), 1e-4);
  EXPECT_NEAR(of(view.mass.inertia.y), 1000.0 / 3 * (1 + 0.0625), 1e-4);
  EXPECT_NEAR(of(view.mass.inertia.z), 1000.0 / 3 * (1 + 0.25), 1e-4);
}

TEST(BodyView, ReadsASurfaceMotionInTheFrameOfTheShape) {
  CompoundChild children[2];
  children[0].shape = children[1].shape = Shape::box(0.5_m, 0.5_m, 0.5_m);
  children[1].position = {3_m, 1_m, {}};
  const CompoundResult built = Compound::build(children);
  ASSERT_TRUE(built.ok());
  auto assets = std::make_shared<const AssetSet>(std::vector<AssetPtr>{built.compound});
  World world = test::make_world({.body_capacity = 4}, std::move(assets));
  BodyDef def;
  def.motion = MotionType::static_body;
  def.shape = built.compound->shape();
  def.surface_motion = {{SolverVelocity::from_integer(2), {}, SolverVelocity::from_integer(-1)},
                        {{}, 1_rps, 2_rps}};
  const SurfaceMotion read = world.body(test::add(world, def)).surface_motion;
  for (int i = 0; i < 3; ++i) {
    EXPECT_NEAR(read.velocity[i].raw, def.surface_motion.velocity[i].raw, 8);
    EXPECT_NEAR(read.turning[i].raw, def.surface_motion.turning[i].raw, 8);
  }
}

TEST(MassData, OfADefinitionIsThatOfTheBody) {
  World world = test::make_world();
  BodyDef def = test::dynamic_body(Shape::box(1_m, 1_m, 1_m), {}, {}, {});
  def.mass = {12_kg,
              {MomentOfInertia::from_integer(2), MomentOfInertia::from_integer(3),
               MomentOfInertia::from_integer(4)}};
  const MassData read = world.body(test::add(world, def)).mass;
  EXPECT_NEAR(of(read.mass), 12, 1e-8);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(of(read.inertia[i]), 2 + i, 1e-6);
  def.mass.inertia.y = {};
  EXPECT_EQ(world.create_body(def).status(), Status::invalid_argument);
  EXPECT_EQ(world.explain(def).field, "body.mass.inertia");
  def.mass.inertia.y = MomentOfInertia::from_integer(49);  // above 12 kg · (2 m)²
  EXPECT_EQ(world.create_body(def).status(), Status::invalid_argument);
  def.mass = {Mass::from_raw(1), {}};
  EXPECT_EQ(world.create_body(def).status(), Status::invalid_argument);
  EXPECT_EQ(world.explain(def).field, "body.mass.mass");
}

TEST(SetMassData, KeepsVelocitiesAndChangesTheEffectOfPushes) {
  World world = test::make_world({.body_capacity = 4, .gravity = {}});
  BodyDef def = test::dynamic_body(Shape::box(1_m, 1_m, 1_m), {}, {}, {});
  def.angular_velocity = {1_rps, -2_rps, 3_rps};
  def.velocity = {4_mps, {}, {}};
  const BodyHandle body = test::add(world, def);
  const MassData data{10_kg,
                      {MomentOfInertia::from_integer(5), MomentOfInertia::from_integer(8),
                       MomentOfInertia::from_integer(4)}};
  ASSERT_EQ(world.apply(SetMassData{body, data}), Status::ok);
  BodyView view = world.body(body);
  EXPECT_EQ(view.velocity, def.velocity);
  for (int i = 0; i < 3; ++i)
    EXPECT_LE(abs(view.angular_velocity[i] - def.angular_velocity[i]).raw, 64);
  ASSERT_EQ(world.apply(ApplyImpulse{body, {20_Ns, {}, {}}}), Status::ok);
  ASSERT_EQ(world.apply(ApplyAngularImpulse{body, {{}, AngularImpulse::from_integer(8), {}}}),
            Status::ok);
  view = world.body(body);
  EXPECT_NEAR(metres_per_second(view.velocity.x), 6, 1e-8);
  EXPECT_NEAR(static_cast<double>(view.angular_velocity.y.raw) / 4294967296.0, -1, 1e-7);
  ASSERT_EQ(world.apply(SetMassData{body, {20_kg, {}}}), Status::ok);
  EXPECT_NEAR(of(world.body(body).mass.inertia.x), 20.0 / 3 * 2, 1e-6);
  expect_valid(world);
}

TEST(SetMassData, RefusesMassesAndMomentsOutOfRange) {
  World world = test::make_world();
  const BodyHandle body = add_crate(world, {}, {}), ground = test::add_ground(world);
  expect_refused(world, SetMassData{ground, {1_kg, {}}}, Status::invalid_argument);
  expect_refused(world, SetMassData{body, {-1_kg, {}}}, Status::invalid_argument);
  expect_refused(world, SetMassData{body, {k_max_mass + 1_kg, {}}}, Status::invalid_argument);
  const MomentOfInertia one = MomentOfInertia::from_integer(1);
  expect_refused(world, SetMassData{body, {1_kg, {one, one, {}}}}, Status::invalid_argument);
  expect_refused(world, SetMassData{body, {1_kg, {one, one, one + one}}}, Status::invalid_argument);
  expect_refused(world, SetMassData{{}, {1_kg, {}}}, Status::stale_handle);
}

TEST(SetMotionType, FreezesABodyInPlaceAndReleasesIt) {
  Stack stack(1, 500);
  World& world = stack.world;
  ASSERT_EQ(world.apply(SetMotionType{stack.upper, MotionType::static_body, {}}), Status::ok);
  expect_valid(world);
  ASSERT_EQ(world.apply(DestroyBody{stack.lower}), Status::ok);
  const Vec3<Position> place = world.position(stack.upper);
  test::step(world, 30);
  EXPECT_EQ(world.position(stack.upper), place);
  EXPECT_EQ(world.mass(stack.upper), Mass{});
  ASSERT_EQ(world.apply(SetMotionType{stack.upper, MotionType::dynamic, 30_kg}), Status::ok);
  EXPECT_NEAR(of(world.mass(stack.upper)), 30, 1e-6);
  test::step(world, 90);
  EXPECT_NEAR(metres(world.position(stack.upper).y), 0.5, 0.02);
  expect_valid(world);
}

TEST(SetMotionType, KeepsVelocitiesBetweenKinematicAndDynamic) {
  World world = test::make_world({.body_capacity = 4, .gravity = {}});
  BodyDef def = test::dynamic_body(Shape::box(1_m, 0.5_m, 0.25_m), {}, {}, {});
  def.velocity = {1_mps, 2_mps, 3_mps};
  def.angular_velocity = {3_rps, 2_rps, 1_rps};
  const BodyHandle body = test::add(world, def);
  for (const MotionType motion : {MotionType::kinematic, MotionType::dynamic}) {
    ASSERT_EQ(world.apply(SetMotionType{body, motion, {}}), Status::ok);
    const BodyView view = world.body(body);
    EXPECT_EQ(view.motion, motion);
    EXPECT_EQ(view.velocity, def.velocity);
    for (int i = 0; i < 3; ++i)
      EXPECT_LE(abs(view.angular_velocity[i] - def.angular_velocity[i]).raw, 64);
  }
  EXPECT_NEAR(of(world.mass(body)), 1000, 1e-5);
  ASSERT_EQ(world.apply(SetMotionType{body, MotionType::static_body, {}}), Status::ok);
  EXPECT_EQ(world.body(body).velocity, Vec3<Velocity>{});
  expect_valid(world);
}

TEST(SetMotionType, WakesTheBodiesThatSleepOnIt) {
  Stack stack(240, 100);
  World& world = stack.world;
  ASSERT_TRUE(world.body(stack.upper).is_asleep);
  ASSERT_EQ(world.apply(SetMotionType{stack.ground, MotionType::dynamic, {}}), Status::ok);
  EXPECT_FALSE(world.body(stack.upper).is_asleep);
  test::step(world, 30);
  EXPECT_LT(metres(world.position(stack.upper).y), 1.0);
  expect_valid(world);
}

TEST(SetMotionType, RefusesHalfSpacesAndJointsWithoutADynamicBody) {
  World world = test::make_world({.body_capacity = 8});
  BodyDef plane;
  plane.motion = MotionType::static_body;
  plane.shape = Shape::half_space();
  const BodyHandle half_space = test::add(world, plane);
  expect_refused(world, SetMotionType{half_space, MotionType::dynamic, {}},
                 Status::invalid_argument);
  const BodyHandle a = add_crate(world, {}, 2_m), b = add_crate(world, 2_m, 2_m);
  JointDef def = JointDef::of(JointKind::ball, a, b);
  def.frame_a.position = {1_m, {}, {}};
  def.frame_b.position = {-1_m, {}, {}};
  ASSERT_TRUE(world.create_joint(def).ok());
  ASSERT_EQ(world.apply(SetMotionType{a, MotionType::static_body, {}}), Status::ok);
  expect_refused(world, SetMotionType{b, MotionType::kinematic, {}}, Status::invalid_argument);
  expect_refused(world, SetMotionType{a, MotionType::dynamic, -1_kg}, Status::invalid_argument);
  expect_refused(world, SetMotionType{a, static_cast<MotionType>(0), {}}, Status::invalid_argument);
  test::step(world, 60);
  EXPECT_LT(metres(world.position(b).y), 1.9);  // hangs on the static one
  expect_valid(world);
}

TEST(SetShape, LetsAStackSettleOnASmallerCrate) {
  Stack stack(240, 100);
  World& world = stack.world;
  ASSERT_TRUE(world.body(stack.upper).is_asleep);
  const Mass mass = world.mass(stack.lower);
  const Vec3<Position> place = world.position(stack.lower);
  ASSERT_EQ(world.apply(SetShape{stack.lower, Shape::box(0.3_m, 0.25_m, 0.3_m), {}}), Status::ok);
  expect_valid(world);
  EXPECT_EQ(world.position(stack.lower), place);
  EXPECT_EQ(world.mass(stack.lower), mass);
  EXPECT_FALSE(world.body(stack.upper).is_asleep);
  test::step(world, 120);
  EXPECT_NEAR(metres(world.position(stack.lower).y), 0.25, 0.01);
  EXPECT_NEAR(metres(world.position(stack.upper).y), 1.0, 0.01);
  expect_valid(world);
}

TEST(SetShape, EndsContactsThatNoLongerHold) {
  Stack stack(30, 500);
  World& world = stack.world;
  ASSERT_TRUE(world.touching(stack.ground, stack.lower));
  ASSERT_EQ(world.apply(SetShape{stack.lower, Shape::sphere(0.2_m), 5_kg}), Status::ok);
  EXPECT_NEAR(of(world.mass(stack.lower)), 5, 1e-8);
  test::step(world, 1);
  const auto ends = [&](BodyHandle other) {
    return std::ranges::any_of(world.events(), [&](const ContactEvent& event) {
      return event.kind == EventKind::contact_end && (event.a == other || event.b == other);
    });
  };
  EXPECT_TRUE(ends(stack.ground));
  EXPECT_TRUE(ends(stack.upper));
}

TEST(SetShape, KeepsTheSpeedOfEachPoint) {
  CompoundChild children[2];
  children[0].shape = children[1].shape = Shape::box(0.5_m, 0.5_m, 0.5_m);
  children[1].position = {3_m, {}, {}};
  const CompoundResult built = Compound::build(children);
  ASSERT_TRUE(built.ok());
  auto assets = std::make_shared<const AssetSet>(std::vector<AssetPtr>{built.compound});
  World world = test::make_world({.body_capacity = 4, .gravity = {}}, std::move(assets));
  BodyDef def = test::dynamic_body(children[0].shape, {}, {}, {});
  def.velocity = {1_mps, {}, {}};
  def.angular_velocity = {{}, {}, 2_rps};
  const BodyHandle body = test::add(world, def), post = test::add_ground(world);
  JointDef joint = JointDef::of(JointKind::distance, post, body);
  joint.frame_b.position = {0.25_m, {}, {}};
  joint.linear[0].upper = 900_m;
  const JointHandle rope = world.create_joint(joint).value();
  const Length offset = world.joint(rope).offset.x;
  ASSERT_EQ(world.apply(SetShape{body, built.compound->shape(), {}}), Status::ok);
  const BodyView view = world.body(body);
  EXPECT_NEAR(metres(view.position.x), 0, 1e-6);
  EXPECT_NEAR(metres(view.centre_of_mass.x), 1.5, 1e-6);
  EXPECT_NEAR(metres_per_second(view.velocity.x), 1, 1e-6);
  EXPECT_NEAR(metres_per_second(view.velocity.y), 3, 1e-6);  // ω × 1.5 m
  EXPECT_NEAR(static_cast<double>(view.angular_velocity.z.raw) / 4294967296.0, 2, 1e-6);
  EXPECT_NEAR(world.joint(rope).offset.x.raw, offset.raw, 4);
  ASSERT_EQ(world.apply(SetShape{body, children[0].shape, {}}), Status::ok);
  EXPECT_NEAR(metres_per_second(world.body(body).velocity.y), 0, 1e-6);
  expect_valid(world);
}

TEST(SetShape, RefusesUnknownAssetsAndShapesThatCannotMove) {
  World world = test::make_world();
  const BodyHandle body = add_crate(world, {}, 1_m);
  expect_refused(world, SetShape{body, {ShapeKind::hull, {}, {77}}, {}}, Status::not_found);
  expect_refused(world, SetShape{body, Shape::half_space(), {}}, Status::invalid_argument);
  expect_refused(world, SetShape{body, Shape::sphere({}), {}}, Status::invalid_argument);
  expect_refused(world, SetShape{body, Shape::sphere(1_m), -1_kg}, Status::invalid_argument);
}

TEST(SetEnabled, TakesABodyOutAndBringsItBackAsItWas) {
  Stack stack(1, 0);
  World& world = stack.world;
  ASSERT_EQ(world.apply(SetVelocity{stack.lower, {1_mps, {}, {}}}), Status::ok);
  const BodyView before = world.body(stack.lower);
  ASSERT_EQ(world.apply(SetEnabled{stack.lower, false}), Status::ok);
  expect_valid(world);
  EXPECT_FALSE(world.body(stack.lower).is_enabled);
  test::step(world, 90);
  EXPECT_NEAR(metres(world.position(stack.upper).y), 0.5, 0.01);  // fell through it
  EXPECT_EQ(world.body(stack.lower).position, before.position);
  EXPECT_EQ(world.body(stack.lower).velocity, before.velocity);
  const RayHit hit = world.cast_ray({{}, 5_m, {}}, {{}, -10_m, {}});
  EXPECT_EQ(hit.body, stack.upper);
  ASSERT_EQ(world.apply(Teleport{stack.lower, {4_m, 0.5_m, {}}, {}}), Status::ok);
  ASSERT_EQ(world.apply(SetEnabled{stack.lower, true}), Status::ok);
  expect_valid(world);
  test::step(world, 1);
  EXPECT_GT(world.position(stack.lower).x, 4.01_m);  // with its velocity
}

TEST(SetEnabled, MakesJointsInert) {
  World world = test::make_world({.body_capacity = 4});
  BodyDef anchor;
  anchor.motion = MotionType::static_body;
  anchor.position = {{}, 5_m, {}};
  const BodyHandle post = test::add(world, anchor), body = add_crate(world, {}, 3_m);
  JointDef def = JointDef::of(JointKind::distance, post, body);
  def.linear[0].upper = 2_m;
  def.linear[0].mode = AxisMode::limited;
  ASSERT_TRUE(world.create_joint(def).ok());
  test::step(world, 30);
  EXPECT_NEAR(metres(world.position(body).y), 3, 0.01);
  ASSERT_EQ(world.apply(SetEnabled{post, false}), Status::ok);
  expect_valid(world);
  test::step(world, 30);
  EXPECT_LT(metres(world.position(body).y), 2.0);
  EXPECT_EQ(world.joint_count(), 1U);
  ASSERT_EQ(world.apply(SetEnabled{post, true}), Status::ok);
  test::step(world, 240);
  EXPECT_NEAR(metres(world.position(body).y), 3, 0.1);
  expect_valid(world);
}

TEST(SetEnabled, WakesTheBodiesThatSleepOnABody) {
  Stack stack(240, 100);
  World& world = stack.world;
  ASSERT_TRUE(world.body(stack.upper).is_asleep);
  ASSERT_EQ(world.apply(SetEnabled{stack.ground, false}), Status::ok);
  EXPECT_FALSE(world.body(stack.lower).is_asleep);
  test::step(world, 30);
  EXPECT_LT(metres(world.position(stack.lower).y), 0.0);
  expect_valid(world);
}

TEST(SetEnabled, RefusesForcesAndSleepOfADisabledBody) {
  World world = test::make_world();
  const BodyHandle body = add_crate(world, {}, 1_m);
  ASSERT_EQ(world.apply(SetEnabled{body, false}), Status::ok);
  expect_refused(world, ApplyForce{body, {1_N, {}, {}}}, Status::invalid_argument);
  expect_refused(world, ApplyForceAt{body, {1_N, {}, {}}, {}}, Status::invalid_argument);
  expect_refused(world, SleepBody{body}, Status::invalid_argument);
  expect_refused(world, SetEnabled{{}, false}, Status::stale_handle);
  EXPECT_EQ(world.apply(ApplyImpulse{body, {1_Ns, {}, {}}}), Status::ok);
  EXPECT_EQ(world.apply(DestroyBody{body}), Status::ok);
  expect_valid(world);
}

TEST(SetEnabled, IsSavedAndRolledBack) {
  Stack stack(10, 500);
  World& world = stack.world;
  const std::vector<std::byte> enabled = test::save(world, SnapshotKind::canonical);
  test::step(world, 20);
  const std::uint64_t wanted = world.hash().total;
  ASSERT_EQ(world.load(SnapshotKind::canonical, enabled), Status::ok);
  ASSERT_EQ(world.apply(SetEnabled{stack.lower, false}), Status::ok);
  test::step(world, 5);
  const std::vector<std::byte> disabled = test::save(world, SnapshotKind::canonical);
  test::step(world, 20);
  const std::uint64_t without = world.hash().total;
  ASSERT_EQ(world.load(SnapshotKind::canonical, enabled), Status::ok);
  test::step(world, 20);
  EXPECT_EQ(world.hash().total, wanted);
  ASSERT_EQ(world.load(SnapshotKind::canonical, disabled), Status::ok);
  expect_valid(world);
  test::step(world, 20);
  EXPECT_EQ(world.hash().total, without);
}

}  // namespace
}  // namespace lockstone
