// Joints and contacts of one island are solved together.

#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include "tests/world/joints/joint_fixture.h"

namespace lockstone {
namespace {

using namespace literals;

constexpr Length k_half_leg = Length::from_ratio(4, 10);
constexpr Length k_leg_at = Length::from_ratio(6, 10);

// A table whose legs are welded to its top, with a pile of boxes on it, each heavier than the last.
struct Table {
  World world;
  std::vector<BodyHandle> parts;

  explicit Table(std::uint32_t converged_contacts) : world(make(converged_contacts)) {
    test::add_ground(world);
    const BodyHandle top = add(Shape::box(0.7_m, 0.03_m, 0.7_m), {}, 0.83_m, {}, 700);
    for (const Length x : {-k_leg_at, k_leg_at})
      for (const Length z : {-k_leg_at, k_leg_at})
        weld_leg(top, x, z);
    for (int i = 0; i < 4; ++i)
      add(Shape::box(0.1_m, 0.05_m, 0.1_m), Position::from_ratio(2, 10),
          Position::from_ratio(91 + 10 * i, 100), {}, 500 << i);
  }

  static World make(std::uint32_t converged_contacts) {
    WorldDef def{.body_capacity = 64, .pair_capacity = 1024, .contact_capacity = 1024};
    def.converged_contacts = converged_contacts;
    return test::make_world(def);
  }
  BodyHandle add(const Shape& shape, Position x, Position y, Position z, std::int64_t density) {
    BodyDef def = test::dynamic_body(shape, x, y, z);
    def.material.density = Density::from_integer(density);
    parts.push_back(test::add(world, def));
    return parts.back();
  }
  void weld_leg(BodyHandle top, Length x, Length z) {
    const BodyHandle leg = add(Shape::box(0.04_m, 0.4_m, 0.04_m), rounded<Position>(x),
                               rounded<Position>(k_half_leg), rounded<Position>(z), 700);
    JointDef weld = JointDef::of(JointKind::weld, top, leg);
    weld.frame_a.position = {x, Length::from_ratio(-3, 100), z};
    weld.frame_b.position = {{}, k_half_leg, {}};
    (void)test::join(world, weld);
  }

  // Metres that any part moves in ten seconds.
  double moves() {
    std::vector<Vec3<Position>> starts;
    for (const BodyHandle part : parts)
      starts.push_back(world.position(part));
    test::step(world, 600);
    double most = 0;
    for (std::size_t i = 0; i < parts.size(); ++i)
      for (int axis = 0; axis < 3; ++axis)
        most = std::max(most,
                        std::abs(test::metres(world.position(parts[i])[axis] - starts[i][axis])));
    return most;
  }
};

TEST(JointedContacts, LetALaidTableStandAndSleep) {
  Table table(1024);
  EXPECT_LT(table.moves(), 5e-4);
  for (const BodyHandle part : table.parts)
    EXPECT_TRUE(table.world.body(part).is_asleep);
}

// The check can fail: contacts and joints in turn let the same table bend.
TEST(JointedContacts, BendTheTableWhereTheyAreSolvedInTurn) {
  EXPECT_GT(Table(0).moves(), 1e-3);
}

// A ladder of 4 m at 15° against a wall, with a load welded to it that touches nothing.
TEST(JointedContacts, LetALoadedLadderLeanStill) {
  World world = test::make_world();
  test::add_ground(world);
  BodyDef wall;
  wall.motion = MotionType::static_body;
  wall.shape = Shape::box(0.5_m, 4_m, 2_m);
  wall.position = {Position::from_ratio(-10563, 10000), 4_m, {}};
  wall.material.friction = Coefficient::from_ratio(8, 10);
  test::add(world, wall);
  BodyDef def = test::dynamic_body(Shape::box(0.04_m, 2_m, 0.25_m), {},
                                   Position::from_ratio(19422, 10000), {});
  def.orientation = from_axis_angle({{}, {}, 1_r}, 0.261799388_rad);
  def.material.friction = Coefficient::from_ratio(8, 10);
  const BodyHandle ladder = test::add(world, def);
  BodyDef load =
      test::dynamic_body(Shape::box(0.2_m, 0.2_m, 0.2_m), Position::from_ratio(1294, 10000),
                         Position::from_ratio(1459, 1000), {});
  load.orientation = def.orientation;
  load.filter.mask = 0;
  JointDef weld = JointDef::of(JointKind::weld, ladder, test::add(world, load));
  weld.frame_a.position.y = -0.5_m;
  (void)test::join(world, weld);
  const Vec3<Position> start = world.position(ladder);
  test::step(world, 600);
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(test::metres(world.position(ladder)[axis] - start[axis]), 0, 1e-3);
}

// A chain between two posts wedges a ball that is too wide for it: no impulses part them.
TEST(JointedContacts, DoNotThrowBodiesThatJointsHoldWhereTheyOverlap) {
  for (const int wedge : {10, 15, 20, 25}) {
    World world = test::make_world();
    JointDef joint = JointDef::of(JointKind::ball, test::add_fixed(world), {});
    for (int i = 0; i < 6; ++i) {
      const bool is_last = i == 5;
      const Shape shape =
          is_last ? Shape::sphere(Length::from_ratio(wedge, 100)) : Shape::capsule(0.04_m, 0.06_m);
      BodyDef def =
          test::dynamic_body(shape, Position::from_ratio(is_last ? 10 : 2 * i + 1, 10), {}, {});
      def.orientation = from_axis_angle({{}, {}, 1_r}, 1.570796327_rad);
      joint.body_b = test::add(world, def);
      joint.frame_b.position.y = is_last ? Length{} : 0.1_m;
      (void)test::join(world, joint);
      joint.body_a = joint.body_b;
      joint.frame_a.position.y = -0.1_m;
    }
    for (int tick = 0; tick < 300; ++tick) {
      (void)world.step();
      for (std::uint32_t i = 0; i < world.joint_limit(); ++i)
        ASSERT_LT(test::gap(world.joint(world.joint_at(i))), 0.01) << wedge << " at " << tick;
      const Vec3<Velocity> v = world.velocity(joint.body_b);
      ASSERT_LT(std::hypot(test::metres_per_second(v.x), test::metres_per_second(v.y)), 8)
          << wedge << " at " << tick;
    }
  }
}

}  // namespace
}  // namespace lockstone
