// Joints hold, limit, drive and break; and nothing but the state decides it.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/workload.h"
#include "tests/world/joints/joint_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::add_fixed, test::gap, test::join, test::number;

// A row of links that begins at the origin and points along x.
std::vector<BodyHandle> add_chain(World& world, int links, std::int64_t end_mass) {
  std::vector<BodyHandle> bodies{add_fixed(world)};
  for (int i = 0; i < links; ++i) {
    BodyDef def = test::dynamic_body(Shape::sphere(0.25_m), Position::from_ratio(2 * i + 1, 2),
                                     Position{}, Position{});
    // 1 kg: ρ = 1 / (4/3 π r³)
    def.material.density = Density::from_ratio(15279 * (i + 1 < links ? 1 : end_mass), 1000);
    JointDef joint = JointDef::of(JointKind::ball, bodies.back(), test::add(world, def));
    if (i > 0) joint.frame_a.position.x = 0.5_m;
    joint.frame_b.position.x = -0.5_m;
    bodies.push_back(joint.body_b);
    join(world, joint);
  }
  return bodies;
}

double worst_gap(const World& world) {
  double worst = 0;
  for (std::uint32_t i = 0; i < world.joint_limit(); ++i)
    worst = std::max(worst, gap(world.joint(world.joint_at(i))));
  return worst;
}

TEST(Joints, PendulumKeepsItsEnergy) {
  World world = test::make_world();
  JointDef joint = JointDef::of(JointKind::ball, add_fixed(world), {});
  joint.body_b = test::add(world, test::dynamic_body(Shape::sphere(0.1_m), 1_m, {}, {}));
  joint.frame_b.position.x = -1_m;
  join(world, joint);
  for (int tick = 0; tick < 600; ++tick) {
    (void)world.step();
    const BodyView bob = world.body(joint.body_b);
    const double v = std::hypot(number(bob.velocity.x.raw, 32), number(bob.velocity.y.raw, 32));
    const double w = number(bob.angular_velocity.z.raw, 32);
    const double energy =
        0.5 * (v * v + 0.004 * w * w) + 9.81 * number(bob.centre_of_mass.y.raw, 32);
    ASSERT_NEAR(energy, 0, 1e-4 * 9.81) << "tick " << tick;
  }
}

// A ball of 0.1 m on an arm of 1 m, level with a point that stands still.
struct Pendulum {
  World world = test::make_world();
  JointDef def = point();
  JointHandle joint = join(world, def);

  JointDef point() {
    JointDef point = JointDef::of(JointKind::ball, add_fixed(world), {});
    point.body_b = test::add(world, test::dynamic_body(Shape::sphere(0.1_m), 1_m, {}, {}));
    point.frame_b.position.x = -1_m;
    return point;
  }
  // Whether the solver had nothing to do.
  bool flies() { return world.step().free_bodies == 1; }
};

TEST(Joints, APendulumNeedsNoSolver) {
  Pendulum swings;
  for (int tick = 0; tick < 60; ++tick) {
    ASSERT_TRUE(swings.flies());
    ASSERT_LT(gap(swings.world.joint(swings.joint)), 2e-6);
  }
}

TEST(Joints, APendulumThatIsDrivenLimitedOrTiedTwiceIsSolved) {
  Pendulum driven;
  (void)driven.world.apply(
      SetAngularAxis{driven.joint, 0, {.max_effort = Torque::from_integer(1)}});
  EXPECT_FALSE(driven.flies());
  Pendulum limited;
  (void)limited.world.apply(
      SetAngularAxis{limited.joint, 1, {.mode = AxisMode::limited, .upper = 1_rad}});
  EXPECT_FALSE(limited.flies());
  Pendulum twice;
  join(twice.world, twice.def);
  EXPECT_FALSE(twice.flies());
  Pendulum locked;
  (void)locked.world.apply(SetAxisLocks{locked.def.body_b, {.move_z = true}});
  EXPECT_FALSE(locked.flies());
}

TEST(Joints, APendulumHitsABodyInItsWay) {
  Pendulum swings;
  BodyDef wall;
  wall.motion = MotionType::static_body;
  wall.shape = Shape::box(0.1_m, 0.2_m, 0.2_m);
  wall.position.y = -1_m;
  test::add(swings.world, wall);
  bool touched = false;
  for (int tick = 0; tick < 120; ++tick) {
    touched = swings.world.step().contacts > 0 || touched;
    ASSERT_LT(gap(swings.world.joint(swings.joint)), 5e-5);
    ASSERT_GT(number(swings.world.body(swings.def.body_b).position.x.raw, 32), 0.19);
  }
  EXPECT_TRUE(touched);
}

TEST(Joints, APendulumReturnsTheForceOfItsJoint) {
  for (const bool is_first : {false, true}) {
    World world = test::make_world();
    const BodyHandle ceiling = add_fixed(world);
    const BodyHandle lamp =
        test::add(world, test::dynamic_body(Shape::sphere(0.1_m), {}, -1_m, {}));
    JointDef def = is_first ? JointDef::of(JointKind::ball, lamp, ceiling)
                            : JointDef::of(JointKind::ball, ceiling, lamp);
    (is_first ? def.frame_a : def.frame_b).position.y = 1_m;
    const JointHandle joint = join(world, def);
    EXPECT_EQ(world.step().free_bodies, 1U);
    const double weight = 9.81 * 1000 * 4 / 3 * 3.14159265 * 0.001;
    EXPECT_NEAR(number(world.joint(joint).force.y.raw, 20), is_first ? -weight : weight,
                1e-4 * weight);
  }
}

// Where the second of two balls, each on an arm of 1 m, is after a second from the horizontal.
Vec3<Position> end_of_double_pendulum(std::uint8_t substeps) {
  World world = test::make_world({.body_capacity = 8,
                                  .pair_capacity = 64,
                                  .contact_capacity = 64,
                                  .joint_capacity = 4,
                                  .substeps = substeps});
  BodyHandle before = add_fixed(world);
  for (int i = 1; i <= 2; ++i) {
    JointDef joint = JointDef::of(JointKind::ball, before, {});
    joint.body_b = before = test::add(
        world, test::dynamic_body(Shape::sphere(0.1_m), Position::from_integer(i), {}, {}));
    joint.frame_b.position.x = -1_m;
    join(world, joint);
  }
  test::step(world, 60);
  return world.position(before);
}

TEST(Joints, ADoublePendulumIsOfSecondOrderAtCoarseSteps) {
  const Vec3<Position> exact = end_of_double_pendulum(16);
  const auto error = [&](std::uint8_t substeps) {
    const Vec3<Position> off = end_of_double_pendulum(substeps) - exact;
    return std::hypot(number(off.x.raw, 32), number(off.y.raw, 32), number(off.z.raw, 32));
  };
  const double coarse = error(1);
  EXPECT_LT(coarse, 5e-3);
  EXPECT_LT(error(2), coarse / 3);
}

TEST(Joints, ChainWithAHeavyEndStaysTogether) {
  for (const std::int64_t mass : {1, 100}) {
    World world = test::make_world();
    add_chain(world, 10, mass);
    for (int tick = 0; tick < 300; ++tick) {
      (void)world.step();
      ASSERT_LT(worst_gap(world), 5e-5) << mass << " kg, tick " << tick;
    }
  }
}

// Balls in a square, or boxes, each held to its neighbours; the upper corners stand still.
World make_net(int side, const Shape& shape) {
  World world = test::make_world();
  std::vector<BodyHandle> bodies;
  for (int i = 0; i < side * side; ++i) {
    BodyDef def = test::dynamic_body(shape, Position::from_integer(i % side),
                                     Position::from_integer(-(i / side)), Position{});
    def.filter.mask = 0;
    if (i == 0 || i == side - 1) def.motion = MotionType::static_body;
    bodies.push_back(test::add(world, def));
    const auto before = [&](int steps) { return bodies[static_cast<std::size_t>(i - steps)]; };
    if (i % side > 0) test::hold(world, before(1), bodies.back(), {0.5_m, {}, {}});
    if (i >= side) test::hold(world, before(side), bodies.back(), {{}, -0.5_m, {}});
  }
  return world;
}

TEST(Joints, NetsStayTogetherWellAndComeToRest) {
  for (const Shape& shape : {Shape::sphere(0.4_m), Shape::box(0.45_m, 0.45_m, 0.1_m)}) {
    World world = make_net(8, shape);
    for (int tick = 0; tick < 300; ++tick) {
      (void)world.step();
      ASSERT_LT(worst_gap(world), 4e-3) << "tick " << tick;
    }
    EXPECT_LT(worst_gap(world), 2e-3);
    for (std::uint32_t i = 0; i < world.body_count(); ++i) {
      const Vec3<Velocity> v = world.velocity(world.body_at(i));
      EXPECT_LT(std::hypot(number(v.x.raw, 32), number(v.y.raw, 32), number(v.z.raw, 32)), 1e-3);
    }
  }
}

TEST(Joints, WeldHoldsAsOne) {
  World world = test::make_world();
  const BodyHandle a =
      test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, 3_m, {}));
  const BodyHandle b = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), 1_m, 3_m, {}));
  JointDef weld = JointDef::of(JointKind::weld, a, b);
  weld.frame_a.position.x = 0.5_m;
  weld.frame_b.position.x = -0.5_m;
  const JointHandle joint = join(world, weld);
  test::add_ground(world);
  for (int tick = 0; tick < 200; ++tick) {
    (void)world.step();
    const JointView view = world.joint(joint);
    ASSERT_LT(gap(view), 2e-3);
    for (int i = 0; i < 3; ++i)
      ASSERT_NEAR(number(view.angle[i].raw, 27), 0, 2e-3);
  }
}

// A rope of capsules falls about a post, with a load at its end.
double widest_gap_about_a_post(int links, std::int64_t load) {
  World world = test::make_world();
  BodyDef post;
  post.motion = MotionType::static_body;
  post.shape = Shape::capsule(0.2_m, 3_m);
  post.position = {Position::from_ratio(links, 20), Position::from_ratio(-links, 10), {}};
  post.orientation = from_axis_angle({1_r, {}, {}}, 1.570796327_rad);
  test::add(world, post);
  JointDef joint = JointDef::of(JointKind::ball, add_fixed(world), {});
  for (int i = 0; i <= links; ++i) {
    const bool is_load = i == links;
    BodyDef def =
        test::dynamic_body(is_load ? Shape::sphere(0.2_m) : Shape::capsule(0.04_m, 0.06_m),
                           Position::from_ratio(is_load ? 2 * links : 2 * i + 1, 10), {}, {});
    def.orientation = from_axis_angle({{}, {}, 1_r}, 1.570796327_rad);
    def.material.density = Density::from_integer(is_load ? 27 * load : 1000);
    joint.body_b = test::add(world, def);
    joint.frame_b.position.y = is_load ? Length{} : 0.1_m;
    join(world, joint);
    joint.body_a = joint.body_b;
    joint.frame_a.position.y = -0.1_m;
  }
  double widest = 0;
  constexpr int k_ticks = LKS_SANITIZED ? 240 : 480;
  for (int tick = 0; tick < k_ticks; ++tick) {
    (void)world.step();
    widest = std::max(widest, worst_gap(world));
  }
  return widest;
}

// With sanitizers each rope carries one load, the heaviest.
TEST(Joints, RopesAboutAPostStayTogether) {
  for (const int links : {6, 12, 16, 24, 36})
    for (const int load : {250, 100, 10}) {
      if (LKS_SANITIZED && load != 250) continue;
      EXPECT_LT(widest_gap_about_a_post(links, load), 0.02)
          << links << " links, " << load << " : 1";
    }
}

TEST(Joints, FastBodiesPassBodiesThatTheyAreJoinedTo) {
  World world = test::make_world();
  BodyDef base;
  base.motion = MotionType::static_body;
  base.shape = Shape::box(0.5_m, 0.1_m, 1_m);
  const BodyHandle fixed = test::add(world, base);
  const BodyHandle plank =
      test::add(world, test::dynamic_body(Shape::box(0.48_m, 0.06_m, 1_m), 1_m, {}, {}));
  for (const Length side : {Length::from_ratio(-9, 10), Length::from_ratio(9, 10)}) {
    JointDef joint = JointDef::of(JointKind::ball, fixed, plank);
    joint.frame_a.position = {0.5_m, {}, side};
    joint.frame_b.position = {-0.5_m, {}, side};
    join(world, joint);
  }
  for (int tick = 0; tick < 240; ++tick) {
    ASSERT_EQ(world.step().impacts, 0U);
    ASSERT_LT(worst_gap(world), 1e-5);
  }
}

TEST(Joints, RopeIsNeverLongerThanItsLimit) {
  World world = test::make_world();
  JointDef rope = JointDef::of(JointKind::distance, add_fixed(world), {});
  rope.body_b = test::add(world, test::dynamic_body(Shape::sphere(0.2_m), 0.5_m, {}, {}));
  rope.linear[0].mode = AxisMode::limited;
  rope.linear[0].upper = 2_m;
  const JointHandle joint = join(world, rope);
  double longest = 0;
  for (int tick = 0; tick < 300; ++tick) {
    (void)world.step();
    longest = std::max(longest, number(world.joint(joint).offset.x.raw, 20));
  }
  EXPECT_GT(longest, 1.99);
  EXPECT_LT(longest, 2.01);
}

TEST(Joints, PulleyKeepsItsLength) {
  World world = test::make_world();
  const auto bob = [&](Position x, int density) {
    BodyDef def = test::dynamic_body(Shape::sphere(0.25_m), x, {}, {});
    def.material.density = Density::from_integer(density);
    return test::add(world, def);
  };
  JointDef pulley = JointDef::of(JointKind::pulley, bob(-1_m, 1000), bob(1_m, 2000));
  pulley.ground_a = {-1_m, 5_m, {}};
  pulley.ground_b = {1_m, 5_m, {}};
  join(world, pulley);
  test::step(world, 60);
  const Vec3<Position> a = world.position(pulley.body_a), b = world.position(pulley.body_b);
  EXPECT_NEAR(test::metres(a.y) + test::metres(b.y), 0, 1e-5);
  EXPECT_NEAR(test::metres(a.y), 9.81 / 3 / 2, 1e-2);  // a = g·(m₂ − m₁)/(m₁ + m₂)
}

TEST(Joints, GearTurnsTheOtherWay) {
  World world = test::make_world(
      {.body_capacity = 8, .pair_capacity = 8, .contact_capacity = 8, .gravity = {}});
  const BodyHandle base = add_fixed(world);
  const auto wheel = [&](Position x) {
    const BodyHandle body = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), x, {}, {}));
    JointDef hinge = JointDef::of(JointKind::hinge, base, body);
    hinge.frame_a.position.x = saturated<Length>(x);
    join(world, hinge);
    return body;
  };
  const BodyHandle a = wheel(-2_m), b = wheel(2_m);
  JointDef gear = JointDef::of(JointKind::gear, a, b);
  gear.ratio = 2_r;
  join(world, gear);
  ASSERT_EQ(world.apply(SetAngularVelocity{a, {6_rps, {}, {}}}), Status::ok);
  test::step(world, 60);
  const double of_a = number(world.body(a).angular_velocity.x.raw, 32);
  const double of_b = number(world.body(b).angular_velocity.x.raw, 32);
  EXPECT_GT(std::abs(of_a), 1);
  EXPECT_NEAR(of_a + 2 * of_b, 0, 1e-5);
}

// A pinion of 5 rad for each metre of its rack.
TEST(Joints, RackMovesAsItsPinionTurns) {
  World world = test::make_world(
      {.body_capacity = 8, .pair_capacity = 8, .contact_capacity = 8, .gravity = {}});
  const BodyHandle base = add_fixed(world);
  const BodyHandle pinion = test::add(world, test::dynamic_body(Shape::sphere(0.2_m), {}, {}, {}));
  const BodyHandle bar =
      test::add(world, test::dynamic_body(Shape::box(1_m, 0.1_m, 0.1_m), {}, -1_m, {}));
  join(world, JointDef::of(JointKind::hinge, base, pinion));
  JointDef slider = JointDef::of(JointKind::slider, base, bar);
  slider.frame_a.position.y = -1_m;
  join(world, slider);
  JointDef rack = JointDef::of(JointKind::rack, pinion, bar);
  rack.ratio = 5_r;
  join(world, rack);
  ASSERT_EQ(world.apply(SetAngularVelocity{pinion, {60_rps, {}, {}}}), Status::ok);
  ASSERT_EQ(world.apply(SetVelocity{bar, {-1_mps, {}, {}}}), Status::ok);
  test::step(world, 60);
  const double turning = number(world.body(pinion).angular_velocity.x.raw, 32);
  const double speed = test::metres_per_second(world.velocity(bar).x);
  EXPECT_LT(speed, -0.5);
  EXPECT_NEAR(turning + 5 * speed, 0, 1e-5);
}

TEST(Joints, PulleyOfARatioIsATackle) {
  World world = test::make_world();
  BodyDef def = test::dynamic_body(Shape::sphere(0.25_m), -1_m, {}, {});
  const BodyHandle a = test::add(world, def);
  def.position.x = 1_m;
  def.material.density = Density::from_integer(3000);
  JointDef pulley = JointDef::of(JointKind::pulley, a, test::add(world, def));
  pulley.ground_a = {-1_m, 5_m, {}};
  pulley.ground_b = {1_m, 5_m, {}};
  pulley.ratio = 2_r;
  join(world, pulley);
  test::step(world, 60);
  const double up = test::metres(world.position(a).y);
  EXPECT_NEAR(up + 2 * test::metres(world.position(pulley.body_b).y), 0, 1e-5);
  EXPECT_NEAR(up, 9.81 * 2 / 7 / 2, 1e-2);  // a = g·r·(m₂ − r·m₁)/(m₂ + r²·m₁)
}

// A box on a base that goes 2 m/s along x and turns at 1 rad/s about z.
struct MovingBase {
  World world;
  JointHandle joint;
  BodyHandle box;

  MovingBase(JointKind kind, std::uint8_t substeps)
      : world(test::make_world({.body_capacity = 8,
                                .pair_capacity = 8,
                                .contact_capacity = 8,
                                .substeps = substeps})) {
    BodyDef base;
    base.motion = MotionType::kinematic;
    base.velocity.x = 2_mps;
    base.angular_velocity.z = 1_rps;
    BodyDef hung = test::dynamic_body(Shape::box(0.2_m, 0.3_m, 0.25_m), 1_m, {}, {});
    hung.velocity = {2_mps, 1_mps, {}};
    hung.angular_velocity.z = 1_rps;
    box = test::add(world, hung);
    JointDef def = JointDef::of(kind, test::add(world, base), box);
    def.frame_a.position.x = 0.5_m;
    def.frame_b.position.x = -0.5_m;
    joint = join(world, def);
  }

  // How far the box is from where a weld takes it.
  [[nodiscard]] double astray() const {
    const double t = static_cast<double>(world.tick()) / 60;
    const Vec3<Position> at = world.position(box);
    return std::hypot(test::metres(at.x) - 2 * t - std::cos(t), test::metres(at.y) - std::sin(t),
                      test::metres(at.z));
  }
};

TEST(Joints, HoldOnToABaseThatMovesAndTurns) {
  for (const std::uint8_t substeps : {std::uint8_t{1}, std::uint8_t{4}}) {
    MovingBase weld(JointKind::weld, substeps), pendulum(JointKind::ball, substeps);
    for (int tick = 0; tick < 120; ++tick) {
      (void)weld.world.step();
      (void)pendulum.world.step();
      ASSERT_LT(weld.astray(), 1e-6) << "tick " << tick;
      ASSERT_LT(gap(weld.world.joint(weld.joint)), 2e-6) << "tick " << tick;
      ASSERT_LT(gap(pendulum.world.joint(pendulum.joint)), 2e-6) << "tick " << tick;
    }
  }
}

TEST(Joints, BreakBeyondTheirForceWithAnEvent) {
  World world = test::make_world();
  const BodyHandle base = add_fixed(world);
  JointDef def = JointDef::of(JointKind::ball, base, {});
  def.body_b = test::add(world, test::dynamic_body(Shape::sphere(0.5_m), {}, -1_m, {}));
  def.frame_b.position.y = 1_m;  // 524 kg hang from it
  def.user_data = 7;
  for (const std::int64_t newtons : {10000, 4000}) {
    def.break_force = Force::from_integer(newtons);
    const JointHandle joint = join(world, def);
    int events = 0;
    for (int tick = 0; tick < 60; ++tick) {
      (void)world.step();
      for (const JointEvent& event : world.joint_events()) {
        EXPECT_EQ(event.joint, joint);
        EXPECT_EQ(event.user_data, 7U);
        ++events;
      }
    }
    EXPECT_EQ(world.exists(joint), newtons > 5200);
    EXPECT_EQ(events, newtons > 5200 ? 0 : 1);
    if (newtons > 5200) {
      EXPECT_NEAR(number(world.joint(joint).force.y.raw, 20), 523.6 * 9.81, 30);
      ASSERT_EQ(world.apply(DestroyJoint{joint}), Status::ok);
    }
  }
}

TEST(Joints, DroppingDerivedDataAndSavingChangesNothing) {
  World plain = test::make_world();
  test::add_ground(plain);
  add_chain(plain, 6, 5);
  World heavy = test::make_world();
  ASSERT_EQ(heavy.load(SnapshotKind::canonical, test::save(plain, SnapshotKind::canonical)),
            Status::ok);
  for (int tick = 0; tick < 120; ++tick) {
    (void)plain.step();
    heavy.drop_derived();
    (void)heavy.step();
    const std::vector<std::byte> saved = test::save(heavy, SnapshotKind::canonical);
    ASSERT_EQ(heavy.load(SnapshotKind::canonical, saved), Status::ok);
    ASSERT_EQ(heavy.hash().total, plain.hash().total) << "tick " << tick;
  }
}

}  // namespace
}  // namespace lockstone
