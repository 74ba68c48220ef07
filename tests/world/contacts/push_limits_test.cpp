// Pushes without end: of the greatest size, as often as anyone likes. Their sum is bounded, keeps
// its sign and can be saved at any time.

#include <functional>

#include <gtest/gtest.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

constexpr int k_pushes = 5000;

// One command of each kind that pushes, for the greatest or the least values.
template <class T>
Vec3<T> same(T x) {
  return {x, x, x};
}

template <class T>
T extreme(bool greatest) {
  return greatest ? T::max() : T::min();
}

std::vector<Command> greatest_pushes(BodyHandle body, bool greatest) {
  const auto impulse = same(extreme<Impulse>(greatest));
  const auto turn = same(extreme<AngularImpulse>(greatest));
  const auto force = same(extreme<Force>(greatest));
  const auto torque = same(extreme<Torque>(greatest));
  const Vec3<Length> point{0.05_m, -0.05_m, 0.02_m};
  std::vector<Command> pushes;
  for (const Frame frame : {Frame::world, Frame::body}) {
    pushes.insert(pushes.end(),
                  {ApplyImpulse{body, impulse, frame}, ApplyImpulseAt{body, impulse, point, frame},
                   ApplyAngularImpulse{body, turn, frame}, ApplyForce{body, force, frame},
                   ApplyForceAt{body, force, point, frame}, ApplyTorque{body, torque, frame}});
  }
  return pushes;
}

struct Thrown {
  World world = test::make_world({.body_capacity = 8, .pair_capacity = 64, .contact_capacity = 64});
  BodyHandle body;

  explicit Thrown(const Shape& shape, std::uint16_t tick_rate = 60)
      : world(test::make_world({.body_capacity = 8,
                                .pair_capacity = 64,
                                .contact_capacity = 64,
                                .tick_rate = tick_rate})) {
    test::add_ground(world);
    BodyDef def = test::dynamic_body(shape, {}, 0.1_m, {});
    def.orientation = {Unit::from_ratio(1, 3), Unit::from_ratio(1, 2), Unit::from_ratio(-1, 7),
                       Unit::from_ratio(5, 7)};
    body = test::add(world, def);
    test::add(world, test::dynamic_body(shape, 0.3_m, 0.1_m, {}));
  }
};

const Shape k_shapes[] = {Shape::sphere(0.1_m), Shape::box(0.1_m, 0.2_m, 0.1_m),
                          Shape::box(0.001_m, 3_m, 0.001_m), Shape::capsule(0.5_m, 0.01_m)};

void expect_savable(const World& world) {
  World copy = test::make_world(world.def());
  EXPECT_EQ(copy.load(SnapshotKind::canonical, test::save(world, SnapshotKind::canonical)),
            Status::ok);
}

TEST(Push, OfTheGreatestSizeManyTimesIsBoundedAndCanBeSaved) {
  for (const Shape& shape : k_shapes) {
    for (const bool greatest : {true, false}) {
      Thrown thrown(shape);
      for (const Command& push : greatest_pushes(thrown.body, greatest)) {
        for (int i = 0; i < k_pushes; ++i)
          ASSERT_EQ(thrown.world.apply(push), Status::ok);
        expect_savable(thrown.world);
        for (int i = 0; i < 3; ++i)
          ASSERT_EQ(thrown.world.apply(push), Status::ok);
        test::step(thrown.world, 2);
        EXPECT_FALSE(thrown.world.find_fault()) << thrown.world.find_fault().what;
        expect_savable(thrown.world);
      }
    }
  }
}

TEST(Push, AddedToItselfKeepsItsSign) {
  for (const bool greatest : {true, false}) {
    Thrown thrown(k_shapes[0]);
    ASSERT_EQ(thrown.world.apply(SetGravity{}), Status::ok);
    const ApplyImpulse push{thrown.body, {extreme<Impulse>(greatest), {}, {}}};
    for (int i = 0; i < 530'000; ++i)
      ASSERT_EQ(thrown.world.apply(push), Status::ok);
    const Velocity v = thrown.world.velocity(thrown.body).x;
    EXPECT_EQ(v, greatest ? k_speed_limit : -k_speed_limit);
  }
}

// A force can take a body from one end of its range of speeds to the other within the tick.
TEST(Push, MovesABodyNoFartherInATickThanTwiceTheSpeedLimitDoes) {
  constexpr std::uint16_t k_rates[] = {10, 60, 480};
  for (const std::uint16_t rate : k_rates) {
    for (const auto& command : greatest_pushes({}, true)) {
      Thrown thrown(Shape::sphere(0.1_m), rate);
      ASSERT_EQ(thrown.world.apply(Teleport{thrown.body, {{}, 5000_m, {}}, {}}), Status::ok);
      Command push = command;
      std::visit(
          [&](auto& c) {
            if constexpr (requires { c.body; }) c.body = thrown.body;
          },
          push);
      for (int i = 0; i < 100; ++i)
        ASSERT_EQ(thrown.world.apply(push), Status::ok);
      const Vec3<Position> before = thrown.world.position(thrown.body);
      (void)thrown.world.step();
      const Vec3<Position> after = thrown.world.position(thrown.body);
      for (int i = 0; i < 3; ++i)
        EXPECT_LE(abs(after[i] - before[i]), Position::from_ratio(1001, rate)) << push.index();
    }
  }
}

JointDef greatest_motor(BodyHandle a, BodyHandle b) {
  JointDef motor = JointDef::of(JointKind::six_axis, a, b);
  for (std::size_t i = 0; i < 3; ++i) {
    motor.linear[i].speed = SolverVelocity::max();
    motor.linear[i].max_effort.raw = std::int64_t{1} << 56;
    motor.angular[i].speed = Rate::min();
    motor.angular[i].max_effort.raw = std::int64_t{1} << 56;
  }
  return motor;
}

// Gravity, a belt, and velocities of two bodies away from each other.
std::vector<Command> greatest_drives(BodyHandle ground, BodyHandle one, BodyHandle other) {
  const auto fast = SolverVelocity::from_integer(500);
  const auto turning = Rate::from_integer(500);
  return {SetSurfaceMotion{ground, {{fast, -fast, fast}, {turning, turning, -turning}}},
          SetGravity{same(Acceleration::from_integer(1000))},
          SetGravityScale{one, Number::from_integer(100)},
          SetGravityScale{other, Number::from_integer(-100)},
          SetVelocity{one, same(k_speed_limit)},
          SetVelocity{other, same(-k_speed_limit)},
          SetAngularVelocity{one, same(AngularVelocity::from_integer(900))},
          SetAngularVelocity{other, same(AngularVelocity::from_integer(-900))}};
}

// Everything else that adds up: velocities at their limits, gravity, belts and motors.
TEST(Drive, OfTheGreatestSizeStaysWithinRange) {
  Thrown thrown(Shape::box(0.1_m, 0.2_m, 0.1_m), 10);
  World& world = thrown.world;
  const BodyHandle other = world.body_at(2);
  ASSERT_TRUE(world.create_joint(greatest_motor(thrown.body, other)).ok());
  const auto drives = greatest_drives(world.body_at(0), thrown.body, other);
  for (int tick = 0; tick < 60; ++tick) {
    for (const Command& drive : drives)
      ASSERT_EQ(world.apply(drive), Status::ok) << drive.index();
    for (const Command& push : greatest_pushes(tick % 2 == 0 ? thrown.body : other, tick % 3 == 0))
      ASSERT_EQ(world.apply(push), Status::ok) << push.index();
    expect_savable(world);
    (void)world.step();
    ASSERT_FALSE(world.find_fault()) << world.find_fault().what;
    expect_savable(world);
  }
}

}  // namespace
}  // namespace lockstone
