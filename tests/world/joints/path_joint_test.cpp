// Path joints: a point of a body stays on a curve.

#include <algorithm>
#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include <lockstone/testing/floating.h>

#include "tests/world/joints/joint_fixture.h"
#include "tests/world/joints/path_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::path_point;
using testing::to_double;

constexpr Vec3<Acceleration> k_down{{}, -9.81_mps2, {}};

// A body on a path of the world, which begins at a distance with a speed along it.
struct Bead {
  AssetPtr asset;
  World world;
  JointDef def;
  JointHandle joint;

  explicit Bead(AssetPtr path, Vec3<Acceleration> gravity = {})
      : asset(std::move(path)),
        world(test::make_world({.body_capacity = 8, .joint_capacity = 4, .gravity = gravity},
                               std::make_shared<const AssetSet>(std::vector<AssetPtr>{asset}))) {
    def = JointDef::of(JointKind::path, test::add_fixed(world), {});
    def.path = asset->id();
  }
  [[nodiscard]] const Path& path() const { return static_cast<const Path&>(*asset); }

  void begin(Length distance, Velocity speed, const Shape& shape = Shape::sphere(0.25_m)) {
    const Transform at = path().at(distance);
    BodyDef body = test::dynamic_body(shape, at.position.x, at.position.y, at.position.z);
    body.orientation = at.orientation;
    body.allow_sleep = false;
    const Mat3 frame = to_matrix(at.orientation);
    for (int i = 0; i < 3; ++i)
      body.velocity[i] =
          Velocity::from_raw(raw::round_shift((speed.raw >> 16) * frame.x[i].raw, 14));
    def.body_b = test::add(world, body);
    joint = test::join(world, def);
  }
  [[nodiscard]] double distance() const { return to_double(world.joint(joint).offset.x); }
  [[nodiscard]] double aside() const {
    const JointView view = world.joint(joint);
    return std::hypot(to_double(view.offset.y), to_double(view.offset.z));
  }
  [[nodiscard]] double speed() const {
    const auto& v = world.body(def.body_b).velocity;
    return std::hypot(to_double(v.x), to_double(v.y), to_double(v.z));
  }
  // For each kilogram, of a ball that does not turn.
  [[nodiscard]] double energy() const {
    return speed() * speed() / 2 + 9.81 * to_double(world.body(def.body_b).position.y);
  }
  // From the curve, by looking everywhere on it: an upper bound.
  [[nodiscard]] double distance_from_curve() const {
    const auto& p = world.body(def.body_b).position;
    const double length = to_double(path().length()), here = distance();
    double least = 1e9;
    for (int i = -2000; i <= 2000; ++i) {
      const double s = std::fmod(here + i * 1e-4 + length, length);
      const Transform at = path().at(Length::from_raw(static_cast<std::int32_t>(s * 1048576)));
      least =
          std::min(least, std::hypot(to_double(at.position.x - p.x), to_double(at.position.y - p.y),
                                     to_double(at.position.z - p.z)));
    }
    return least;
  }
};

// A roller coaster: a hill, a valley, a banked turn back at the other height.
AssetPtr coaster() {
  std::vector<PathPoint> points;
  for (int i = 0; i < 40; ++i) {
    const double a = 2 * 3.14159265358979 * i / 40;
    points.push_back(path_point(30 * std::cos(a), 12 + 8 * std::sin(2 * a) + 2 * std::cos(5 * a),
                                -20 * std::sin(a)));
  }
  return test::built_path(points, true);
}

// A loop that stands in the plane z = 0, with the up direction inward.
AssetPtr standing_loop(double radius) {
  std::vector<PathPoint> points;
  for (int i = 0; i < 24; ++i) {
    const double a = 2 * 3.14159265358979 * i / 24;
    PathPoint point = path_point(radius * std::sin(a), -radius * std::cos(a), 0);
    point.up = {Unit::from_raw(static_cast<std::int32_t>(-std::sin(a) * (1 << 30))),
                Unit::from_raw(static_cast<std::int32_t>(std::cos(a) * (1 << 30))),
                {}};
    points.push_back(point);
  }
  return test::built_path(points, true);
}

TEST(PathJoints, KeepTheSpeedOnALevelPath) {
  Bead bead(test::circle(32, 10));
  bead.begin(3_m, 30_mps);
  double worst = 0;
  for (int tick = 0; tick < 1800; ++tick) {
    (void)bead.world.step();
    worst = std::max(worst, bead.aside());
  }
  EXPECT_LT(worst, 1e-5);
  EXPECT_NEAR(bead.speed(), 30, 1e-4);
}

TEST(PathJoints, StayOnTheCurveAtGameSpeeds) {
  for (const int speed : {5, 20, 60, 120}) {
    Bead bead(coaster(), k_down);
    bead.begin(0_m, Velocity::from_integer(speed));
    double worst = 0;
    for (int tick = 0; tick < 600; ++tick) {
      (void)bead.world.step();
      worst = std::max(worst, bead.aside());
      if (tick % 97 != 0) continue;
      EXPECT_LT(bead.distance_from_curve(), 1e-4) << speed << " m/s, tick " << tick;
    }
    EXPECT_LT(worst, 1e-5) << speed << " m/s";
  }
}

TEST(PathJoints, KeepTheirEnergyAndGainNone) {
  for (const int speed : {0, 8, 20}) {
    Bead bead(coaster(), k_down);
    bead.begin(10_m, Velocity::from_integer(speed));
    const double first = bead.energy();
    double most = first, least = first;
    for (int tick = 0; tick < 3600; ++tick) {
      (void)bead.world.step();
      most = std::max(most, bead.energy());
      least = std::min(least, bead.energy());
    }
    EXPECT_LT(most - first, 0.01) << speed << " m/s";  // of 9.81 · 20 m between hill and valley
    EXPECT_GT(least - first, -0.05) << speed << " m/s";
  }
}

TEST(PathJoints, GoThroughALoopAsEnergySays) {
  Bead bead(standing_loop(5), k_down);
  bead.begin(0_m, 17_mps);
  double highest = -1e9, slowest = 1e9;
  for (int tick = 0; tick < 600; ++tick) {
    (void)bead.world.step();
    highest = std::max(highest, to_double(bead.world.body(bead.def.body_b).position.y));
    slowest = std::min(slowest, bead.speed());
  }
  EXPECT_NEAR(highest, 5, 1e-3);
  EXPECT_NEAR(slowest, std::sqrt(17 * 17 - 4 * 9.81 * 5), 1e-3);
}

// Small swings at the bottom of the loop: a pendulum.
TEST(PathJoints, SwingAtTheBottomLikeAPendulum) {
  Bead bead(standing_loop(5), k_down);
  bead.begin(0.05_m, {});
  int crossings = 0, last = 0;
  double before = 1;
  for (int tick = 0; tick < 3600; ++tick) {
    (void)bead.world.step();
    const double x = to_double(bead.world.body(bead.def.body_b).position.x);
    if (before < 0 && x >= 0) ++crossings, last = tick;
    before = x;
  }
  const double period = 2 * 3.14159265358979 * std::sqrt(5 / 9.81);
  EXPECT_NEAR(last / 60.0 / (crossings - 0.25), period, 0.01 * period);
}

// A level eight: at the crossing the other branch is as near.
TEST(PathJoints, GoStraightOverACrossing) {
  std::vector<PathPoint> points;
  for (int i = 0; i < 32; ++i) {
    const double a = 2 * 3.14159265358979 * (i + 0.5) / 32;
    points.push_back(path_point(20 * std::sin(a), 0, 20 * std::sin(a) * std::cos(a)));
  }
  Bead bead(test::built_path(points, true));
  bead.begin(1_m, 25_mps);
  const double length = to_double(bead.path().length());
  double before = 1;
  for (int tick = 0; tick < 1200; ++tick) {
    (void)bead.world.step();
    const double way = std::fmod(bead.distance() - before + length, length);
    ASSERT_NEAR(way, 25.0 / 60, 0.01) << "tick " << tick;
    before = bead.distance();
  }
}

TEST(PathJoints, GoOnWhereABodyIsTeleported) {
  Bead bead(test::circle(32, 10));
  bead.begin(1_m, {});
  test::step(bead.world, 10);
  const Transform there = bead.path().at(35_m);
  ASSERT_EQ(bead.world.apply(Teleport{bead.def.body_b, there.position, there.orientation}),
            Status::ok);
  test::step(bead.world, 10);
  EXPECT_NEAR(bead.distance(), 35, 1e-3);
  EXPECT_NEAR(bead.speed(), 0, 1e-3);
}

TEST(PathJoints, StopAtTheEndsUnlessTheyAreFree) {
  const AssetPtr path =
      test::built_path({path_point(0, 0, 0), path_point(4, 1, 0), path_point(8, 0, 3)}, false);
  for (const bool is_free : {false, true}) {
    Bead bead(path);
    if (is_free) bead.def.linear[0].mode = AxisMode::free;
    bead.begin(1_m, 6_mps);
    test::step(bead.world, 180);
    const double length = to_double(bead.path().length());
    if (is_free) {
      EXPECT_NEAR(bead.distance(), 1 + 18, 0.01);
      EXPECT_LT(bead.aside(), 1e-4);
    } else {
      EXPECT_NEAR(bead.distance(), length, 1e-3);
      EXPECT_NEAR(bead.speed(), 0, 1e-3);
    }
  }
}

TEST(PathJoints, HaveMotorsAndSprings) {
  Bead lift(coaster(), k_down);
  lift.def.linear[0].speed = 3_mps;
  lift.def.linear[0].max_effort = 5000_N;
  lift.begin(5_m, {});
  test::step(lift.world, 120);
  for (int tick = 0; tick < 600; ++tick) {
    (void)lift.world.step();
    ASSERT_NEAR(lift.speed(), 3, 0.01) << "tick " << tick;
  }
  Bead sprung(test::circle(32, 10));
  sprung.def.linear[0].hertz = 1_r;
  sprung.def.linear[0].target = 60_m;  // the shorter way is back over the beginning
  sprung.begin(4_m, {});
  (void)sprung.world.step();
  (void)sprung.world.step();
  EXPECT_LT(sprung.distance(), 4);
  test::step(sprung.world, 600);
  EXPECT_NEAR(sprung.distance(), 60, 1e-3);
}

// All turning locked: the body has the path's frame, banks included.
TEST(PathJoints, CarryABodyAlongTheDirectionOfThePath) {
  std::vector<PathPoint> points;
  for (int i = 0; i < 24; ++i) {
    const double a = 2 * 3.14159265358979 * i / 24;
    PathPoint point = path_point(15 * std::cos(a), 2 * std::sin(2 * a), -15 * std::sin(a));
    point.up = {Unit::from_raw(static_cast<std::int32_t>(-0.5 * std::cos(a) * (1 << 30))),
                Unit::from_raw(1 << 30),
                Unit::from_raw(static_cast<std::int32_t>(0.5 * std::sin(a) * (1 << 30)))};
    points.push_back(point);
  }
  Bead cart(test::built_path(points, true));
  for (AngularAxis& axis : cart.def.angular)
    axis.mode = AxisMode::locked;
  cart.begin(2_m, 15_mps, Shape::box(0.8_m, 0.4_m, 0.3_m));
  test::step(cart.world, 2);  // the path turns it, which takes some of its speed
  const double first = cart.speed();
  EXPECT_LT(first, 15);
  for (int tick = 0; tick < 1200; ++tick) {
    (void)cart.world.step();
    const JointView view = cart.world.joint(cart.joint);
    ASSERT_LT(cart.aside(), 1e-4) << "tick " << tick;
    for (int i = 0; i < 3; ++i)
      ASSERT_NEAR(to_double(view.angle[i]), 0, 1e-3) << "tick " << tick;
  }
  EXPECT_NEAR(cart.speed(), first, 1e-3 * first);
  const auto& spin = cart.world.body(cart.def.body_b).angular_velocity;
  EXPECT_NEAR(to_double(spin.y), cart.speed() / 15, 0.1);  // about upright, as the circle below it
  const Mat3 body = to_matrix(cart.world.body(cart.def.body_b).orientation);
  const Mat3 path = to_matrix(
      cart.path().at(Length::from_raw(cart.world.joint(cart.joint).offset.x.raw)).orientation);
  EXPECT_GT(to_double(body.x.x) * to_double(path.x.x) + to_double(body.x.y) * to_double(path.x.y) +
                to_double(body.x.z) * to_double(path.x.z),
            1 - 1e-6);
}

// A level straight track whose bank grows by 0.2 rad a metre, and a cart whose centre is 0.8 m
// above it: the centre goes along a helix, and the cart's energy is that of
//   ½·(m·(1 + h²k²) + I·k²)·v² + m·g·h·cos(k·s)
TEST(PathJoints, RollWithTheBanksOfATrack) {
  constexpr double k_bank = 0.2, k_height = 0.8;
  std::vector<PathPoint> points;
  std::vector<Angle> banks;
  for (int i = 0; i <= 75; ++i) {
    points.push_back(path_point(i, 0, 0));
    banks.push_back(Angle::from_ratio(i, 5));
  }
  Bead cart(Path::build(points, banks, false).path, k_down);
  for (AngularAxis& axis : cart.def.angular)
    axis.mode = AxisMode::locked;
  cart.def.frame_b.position.z = -0.8_m;
  BodyDef body = test::dynamic_body(Shape::box(0.8_m, 0.4_m, 0.3_m), 4_m, {}, {});
  const Transform at = cart.path().at(4_m);
  body.orientation = at.orientation;
  body.position = at.position +
                  rounded<Position>(rotate(to_matrix(at.orientation), Vec3<Length>{{}, {}, 0.8_m}));
  body.velocity = {6_mps, {}, {}};
  body.allow_sleep = false;
  cart.def.body_b = test::add(cart.world, body);
  cart.joint = test::join(cart.world, cart.def);
  const double mass = to_double(cart.world.body(cart.def.body_b).mass.mass);
  const double inertia = mass / 3 * (0.4 * 0.4 + 0.3 * 0.3);
  const auto energy = [&](double v, double s) {
    return (mass * (1 + k_height * k_height * k_bank * k_bank) + inertia * k_bank * k_bank) * v *
               v / 2 +
           mass * 9.81 * k_height * std::cos(k_bank * s);
  };
  test::step(cart.world, 2);  // the impulse of the joint gives it its turning
  const auto along = [&] { return to_double(cart.world.body(cart.def.body_b).velocity.x); };
  const double first = energy(along(), cart.distance());
  double slowest = 1e9, fastest = 0;
  for (int tick = 0; tick < 900 && cart.distance() < 70; ++tick) {
    (void)cart.world.step();
    const double s = cart.distance(), v = along();
    slowest = std::min(slowest, v);
    fastest = std::max(fastest, v);
    ASSERT_LT(cart.aside(), 1e-4) << "at " << s;
    ASSERT_NEAR(energy(v, s) / first, 1, 2e-5) << "at " << s;
    const Mat3 frame = to_matrix(cart.world.body(cart.def.body_b).orientation);
    ASSERT_NEAR(to_double(frame.z.y), std::cos(k_bank * s), 1e-3) << "at " << s;
    ASSERT_NEAR(to_double(frame.z.z), std::sin(k_bank * s), 1e-3) << "at " << s;
  }
  EXPECT_GT(fastest - slowest, 2);
}

// A path on a free body: both together keep their momentum.
TEST(PathJoints, PushABodyThatCarriesThePath) {
  Bead bead(test::circle(24, 3));
  BodyDef ring = test::dynamic_body(Shape::box(1_m, 0.2_m, 1_m), {}, {}, {});
  ring.allow_sleep = false;
  ASSERT_EQ(bead.world.apply(DestroyBody{bead.def.body_a}), Status::ok);
  bead.def.body_a = test::add(bead.world, ring);
  bead.begin(0_m, 6_mps);
  const double mass_a = to_double(bead.world.body(bead.def.body_a).mass.mass);
  const double mass_b = to_double(bead.world.body(bead.def.body_b).mass.mass);
  const auto momentum = [&](int axis) {
    return mass_a * to_double(bead.world.body(bead.def.body_a).velocity[axis]) +
           mass_b * to_double(bead.world.body(bead.def.body_b).velocity[axis]);
  };
  const double x = momentum(0), z = momentum(2);
  for (int tick = 0; tick < 600; ++tick) {
    (void)bead.world.step();
    ASSERT_LT(bead.aside(), 1e-3) << "tick " << tick;
  }
  EXPECT_NEAR(momentum(0), x, 1e-3 * mass_b * 6);
  EXPECT_NEAR(momentum(2), z, 1e-3 * mass_b * 6);
}

TEST(PathJoints, AreRefusedWithoutAPathOrAcrossIt) {
  Bead bead(test::circle(24, 3));
  bead.begin(0_m, {});
  const auto field = [&](const auto& change) {
    JointDef def = bead.def;
    change(def);
    EXPECT_EQ(bead.world.create_joint(def).status(), Status::invalid_argument);
    return bead.world.explain(def).field;
  };
  EXPECT_EQ(field([](JointDef& def) { def.path.value = 0; }), "joint.path");
  EXPECT_EQ(field([](JointDef& def) { def.path.value ^= 1; }), "joint.path");
  EXPECT_EQ(field([](JointDef& def) { def.linear[0].mode = AxisMode::locked; }),
            "joint.linear[0].mode");
  EXPECT_EQ(field([](JointDef& def) { def.linear[1].mode = AxisMode::free; }),
            "joint.linear[1].mode");
  EXPECT_EQ(field([](JointDef& def) { def.linear[2].hertz = 1_r; }), "joint.linear[2].mode");
}

TEST(PathJoints, NeedTheirPathToBeLoaded) {
  Bead bead(test::circle(24, 3)), other(test::circle(25, 3));
  bead.begin(0_m, 2_mps);
  test::step(bead.world, 10);
  const std::vector<std::byte> bytes = test::save(bead.world, SnapshotKind::canonical);
  EXPECT_NE(other.world.load(SnapshotKind::canonical, bytes), Status::ok);
  Bead twin(test::circle(24, 3));
  ASSERT_EQ(twin.world.load(SnapshotKind::canonical, bytes), Status::ok);
  test::step(twin.world, 100);
  test::step(bead.world, 100);
  EXPECT_EQ(twin.world.hash().total, bead.world.hash().total);
}

}  // namespace
}  // namespace lockstone
