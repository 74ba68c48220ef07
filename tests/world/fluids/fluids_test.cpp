// Bodies in fluids: Archimedes, draughts, metacentric heights, terminal velocities, currents.
#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/rollback_history.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;
using test::metres_per_second;

constexpr double k_gravity = 9.81;

Fluid water(Position level = {}) {
  Fluid fluid{.surface = {{}, level, {}}, .size = {100_m, 50_m, 100_m}};
  fluid.density = Density::from_integer(1000);
  return fluid;
}

BodyDef floating(const Shape& shape, Density density, Position y) {
  BodyDef def = test::dynamic_body(shape, {}, y, {});
  def.material.density = density;
  return def;
}

World sea(const Fluid& fluid = water(), std::uint16_t sleep_ms = 500) {
  World world = test::make_world({.body_capacity = 32, .sleep_ms = sleep_ms});
  EXPECT_EQ(world.apply(SetFluid{0, fluid}), Status::ok);
  return world;
}

double vertical_speed(const World& world, BodyHandle body) {
  return metres_per_second(world.velocity(body).y);
}

// Archimedes: a whole body under water is pushed up by the weight of the water it displaces.
TEST(Buoyancy, OfASubmergedBodyIsTheWeightOfItsVolume) {
  for (const Shape& shape : {Shape::sphere(0.5_m), Shape::box(0.5_m, 0.25_m, 1_m),
                             Shape::capsule(0.5_m, 0.25_m), Shape::cylinder(0.5_m, 0.25_m),
                             Shape::cone(1_m, 0.5_m), Shape::tapered_capsule(1_m, 0.5_m, 0.2_m),
                             Shape::rounded_box(0.4_m, 0.2_m, 0.3_m, 0.1_m)}) {
    World world = sea();
    BodyDef def = floating(shape, Density::from_integer(2000), -20_m);
    def.orientation = from_axis_angle({0.6_r, {}, 0.8_r}, 40_deg);
    const BodyHandle body = test::add(world, def);
    test::step(world, 60);
    EXPECT_NEAR(vertical_speed(world, body), -k_gravity / 2, 2e-6);
    EXPECT_NEAR(metres(world.position(body).y), -20 - k_gravity / 4, 2e-6);
    EXPECT_EQ(world.body(body).angular_velocity, Vec3<AngularVelocity>{});
  }
}

TEST(Buoyancy, FloatsABoxLevelAtItsDraught) {
  Fluid fluid = water();
  fluid.linear_drag = 2_rps;
  World world = sea(fluid, 0);
  BodyDef def = floating(Shape::box(1_m, 0.25_m, 2_m), Density::from_integer(600), 0.2_m);
  def.orientation = from_axis_angle({0.6_r, {}, 0.8_r}, 10_deg);
  const BodyHandle body = test::add(world, def);
  test::step(world, 900);
  // 0.5 m · 600 / 1000 lie under water.
  EXPECT_NEAR(metres(world.position(body).y), 0.25 - 0.3, 2e-5);
  const Quat turned = world.body(body).orientation;
  EXPECT_LT(std::abs(turned.x.raw) + std::abs(turned.z.raw), 1 << 16);
}

TEST(Buoyancy, LetsAFloatingBodyFallAsleep) {
  Fluid fluid = water();
  fluid.linear_drag = 2_rps;
  World world = sea(fluid);
  const BodyHandle body =
      test::add(world, floating(Shape::box(1_m, 0.25_m, 2_m), Density::from_integer(600), 0.2_m));
  test::step(world, 900);
  EXPECT_TRUE(world.body(body).is_asleep);
  EXPECT_NEAR(metres(world.position(body).y), 0.25 - 0.3, 5e-3);
  const std::uint64_t hash = world.hash().bodies;
  test::step(world, 60);
  EXPECT_EQ(world.hash().bodies, hash);
}

TEST(Buoyancy, OfAHeavingBodyLosesAndGainsNoEnergy) {
  World world = sea(water(), 0);
  const BodyHandle body =
      test::add(world, floating(Shape::box(1_m, 0.5_m, 1_m), Density::from_integer(500), 0.1_m));
  double first = 0, last = 0;
  int crossings = 0;
  double before = 0.1;
  for (int tick = 0; tick < 60 * 60; ++tick) {
    test::step(world, 1);
    const double y = metres(world.position(body).y);
    if (tick < 120) first = std::max(first, std::abs(y));
    if (tick >= 58 * 60) last = std::max(last, std::abs(y));
    if (before < 0 && y >= 0) ++crossings;
    before = y;
  }
  EXPECT_NEAR(first, 0.1, 1e-3);
  EXPECT_NEAR(last, first, 1e-3);
  // ω = √(g / draught), 0.5 m.
  EXPECT_NEAR(crossings, 60 * std::sqrt(k_gravity / 0.5) / (2 * std::acos(-1.0)), 1.0);
}

// Roll about the long axis with a small amplitude: ω² = g·GM / k², GM = b²/(12 T) − (D − T)/2.
TEST(Buoyancy, RightsABoxAsItsMetacentricHeightSays) {
  World world = sea(water(), 0);
  constexpr double k_beam = 2, k_height = 1, k_draught = 0.5;
  BodyDef def = floating(Shape::box(1_m, 0.5_m, 3_m), Density::from_integer(500), {});
  def.orientation = from_axis_angle({{}, {}, Unit::from_integer(1)}, 1_deg);
  const BodyHandle body = test::add(world, def);
  int crossings = 0;
  std::int32_t before = world.body(body).orientation.z.raw;
  double most = 0;
  for (int tick = 0; tick < 60 * 30; ++tick) {
    test::step(world, 1);
    const std::int32_t now = world.body(body).orientation.z.raw;
    if (before < 0 && now >= 0) ++crossings;
    before = now;
    if (tick > 28 * 60) most = std::max(most, std::abs(std::ldexp(now, -30)));
  }
  const double metacentric = k_beam * k_beam / (12 * k_draught) - (k_height - k_draught) / 2;
  const double gyration = (k_beam * k_beam + k_height * k_height) / 12;
  const double hertz = std::sqrt(k_gravity * metacentric / gyration) / (2 * std::acos(-1.0));
  EXPECT_NEAR(crossings, 30 * hertz, 1.0);
  EXPECT_NEAR(most, std::sin(std::acos(-1.0) / 360), 2e-4);
}

TEST(Buoyancy, TurnsABoxOverWhoseMetacentreIsBelowItsCentre) {
  Fluid fluid = water();
  fluid.linear_drag = 1_rps;
  World world = sea(fluid);
  BodyDef def = floating(Shape::box(0.25_m, 1_m, 0.25_m), Density::from_integer(500), {});
  def.orientation = from_axis_angle({{}, {}, Unit::from_integer(1)}, 1_deg);
  const BodyHandle body = test::add(world, def);
  test::step(world, 900);
  EXPECT_LT(std::abs(metres(
                rotate(to_matrix(world.body(body).orientation), Vec3<Position>{{}, 1_m, {}}).y)),
            0.2);
}

TEST(Buoyancy, HoldsABallThatIsAThousandTimesLighter) {
  World world = sea();
  const BodyHandle body =
      test::add(world, floating(Shape::sphere(0.5_m), Density::from_integer(1), 0.5_m));
  double highest = 0;
  for (int tick = 0; tick < 1200; ++tick) {
    test::step(world, 1);
    highest = std::max(highest, std::abs(metres(world.position(body).y) - 0.5));
  }
  EXPECT_LT(highest, 0.1);
}

TEST(Drag, GivesABallItsTerminalVelocity) {
  Fluid fluid = water();
  fluid.size.y = 2000_m;
  fluid.drag = Number::from_ratio(1, 2);
  World world = sea(fluid);
  const BodyHandle body =
      test::add(world, floating(Shape::sphere(0.1_m), Density::from_integer(7800), -5_m));
  test::step(world, 600);
  // ½ ρ C π r² v² = (ρb − ρ) 4/3 π r³ g
  const double terminal = std::sqrt(2 * 6.8 * (4.0 / 3) * 0.1 * k_gravity / 0.5);
  EXPECT_NEAR(vertical_speed(world, body), -terminal, 1e-5 * terminal);
}

TEST(Drag, FollowsTheShadowOfTheShape) {
  Fluid wind = water(100_m);
  wind.density = Density::from_ratio(6, 5);
  wind.size.y = 200_m;
  wind.drag = Number::from_integer(1);
  wind.flow = {20_mps, {}, {}};
  World world = test::make_world({.body_capacity = 4, .gravity = {}});
  ASSERT_EQ(world.apply(SetFluid{3, wind}), Status::ok);
  const BodyHandle broad =
      test::add(world, test::dynamic_body(Shape::box(0.1_m, 1_m, 1_m), {}, 0_m, {}));
  const BodyHandle narrow =
      test::add(world, test::dynamic_body(Shape::box(1_m, 1_m, 0.1_m), {}, 0_m, 5_m));
  test::step(world, 1);
  const auto expected = [](double area, double mass) { return 0.5 * 1.2 * area * 400 / mass / 60; };
  EXPECT_NEAR(metres_per_second(world.velocity(broad).x), expected(4, 800), 1e-4);
  EXPECT_NEAR(metres_per_second(world.velocity(narrow).x), expected(0.4, 800), 1e-5);
}

TEST(Drag, CarriesAFloatingBodyAlongWithTheCurrent) {
  Fluid river = water();
  river.linear_drag = 1_rps;
  river.flow = {2_mps, {}, {}};
  World world = sea(river);
  const BodyHandle body =
      test::add(world, floating(Shape::sphere(0.5_m), Density::from_integer(500), {}));
  test::step(world, 1200);
  EXPECT_NEAR(metres_per_second(world.velocity(body).x), 2, 1e-3);
}

TEST(Fluid, ActsOnTheBodiesOfItsMaskWithinItsSides) {
  Fluid pool = water();
  pool.size = {5_m, 5_m, 5_m};
  pool.mask = 2;
  World world = sea(pool);
  BodyDef def = floating(Shape::sphere(0.5_m), Density::from_integer(100), -2_m);
  const BodyHandle other = test::add(world, def);
  def.filter.category = 2;
  def.position.z = 3_m;
  const BodyHandle wet = test::add(world, def);
  def.position.z = 6_m;
  const BodyHandle beside = test::add(world, def);
  test::step(world, 10);
  EXPECT_LT(vertical_speed(world, other), -1);
  EXPECT_GT(vertical_speed(world, wet), 1);
  EXPECT_LT(vertical_speed(world, beside), -1);
}

TEST(Fluid, OfACompoundCarriesEachPart) {
  CompoundChild children[2];
  children[0].shape = Shape::box(0.5_m, 0.5_m, 0.5_m);
  children[1].shape = Shape::sphere(0.5_m);
  children[1].position = {2_m, {}, {}};
  const CompoundResult built = Compound::build(children);
  ASSERT_TRUE(built.ok());
  auto assets = std::make_shared<const AssetSet>(std::vector<AssetPtr>{built.compound});
  World world = test::make_world({.body_capacity = 4}, std::move(assets));
  ASSERT_EQ(world.apply(SetFluid{0, water()}), Status::ok);
  BodyDef def = floating(built.compound->shape(), Density::from_integer(2000), -20_m);
  const BodyHandle body = test::add(world, def);
  test::step(world, 60);
  EXPECT_NEAR(vertical_speed(world, body), -k_gravity / 2, 1e-5);
  EXPECT_LT(std::abs(static_cast<double>(world.body(body).angular_velocity.z.raw)), 1e5);
}

TEST(SetFluid, WakesTheBodiesInItAndKeepsTheOthersAsleep) {
  World world = test::make_world({.body_capacity = 8, .sleep_ms = 100});
  test::add_ground(world);
  const Shape ball = Shape::box(0.5_m, 0.5_m, 0.5_m);
  const BodyHandle inside = test::add(world, floating(ball, Density::from_integer(300), 0.5_m));
  BodyDef def = floating(ball, Density::from_integer(300), 0.5_m);
  def.position.x = 40_m;
  const BodyHandle outside = test::add(world, def);
  test::step(world, 120);
  ASSERT_TRUE(world.body(inside).is_asleep && world.body(outside).is_asleep);
  Fluid pool = water(2_m);
  pool.size = {5_m, 3_m, 5_m};
  ASSERT_EQ(world.apply(SetFluid{1, pool}), Status::ok);
  EXPECT_EQ(fluid_at(world, 1), pool);
  EXPECT_EQ(fluid_at(world, 0), Fluid{});
  EXPECT_FALSE(world.body(inside).is_asleep);
  EXPECT_TRUE(world.body(outside).is_asleep);
  test::step(world, 120);
  EXPECT_GT(world.position(inside).y, 1_m);
  ASSERT_EQ(world.apply(SetFluid{1, {}}), Status::ok);
  test::step(world, 240);
  EXPECT_NEAR(metres(world.position(inside).y), 0.5, 0.01);
}

TEST(SetFluid, RefusesValuesOutOfRange) {
  World world = sea();
  const auto refused = [&](auto&& change) {
    SetFluid command{1, water()};
    change(command);
    const std::uint64_t before = world.hash().total;
    EXPECT_EQ(world.apply(command), Status::invalid_argument);
    EXPECT_EQ(world.hash().total, before);
    return world.explain(command).field;
  };
  EXPECT_EQ(refused([](SetFluid& c) { c.number = k_max_fluids; }), "SetFluid.number");
  EXPECT_EQ(refused([](SetFluid& c) { c.fluid.size.y = {}; }), "SetFluid.fluid.size.y");
  EXPECT_EQ(refused([](SetFluid& c) { c.fluid.density = Density::from_raw(-1); }),
            "SetFluid.fluid.density");
  EXPECT_EQ(refused([](SetFluid& c) { c.fluid.drag = Number::from_integer(101); }),
            "SetFluid.fluid.drag");
  EXPECT_EQ(refused([](SetFluid& c) { c.fluid.orientation.w = {}; }), "SetFluid.fluid.orientation");
}

TEST(Fluid, IsStateThatIsSavedHashedAndNamed) {
  World world = sea();
  const BodyHandle body =
      test::add(world, floating(Shape::sphere(0.5_m), Density::from_integer(400), 1_m));
  test::step(world, 10);
  const std::vector<std::byte> saved = test::save(world, SnapshotKind::canonical);
  test::step(world, 30);
  const std::uint64_t wanted = world.hash().total;
  const Vec3<Position> place = world.position(body);
  Fluid oil = water();
  oil.density = Density::from_integer(800);
  ASSERT_EQ(world.load(SnapshotKind::canonical, saved), Status::ok);
  EXPECT_FALSE(world.find_fault());
  ASSERT_EQ(world.apply(SetFluid{0, oil}), Status::ok);
  const StateDifference difference =
      world.describe_difference(saved, test::save(world, SnapshotKind::canonical));
  EXPECT_EQ(difference.store, "fluid");
  EXPECT_EQ(difference.field, "density");
  test::step(world, 30);
  EXPECT_NE(world.position(body), place);
  ASSERT_EQ(world.load(SnapshotKind::canonical, saved), Status::ok);
  test::step(world, 30);
  EXPECT_EQ(world.hash().total, wanted);
}

TEST(Fluid, ChangesConcernAllIslandsOfAHistory) {
  const auto run = [](bool with_history) {
    World world = sea();
    for (int i = 0; i < 4; ++i) {
      BodyDef def = floating(Shape::sphere(0.5_m), Density::from_integer(400), 1_m);
      def.position.x = Position::from_integer(5 * i);
      test::add(world, def);
    }
    RollbackHistory history(world, with_history ? 16 : 0);
    const std::vector<std::byte> start = test::save(world, SnapshotKind::native);
    for (int tick = 0; tick < 10; ++tick)
      (void)history.step();
    EXPECT_EQ(world.load(SnapshotKind::native, start), Status::ok);
    Fluid rising = water(0.5_m);
    EXPECT_EQ(world.apply(SetFluid{0, rising}), Status::ok);
    for (int tick = 0; tick < 10; ++tick)
      (void)history.step();
    return world.hash().total;
  };
  EXPECT_EQ(run(true), run(false));
}

}  // namespace
}  // namespace lockstone
