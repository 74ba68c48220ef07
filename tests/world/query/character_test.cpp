// The character mover: walls, corners, ledges, slopes, pushes.
#include <gtest/gtest.h>

#include <lockstone/character.h>

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
  ASSERT_GT(walk.last.hit_count, 0U);
  EXPECT_NEAR(metres(rounded<Position>(walk.last.hits[0].blocked)), 0.05, 0.012);
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
  EXPECT_EQ(
      walk.world.overlap_shape(Shape::capsule(walk.def.half_height, walk.def.radius - 0.002_m),
                               {walk.position, {}}, found),
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

TEST(Character, NeverEndsInsideAnything) {
  test::Random random(test::run_seed());
  for (int run = 0; run < 20; ++run) {
    Walk walk;
    fill_room(random, walk);
    Vec3<Length> motion;
    for (int tick = 0; tick < 200; ++tick) {
      if (tick % 20 == 0) motion = random_motion(random);
      walk.go(motion, 1);
      BodyHandle found[4];
      const Shape inner = Shape::capsule(walk.def.half_height, walk.def.radius - 0.001_m);
      ASSERT_EQ(walk.world.overlap_shape(inner, {walk.position, {}}, found), 0U)
          << "run " << run << " tick " << tick;
    }
  }
}

}  // namespace
}  // namespace lockstone
