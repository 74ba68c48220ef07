// The character mover: walls, corners, ledges, slopes, pushes.
#include <algorithm>
#include <optional>

#include <gtest/gtest.h>

#include <lockstone/character.h>
#include <lockstone/rotation.h>

#include "tests/support/random.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;

constexpr double k_stand = 0.9 + 0.01;  // half the capsule and the skin

struct Walk {
  World world = test::make_world();
  CharacterDef def;
  Vec3<Position> position{{}, 0.91_m, {}};
  CharacterMove last;

  Walk() { test::add_ground(world); }

  BodyHandle add_box(const Vec3<Position>& at, const Vec3<Length>& half, const Quat& turn = {}) {
    BodyDef box;
    box.motion = MotionType::static_body;
    box.shape = Shape::box(half.x, half.y, half.z);
    box.position = at;
    box.orientation = turn;
    return test::add(world, box);
  }

  void go(const Vec3<Length>& motion, int ticks) {
    for (int i = 0; i < ticks; ++i) {
      last = move_character(world, def, position, motion);
      position = last.position;
    }
  }
};

TEST(Character, WalksOnFlatGroundWithoutDrift) {
  Walk walk;
  walk.go({0.05_m, -0.02_m, {}}, 100);
  EXPECT_TRUE(walk.last.grounded);
  EXPECT_NEAR(metres(walk.position.x), 5, 0.01);
  EXPECT_NEAR(metres(walk.position.y), k_stand, 1e-3);
  EXPECT_NEAR(metres(walk.position.z), 0, 1e-4);
}

TEST(Character, StopsAtAWallAndSlidesAlongIt) {
  Walk walk;
  walk.add_box({3_m, 2_m, {}}, {0.5_m, 2_m, 20_m});
  walk.go({0.05_m, {}, 0.05_m}, 100);
  EXPECT_NEAR(metres(walk.position.x), 3 - 0.5 - 0.3 - 0.01, 2e-3);
  EXPECT_NEAR(metres(walk.position.z), 5, 0.02);
  double blocked = 0;
  for (std::size_t i = 0; i < walk.last.hit_count; ++i)
    blocked = std::max(blocked, metres(rounded<Position>(walk.last.hits[i].blocked)));
  EXPECT_NEAR(blocked, 0.05, 0.012);
}

TEST(Character, StopsInACorner) {
  Walk walk;
  walk.add_box({3_m, 2_m, {}}, {0.5_m, 2_m, 20_m});
  walk.add_box({{}, 2_m, 3_m}, {20_m, 2_m, 0.5_m});
  walk.go({0.05_m, {}, 0.04_m}, 150);
  EXPECT_NEAR(metres(walk.position.x), 2.19, 0.012);  // a skin or less than two
  EXPECT_NEAR(metres(walk.position.z), 2.19, 0.012);
  EXPECT_NEAR(metres(walk.position.y), k_stand, 2e-3);
}

TEST(Character, StepsOntoALedgeButNotOntoATable) {
  Walk walk;
  walk.add_box({3_m, {}, {}}, {1_m, 0.3_m, 5_m});  // 0.3 m high
  walk.add_box({6_m, {}, {}}, {1_m, 0.7_m, 5_m});  // 0.7 m
  walk.go({0.05_m, {}, {}}, 60);
  EXPECT_NEAR(metres(walk.position.y), k_stand + 0.3, 0.011);  // within the skin
  EXPECT_GT(metres(walk.position.x), 2.5);
  walk.go({0.05_m, -0.05_m, {}}, 100);
  EXPECT_NEAR(metres(walk.position.y), k_stand, 0.011);  // down again, before the table
  EXPECT_NEAR(metres(walk.position.x), 4.69, 5e-3);
}

TEST(Character, ClimbsAGentleSlopeAndNotASteepOne) {
  for (const int degrees : {30, 60}) {
    Walk walk;
    const Angle tilt = Angle::from_ratio(degrees * 314159, 180 * 100000);
    walk.add_box({6_m, {}, {}}, {4_m, 0.1_m, 5_m},
                 from_axis_angle({{}, {}, Unit::from_integer(1)}, tilt));
    walk.go({0.05_m, {}, {}}, 140);
    if (degrees == 30) {
      EXPECT_GT(metres(walk.position.y), 1.4);
      EXPECT_TRUE(walk.last.grounded);
    } else {
      EXPECT_LT(metres(walk.position.y), k_stand + 0.36);
    }
  }
}

TEST(Character, IsPushedOutOfOverlaps) {
  Walk walk;
  walk.add_box({{}, 1_m, {}}, {0.5_m, 0.5_m, 0.5_m});
  walk.position = {0.6_m, 1.2_m, {}};
  walk.go({}, 3);
  BodyHandle found[4];
  EXPECT_EQ(walk.world.overlap_shape(Shape::capsule(0.6_m, 0.298_m), {walk.position, {}}, found),
            0U);
}

TEST(Character, PushesBodiesInItsWay) {
  Walk walk;
  BodyDef crate = test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), 2_m, 0.5_m, {});
  crate.material.density = Density::from_integer(20);
  crate.material.friction = {};
  const BodyHandle body = test::add(walk.world, crate);
  for (int tick = 0; tick < 120; ++tick) {
    walk.go({0.05_m, {}, {}}, 1);
    apply_pushes(walk.world, walk.def, walk.last);
    (void)walk.world.step();
  }
  EXPECT_GT(metres(walk.world.position(body).x), 4);
  EXPECT_GT(metres(walk.position.x), 3);
}

// A room of up to 60 turned boxes; none is where the character begins.
void fill_room(test::Random& random, Walk& walk) {
  const auto place = [&] {
    return Position::from_raw(random.between(-(std::int64_t{6} << 32), std::int64_t{6} << 32));
  };
  const auto size = [&] {
    return Length::from_raw(static_cast<std::int32_t>(random.between(1 << 17, 1 << 20)));
  };
  for (int i = 0; i < 60; ++i) {
    const Position x = place(), z = place();
    // A turned box reaches 1.42 m, the character 0.3 m.
    if (metres(abs(x)) < 1.8 && metres(abs(z)) < 1.8) continue;
    const Length sx = size(), sy = size(), sz = size();
    const Angle turn = Angle::from_raw(static_cast<std::int32_t>(random.between(0, 1 << 29)));
    walk.add_box({x, {}, z}, {sx, sy, sz}, from_axis_angle({{}, Unit::from_integer(1), {}}, turn));
  }
}

Vec3<Length> random_motion(test::Random& random) {
  Vec3<Length> motion;
  motion.x.raw = static_cast<std::int32_t>(random.between(-(1 << 17), 1 << 17));
  motion.z.raw = static_cast<std::int32_t>(random.between(-(1 << 17), 1 << 17));
  motion.y.raw = -(1 << 14);
  return motion;
}

void expect_no_walk_into_anything(std::uint64_t seed, int runs) {
  test::Random random(seed);
  for (int run = 0; run < runs; ++run) {
    Walk walk;
    fill_room(random, walk);
    Vec3<Length> motion;
    for (int tick = 0; tick < 200; ++tick) {
      if (tick % 20 == 0) motion = random_motion(random);
      walk.go(motion, 1);
      BodyHandle found[4];
      const Shape inner = Shape::capsule(0.6_m, 0.299_m);
      ASSERT_EQ(walk.world.overlap_shape(inner, {walk.position, {}}, found), 0U)
          << "run " << run << " tick " << tick;
    }
  }
}

TEST(Character, NeverEndsInsideAnything) {
  expect_no_walk_into_anything(test::run_seed(), 20);
}

// With this seed it walks into a wedge that narrows below its skin.
TEST(Character, StaysApartFromBothSidesOfAWedge) {
  expect_no_walk_into_anything(1795756064234739803U, 4);
}

constexpr Vec3<Unit> k_x_axis{Unit::from_integer(1), {}, {}};
constexpr Vec3<Unit> k_y_axis{{}, Unit::from_integer(1), {}};
constexpr Vec3<Unit> k_z_axis{{}, {}, Unit::from_integer(1)};

TEST(Character, OfEachShapeWalksAndStepsUp) {
  const Shape shapes[] = {Shape::sphere(0.5_m),
                          Shape::box(0.3_m, 0.9_m, 0.3_m),
                          Shape::cylinder(0.9_m, 0.3_m),
                          Shape::cone(1.8_m, 0.3_m),
                          Shape::tapered_capsule(1_m, 0.4_m, 0.25_m),
                          Shape::rounded_box(0.2_m, 0.83_m, 0.2_m, 0.07_m)};
  const double feet[] = {0.5, 0.9, 0.9, 0.45, 0.717, 0.9};
  for (std::size_t i = 0; i < std::size(shapes); ++i) {
    Walk walk;
    walk.def.shape = shapes[i];
    walk.position.y = Position::from_ratio(static_cast<std::int64_t>(feet[i] * 100) + 1, 100);
    walk.add_box({3_m, {}, {}}, {1_m, 0.3_m, 5_m});
    walk.go({0.05_m, -0.02_m, {}}, 20);
    EXPECT_NEAR(metres(walk.position.y), feet[i] + 0.01, 2e-3) << "shape " << i;
    walk.go({0.05_m, {}, {}}, 40);
    EXPECT_NEAR(metres(walk.position.y), feet[i] + 0.31, 0.011) << "shape " << i;
  }
}

// Up is −x: the wall is its floor.
TEST(Character, WalksOnAWallWhereThatIsItsGround) {
  World world = test::make_world();
  BodyDef wall;
  wall.motion = MotionType::static_body;
  wall.shape = Shape::half_space();
  wall.orientation = from_axis_angle(k_z_axis, Angle::from_ratio(157079633, 100000000));
  test::add(world, wall);
  CharacterDef def;
  def.orientation = wall.orientation;
  Vec3<Position> position{-0.91_m, {}, {}};
  CharacterMove move;
  for (int tick = 0; tick < 100; ++tick) {
    move = move_character(world, def, position, {0.02_m, 0.05_m, {}});
    position = move.position;
  }
  EXPECT_TRUE(move.grounded);
  EXPECT_NEAR(metres(position.x), -k_stand, 1e-3);
  EXPECT_NEAR(metres(position.y), 5, 0.01);
}

TEST(Character, DoesNotJitterInACorner) {
  Walk walk;
  const Quat turn = from_axis_angle(k_y_axis, 0.6_rad);
  walk.add_box({3_m, 2_m, {}}, {0.5_m, 2_m, 20_m});
  walk.add_box({{}, 2_m, 3_m}, {20_m, 2_m, 0.5_m}, turn);
  walk.go({0.05_m, -0.02_m, 0.05_m}, 150);
  const Vec3<Position> before = walk.position;
  for (int tick = 0; tick < 60; ++tick) {
    walk.go({0.05_m, -0.02_m, 0.05_m}, 1);
    for (int axis = 0; axis < 3; ++axis)
      ASSERT_NEAR(metres(walk.position[axis]), metres(before[axis]), 1e-4) << "tick " << tick;
  }
}

TEST(Character, FeelsNoSeamsBetweenTiles) {
  Walk walk;
  for (int i = -2; i < 40; ++i)
    walk.add_box({Position::from_ratio(i * 4, 10), -0.1_m, {}}, {0.2_m, 0.3_m, 2_m});
  walk.position = {{}, 1.11_m, {}};
  for (int tick = 1; tick <= 200; ++tick) {
    walk.go({0.05_m, -0.02_m, 0.01_m}, 1);
    ASSERT_TRUE(walk.last.grounded) << "tick " << tick;
    ASSERT_NEAR(metres(walk.position.y), k_stand + 0.2, 1e-3) << "tick " << tick;
    ASSERT_NEAR(metres(walk.position.x), 0.05 * tick, 1e-3) << "tick " << tick;
  }
}

// Lets a world with a platform go on, and the character with it.
struct Ride : Walk {
  BodyHandle platform;
  Quat heading{};

  explicit Ride(const Vec3<Velocity>& velocity, const Vec3<AngularVelocity>& spin = {}) {
    BodyDef floor;
    floor.motion = MotionType::kinematic;
    floor.shape = Shape::box(4_m, 0.2_m, 4_m);
    floor.position.y = 5_m;
    floor.velocity = velocity;
    floor.angular_velocity = spin;
    platform = test::add(world, floor);
    position = {2_m, 6.11_m, {}};
  }

  void ride(int ticks) {
    for (int tick = 0; tick < ticks; ++tick) {
      const CharacterCarry carry = carried_by(world, def, last);
      heading = normalized(multiply(carry.turn, heading));
      last = move_character(world, def, position, {{}, -0.005_m, {}}, true, carry.motion);
      position = last.position;
      (void)world.step();
    }
  }

  [[nodiscard]] Vec3<Position> on_platform() const {
    const BodyView view = world.body(platform);
    return apply_inverse({view.position, view.orientation}, position);
  }
};

TEST(Character, IsCarriedByAPlatformThatMoves) {
  Ride ride({3_mps, 0.5_mps, -1_mps});
  ride.ride(2);
  const Vec3<Position> before = ride.on_platform();
  ride.ride(300);
  EXPECT_TRUE(ride.last.grounded);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(metres(ride.on_platform()[axis]), metres(before[axis]), 1e-3) << axis;
}

TEST(Character, IsCarriedDownByALift) {
  Ride ride({{}, -2_mps, {}});
  ride.ride(100);
  EXPECT_TRUE(ride.last.grounded);
  EXPECT_NEAR(metres(ride.on_platform().y), 0.2 + k_stand, 0.04);  // a tick behind
}

TEST(Character, IsCarriedAndTurnedByATurntable) {
  Ride ride({}, {{}, 1_rps, {}});
  ride.ride(2);
  const Vec3<Position> before = ride.on_platform();
  ride.ride(600);  // 10 rad
  const Vec3<Position> after = ride.on_platform();
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(metres(after[axis]), metres(before[axis]), 2e-3) << axis;
  const Quat expected = from_axis_angle(k_y_axis, 10_rad);
  EXPECT_NEAR(static_cast<double>(angle_between(ride.heading, expected).raw), 0,
              0.02 * (1 << Angle::frac_bits));
}

TEST(Character, PushesWithNoMoreThanItsForce) {
  for (const int newtons : {100, 4000}) {
    Walk walk;
    walk.world = test::make_world({.gravity = {}});
    walk.def.push_force = Force::from_integer(newtons);
    BodyDef crate = test::dynamic_body(Shape::box(0.5_m, 0.9_m, 0.5_m), 0.82_m, 0.9_m, {});
    crate.material.density = Density::from_integer(1000);  // 1,800 kg
    const BodyHandle body = test::add(walk.world, crate);
    for (int tick = 0; tick < 60; ++tick) {
      walk.go({0.05_m, {}, {}}, 1);
      apply_pushes(walk.world, walk.def, walk.last);
      (void)walk.world.step();
    }
    const double speed = test::metres_per_second(walk.world.velocity(body).x);
    EXPECT_LE(speed, newtons / 1800.0 * 1.001) << newtons;
    EXPECT_GE(speed, newtons / 1800.0 * 0.5) << newtons;
  }
}

TEST(Character, IsPushedAsideByABodyAndSlowsIt) {
  Walk walk;
  BodyDef crate = test::dynamic_body(Shape::box(0.5_m, 0.9_m, 0.5_m), -3_m, 0.9_m, {});
  crate.material.friction = {};
  crate.material.density = Density::from_integer(45);  // 81 kg
  crate.velocity.x = 4_mps;
  const BodyHandle body = test::add(walk.world, crate);
  for (int tick = 0; tick < 120; ++tick) {
    walk.go({{}, -0.005_m, {}}, 1);
    apply_pushes(walk.world, walk.def, walk.last);
    (void)walk.world.step();
  }
  EXPECT_LT(test::metres_per_second(walk.world.velocity(body).x), 2.5);
  EXPECT_GT(metres(walk.position.x), 0.1);
}

// Both fall together: the plank does not run away from under the foot.
TEST(Character, WeighsOnTheBodyThatItStandsOn) {
  Walk walk;
  walk.add_box({{}, 0.5_m, {}}, {0.1_m, 0.5_m, 1_m});
  BodyDef plank = test::dynamic_body(Shape::box(2_m, 0.05_m, 0.5_m), {}, 1.05_m, {});
  plank.material.density = Density::from_integer(100);
  const BodyHandle body = test::add(walk.world, plank);
  walk.position = {1_m, 2.02_m, {}};
  int grounded = 0;
  for (int tick = 0; tick < 30; ++tick) {
    const CharacterCarry carry = carried_by(walk.world, walk.def, walk.last);
    walk.last =
        move_character(walk.world, walk.def, walk.position, {{}, -0.002_m, {}}, true, carry.motion);
    walk.position = walk.last.position;
    grounded += walk.last.grounded ? 1 : 0;
    apply_pushes(walk.world, walk.def, walk.last);
    (void)walk.world.step();
  }
  EXPECT_GE(grounded, 25);
  EXPECT_LT(metres(walk.position.y), 1.85);
  EXPECT_GT(metres(walk.position.y), 1.4);
  const Vec3<Length> end =
      rotate(to_matrix(walk.world.body(body).orientation), Vec3<Length>{2_m, {}, {}});
  EXPECT_LT(metres(rounded<Position>(end.y)), -0.3);
}

TEST(Character, CrouchesAndStandsUpOnlyWhereThereIsRoom) {
  Walk walk;
  CharacterDef crouched = walk.def;
  crouched.shape = Shape::capsule(0.2_m, 0.3_m);
  walk.add_box({3_m, 2.2_m, {}}, {1_m, 1_m, 5_m});  // its underside at 1.2 m
  walk.go({0.05_m, -0.01_m, {}}, 60);
  EXPECT_LT(metres(walk.position.x), 1.8);

  const std::optional<Vec3<Position>> low = reshaped(walk.world, walk.def, walk.position, crouched);
  ASSERT_TRUE(low);
  EXPECT_NEAR(metres(low->y), metres(walk.position.y) - 0.4, 1e-4);
  const CharacterDef standing = walk.def;
  walk.position = *low, walk.def = crouched;
  walk.go({0.05_m, -0.01_m, {}}, 30);
  EXPECT_GT(metres(walk.position.x), 2.5);
  EXPECT_FALSE(reshaped(walk.world, crouched, walk.position, standing));
  EXPECT_TRUE(has_room(walk.world, crouched, walk.position));
  walk.go({0.05_m, -0.01_m, {}}, 60);
  const std::optional<Vec3<Position>> high =
      reshaped(walk.world, crouched, walk.position, standing);
  ASSERT_TRUE(high);
  EXPECT_NEAR(metres(high->y), k_stand, 0.011);  // within the skin
}

}  // namespace
}  // namespace lockstone
