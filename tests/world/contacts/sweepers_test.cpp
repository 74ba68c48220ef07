// Fast kinematic bodies and fast triggers meet all that they sweep over, and triggers see all that
// flies through them within a tick.
#include <array>
#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/hull.h>
#include <lockstone/testing/floating.h>

#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;

Length length(std::int64_t micrometres) {
  return Length::from_ratio(micrometres, 1'000'000);
}

AssetPtr octahedron() {
  const std::array<Vec3<Length>, 6> points{{{0.1_m, {}, {}},
                                            {-0.1_m, {}, {}},
                                            {{}, 0.07_m, {}},
                                            {{}, -0.07_m, {}},
                                            {{}, {}, 0.05_m},
                                            {{}, {}, -0.05_m}}};
  return Hull::build(points).hull;
}

BodyDef kinematic_body(const Shape& shape) {
  BodyDef def;
  def.motion = MotionType::kinematic;
  def.shape = shape;
  return def;
}

AssetPtr dumb_bell() {
  std::array<CompoundChild, 3> children;
  children[0].shape = children[1].shape = Shape::sphere(0.06_m);
  children[0].position.x = 0.1_m;
  children[1].position.x = -0.1_m;
  children[2].shape = Shape::box(0.1_m, 0.02_m, 0.02_m);
  return Compound::build(children).compound;
}

class Sweepers : public ::testing::Test {
 protected:
  Sweepers() : list_{octahedron(), dumb_bell()} {
    assets_ = std::make_shared<const AssetSet>(list_);
  }

  [[nodiscard]] World make_world() const {
    return test::make_world({.body_capacity = 16, .gravity = {}}, assets_);
  }

  std::int64_t between(std::int64_t low, std::int64_t high) { return random_.between(low, high); }

  Velocity speed(std::int64_t low, std::int64_t high) {
    return Velocity::from_raw(between(low << 32, high << 32));
  }

  Quat any_turn() {
    const auto part = [&] {
      return Unit::from_raw(static_cast<std::int32_t>(between(-(1 << 28), 1 << 28)));
    };
    return normalized({part(), part(), part(), Unit::from_ratio(1, 3)});
  }

  // Spheres, capsules, rods, boxes, a hull, a compound; of 1 to 10 cm.
  Shape any_shape() {
    const Length size = length(between(10'000, 100'000));
    switch (between(0, 5)) {
      case 0:
        return Shape::sphere(size);
      case 1:
        return Shape::capsule(size, size);
      case 2:
        return Shape::capsule(0.2_m, length(between(5'000, 20'000)));
      case 3:
        return Shape::box(size, size / 2, size);
      case 4:
        return list_[0]->shape();
      default:
        return list_[1]->shape();
    }
  }

  test::Random random_;
  std::vector<AssetPtr> list_;
  std::shared_ptr<const AssetSet> assets_;
};

struct Passages {
  int enters = 0, exits = 0, out_of_order = 0;
};

Passages passages(World& world, int ticks) {
  Passages seen;
  for (int tick = 0; tick < ticks; ++tick) {
    (void)world.step();
    for (const ContactEvent& event : world.events()) {
      if (event.kind == EventKind::trigger_exit) seen.out_of_order += ++seen.exits > seen.enters;
      if (event.kind == EventKind::trigger_enter) seen.out_of_order += seen.enters++ > seen.exits;
    }
  }
  return seen;
}

TEST_F(Sweepers, ATriggerSeesAPassingBodyOnceAtAnySpeed) {
  for (int run = 0; run < test::share_of(1500); ++run) {
    World world = make_world();
    BodyDef gate;
    gate.is_trigger = true;
    gate.shape = run % 4 == 0 ? any_shape() : Shape::box(length(between(2'000, 200'000)), 2_m, 2_m);
    gate.motion = run % 3 == 0 ? MotionType::kinematic : MotionType::static_body;
    BodyDef body;
    body.shape = any_shape();
    body.motion = run % 2 == 0 ? MotionType::dynamic : MotionType::kinematic;
    body.is_bullet = run % 5 == 0 && run % 2 == 0;
    body.orientation = any_turn();
    body.angular_velocity.y.raw = speed(-20, 20).raw;
    body.position.x.raw = between(-(std::int64_t{9} << 32), -(std::int64_t{3} << 32));
    body.velocity.x = speed(20, 240);
    if (gate.motion == MotionType::kinematic) gate.velocity.x = -speed(0, 240);
    test::add(world, gate);
    test::add(world, body);
    const Passages seen = passages(world, 60);
    EXPECT_EQ(seen.enters, 1) << "run " << run;
    EXPECT_EQ(seen.exits, 1) << "run " << run;
    EXPECT_EQ(seen.out_of_order, 0) << "run " << run;
  }
}

TEST_F(Sweepers, ATurningTriggerSeesBodiesThatItSweepsOver) {
  for (int run = 0; run < test::share_of(300); ++run) {
    World world = make_world();
    BodyDef blade;
    blade.is_trigger = true;
    blade.shape = Shape::box(2_m, 0.3_m, 0.005_m);
    blade.motion = MotionType::kinematic;
    blade.angular_velocity.y.raw = speed(10, 40).raw;
    BodyDef body;
    body.shape = Shape::sphere(length(between(10'000, 60'000)));
    body.motion = run % 2 == 0 ? MotionType::dynamic : MotionType::static_body;
    body.position.z = Position::from_ratio(-between(500, 1900), 1000);
    test::add(world, blade);
    test::add(world, body);
    const Passages seen = passages(world, 15);
    EXPECT_GE(seen.enters, 1) << "run " << run;
    EXPECT_EQ(seen.out_of_order, 0) << "run " << run;
  }
}

TEST_F(Sweepers, ABounceBehindATriggerIsSeenInTheSameTick) {
  World world = make_world();
  BodyDef gate;
  gate.is_trigger = true;
  gate.motion = MotionType::static_body;
  gate.shape = Shape::box(0.01_m, 1_m, 1_m);
  test::add(world, gate);
  BodyDef wall = gate;
  wall.is_trigger = false;
  wall.position.x = 0.3_m;
  test::add(world, wall);
  BodyDef ball = test::dynamic_body(Shape::sphere(0.05_m), -1_m, {}, {});
  ball.velocity.x = 200_mps;
  ball.material.restitution = 1_r;
  test::add(world, ball);
  const Passages seen = passages(world, 1);
  EXPECT_EQ(seen.enters, 1);
  EXPECT_EQ(seen.exits, 1);
}

// 36 passes in a world of 16 bodies: which of them are told must not depend on the shape of the
// tree of bounds, which depends on the moves before.
TEST_F(Sweepers, TooManyPassesAreCutInTheOrderOfTheirPairs) {
  const auto cut_after_moves = [&](const std::vector<int>& moves) {
    World world = make_world();
    BodyDef gate;
    gate.is_trigger = true;
    gate.motion = MotionType::static_body;
    gate.shape = Shape::box(0.01_m, 8_m, 8_m);
    for (int i = 0; i < 6; ++i) {
      gate.position.x = Position::from_ratio(i, 4);
      test::add(world, gate);
    }
    for (const int i : moves) {
      const BodyHandle body = world.body_at(static_cast<std::uint32_t>(i));
      const Vec3<Position> place = world.position(body);
      EXPECT_EQ(world.apply(Teleport{body, {500_m, {}, {}}, {}}), Status::ok);
      test::step(world, 1);
      EXPECT_EQ(world.apply(Teleport{body, place, {}}), Status::ok);
      test::step(world, 1);
    }
    for (int i = 0; i < 6; ++i) {
      BodyDef ball = test::dynamic_body(Shape::sphere(0.05_m), -1_m, {}, Position::from_integer(i));
      ball.velocity.x = 240_mps;
      test::add(world, ball);
    }
    EXPECT_EQ(world.step().status, Status::capacity_exhausted);
    std::vector<std::pair<std::uint32_t, std::uint32_t>> seen;
    for (const ContactEvent& event : world.events())
      if (event.kind == EventKind::trigger_enter) seen.emplace_back(event.a.index, event.b.index);
    return seen;
  };
  std::vector<std::pair<std::uint32_t, std::uint32_t>> first;
  for (std::uint32_t ball = 6; first.size() < 16; ++ball)
    for (std::uint32_t gate = 0; gate < 6 && first.size() < 16; ++gate)
      first.emplace_back(ball, gate);
  EXPECT_EQ(cut_after_moves({}), first);
  EXPECT_EQ(cut_after_moves({0, 3, 1}), first);
  EXPECT_EQ(cut_after_moves({5, 4, 0, 2}), first);
}

TEST_F(Sweepers, ATriggerDoesNotSeeABodyThatIsStoppedBeforeIt) {
  World world = make_world();
  BodyDef wall;
  wall.motion = MotionType::static_body;
  wall.shape = Shape::box(0.01_m, 1_m, 1_m);
  test::add(world, wall);
  BodyDef gate = wall;
  gate.is_trigger = true;
  gate.position.x = 0.3_m;
  test::add(world, gate);
  BodyDef ball = test::dynamic_body(Shape::sphere(0.05_m), -1_m, {}, {});
  ball.velocity.x = 200_mps;
  test::add(world, ball);
  EXPECT_EQ(passages(world, 10).enters, 0);
}

// A rod that is hit near its end flies aside too, and may leave the wall's face before it is hit
// again.
TEST_F(Sweepers, AFastKinematicWallTakesAlongBodiesThatItHits) {
  for (int run = 0; run < test::share_of(600); ++run) {
    World world = make_world();
    BodyDef wall = kinematic_body(Shape::box(length(between(2'000, 100'000)), 2_m, 2_m));
    wall.position.x.raw = between(-(std::int64_t{8} << 32), -(std::int64_t{3} << 32));
    wall.velocity.x = speed(10, 200);
    const BodyHandle paddle = test::add(world, wall);
    BodyDef def;
    def.motion = MotionType::dynamic;
    def.shape = any_shape();
    def.orientation = any_turn();
    const BodyHandle body = test::add(world, def);
    if (run % 2 == 0) {
      ASSERT_EQ(world.apply(SleepBody{body}), Status::ok);
    }
    for (int tick = 0; tick < 60; ++tick) {
      (void)world.step();
      const Vec3<Position> centre = world.body(body).centre_of_mass;
      if (abs(centre.y) > 2_m || abs(centre.z) > 2_m) break;
      ASSERT_GT(metres(centre.x), metres(world.position(paddle).x))
          << "run " << run << " tick " << tick;
    }
    EXPECT_GE(test::metres_per_second(world.velocity(body).x),
              0.98 * test::metres_per_second(wall.velocity.x))
        << "run " << run;
  }
}

// The whole chain goes along with the ball that is hit, farther than a pile at rest may be from its
// recycling poses.
TEST_F(Sweepers, AChainThatAFastWallTakesAlongCanBeSaved) {
  for (int run = 0; run < test::share_of(100); ++run) {
    World world = make_world();
    BodyDef wall = kinematic_body(Shape::box(0.01_m, 2_m, 2_m));
    wall.position.x.raw = between(-(std::int64_t{2} << 32), -(std::int64_t{1} << 31));
    wall.velocity.x = speed(20, 200);
    (void)test::add(world, wall);
    BodyDef ball = test::dynamic_body(Shape::sphere(0.1_m), {}, {}, {});
    BodyHandle last = test::add(world, ball);
    for (int i = 1; i < 10; ++i) {
      ball.position.x += 0.3_m;
      const BodyHandle next = test::add(world, ball);
      JointDef joint = JointDef::of(JointKind::ball, last, next);
      joint.frame_a.position.x = 0.15_m;
      joint.frame_b.position.x = -0.15_m;
      (void)world.create_joint(joint).value();
      last = next;
    }
    for (int tick = 0; tick < 20; ++tick) {
      (void)world.step();
      ASSERT_FALSE(world.find_fault())
          << world.find_fault().what << ", run " << run << " tick " << tick;
    }
  }
}

// Where the body is as the paddle sees it.
struct Side {
  double along = 0, ahead = 0;
  bool is_first_arm = false, is_beside = false;

  Side(const World& world, BodyHandle paddle, BodyHandle body) {
    const BodyView view = world.body(paddle);
    const Vec3<Position> at =
        apply_inverse({view.centre_of_mass, view.orientation}, world.body(body).centre_of_mass);
    is_first_arm = at.x > Position{};
    along = std::abs(metres(at.x));
    ahead = is_first_arm ? -metres(at.z) : metres(at.z);
    is_beside = std::abs(metres(at.y)) > 0.28;
  }
};

// Whether a body that both sides of a paddle's tick show near the same arm went through it.
bool is_through(const Side& before, const Side& now) {
  const auto is_at_the_arm = [](const Side& side) {
    return !side.is_beside && side.along > 0.2 && side.along < 1.95;
  };
  return before.is_first_arm == now.is_first_arm && is_at_the_arm(before) && is_at_the_arm(now) &&
         before.ahead > 0 && now.ahead < 0;
}

TEST_F(Sweepers, NothingPassesAThinPaddleThatTurns) {
  for (int run = 0; run < test::share_of(600); ++run) {
    World world = make_world();
    BodyDef def = kinematic_body(Shape::box(2_m, 0.3_m, 0.0025_m));
    def.angular_velocity.y.raw = speed(5, 40).raw;
    const BodyHandle paddle = test::add(world, def);
    BodyDef body_def;
    body_def.motion = MotionType::dynamic;
    body_def.shape = any_shape();
    body_def.orientation = any_turn();
    const double angle = 0.001 * static_cast<double>(between(300, 2800));
    const double r = 0.001 * static_cast<double>(between(600, 1700));
    const auto position = [](double x) {
      return Position::from_raw(static_cast<std::int64_t>(x * 4294967296.0));
    };
    body_def.position = {position(r * std::cos(angle)), {}, position(-r * std::sin(angle))};
    const BodyHandle body = test::add(world, body_def);
    if (run % 2 == 0) {
      ASSERT_EQ(world.apply(SleepBody{body}), Status::ok);
    }
    Side before(world, paddle, body);
    for (int tick = 0; tick < 60; ++tick) {
      (void)world.step();
      const Side now(world, paddle, body);
      ASSERT_FALSE(is_through(before, now))
          << "run " << run << " tick " << tick << " along " << now.along;
      before = now;
    }
    const Vec3<Position> end = world.body(body).centre_of_mass;
    const Position way = abs(end.x - body_def.position.x) + abs(end.z - body_def.position.z);
    EXPECT_GT(metres(way), 0.1) << "run " << run;
  }
}

}  // namespace
}  // namespace lockstone
