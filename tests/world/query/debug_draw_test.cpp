// Debug drawing shows the true state of a world.
#include <cmath>
#include <cstdlib>
#include <set>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/debug_draw.h>
#include <lockstone/testing/floating.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

constexpr DebugDrawOptions k_everything{
    .shapes = true, .bounds = true, .masses = true, .contacts = true, .joints = true};

class Notes final : public DebugDraw {
 public:
  explicit Notes(const World& world) { world.draw(*this, k_everything); }

  void draw_shape(const DebugShape& shape) override { shapes.push_back(shape); }
  void draw_bounds(const DebugBounds& box) override { bounds.push_back(box); }
  void draw_mass(const DebugMass& mass) override { masses.push_back(mass); }
  void draw_contact(const DebugContact& contact) override { contacts.push_back(contact); }
  void draw_joint(const DebugJoint& joint) override { joints.push_back(joint); }

  std::vector<DebugShape> shapes;
  std::vector<DebugBounds> bounds;
  std::vector<DebugMass> masses;
  std::vector<DebugContact> contacts;
  std::vector<DebugJoint> joints;
};

World stack_of(int boxes) {
  World world = test::make_world();
  test::add_ground(world);
  for (int i = 0; i < boxes; ++i) {
    const Position y = Position::from_integer(i) + 0.5_m;
    test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {}, y, {}));
  }
  return world;
}

double force_of(const DebugContact& contact) {
  double sum = 0;
  for (std::uint32_t i = 0; i < contact.count; ++i)
    sum += to_double(contact.points[i].force);
  return sum;
}

TEST(DebugDraw, ShowsTheWeightThatContactsCarry) {
  World world = stack_of(3);
  test::step(world, 20);
  const Notes notes(world);
  ASSERT_EQ(notes.contacts.size(), 3U);
  for (const DebugContact& contact : notes.contacts) {
    EXPECT_TRUE(contact.touching);
    EXPECT_EQ(contact.count, 4U);
    EXPECT_EQ(std::abs(contact.normal.y.raw), 1 << 30);
    const double y = to_double(contact.points[0].point.y);
    EXPECT_NEAR(y, std::round(y), 1e-3);
    const double carried = 3 - std::round(y);
    EXPECT_NEAR(force_of(contact), carried * 9810, 30);
  }
}

TEST(DebugDraw, ShowsBodiesWithBoundsAndCentres) {
  World world = stack_of(2);
  const Notes notes(world);
  ASSERT_EQ(notes.shapes.size(), 3U);
  ASSERT_EQ(notes.bounds.size(), 3U);
  ASSERT_EQ(notes.masses.size(), 2U);
  EXPECT_EQ(notes.shapes[0].state, DebugState::static_body);
  EXPECT_EQ(notes.shapes[1].state, DebugState::awake);
  EXPECT_TRUE(notes.shapes[0].island.is_null());
  EXPECT_NEAR(to_double(notes.masses[0].mass), 1000, 1e-3);
  const DebugBounds& box = notes.bounds[2];
  for (int axis = 0; axis < 3; ++axis) {
    EXPECT_LE(box.lower[axis], notes.shapes[2].pose.position[axis] - 0.5_m);
    EXPECT_GE(box.upper[axis], notes.shapes[2].pose.position[axis] + 0.5_m);
  }
}

TEST(DebugDraw, ShowsIslandsOfBodiesAwakeAndAsleep) {
  World world = stack_of(3);
  for (const Position x : {Position(5_m), Position(9_m)})
    test::add(world, test::dynamic_body(Shape::sphere(0.5_m), x, 0.5_m, {}));
  for (const int ticks : {5, 120}) {
    test::step(world, ticks);
    const Notes notes(world);
    std::set<BodyHandle> islands;
    for (const DebugShape& shape : notes.shapes)
      if (shape.state != DebugState::static_body) islands.insert(shape.island);
    EXPECT_EQ(islands.size(), 3U);
    EXPECT_EQ(notes.shapes[3].island, notes.shapes[1].body);
    EXPECT_EQ(notes.shapes[3].state, ticks == 5 ? DebugState::awake : DebugState::asleep);
  }
}

TEST(DebugDraw, ShowsJointsWithFramesAndLimits) {
  World world = test::make_world();
  const BodyHandle pivot = test::add_ground(world);
  const BodyHandle box =
      test::add(world, test::dynamic_body(Shape::box(0.5_m, 0.1_m, 0.1_m), 2_m, 5_m, {}));
  JointDef def = JointDef::of(JointKind::ball, pivot, box);
  def.frame_b.position = {-0.5_m, {}, {}};
  def.frame_a.position = {1.5_m, 5_m, {}};
  def.angular[1].mode = AxisMode::limited;
  def.angular[1].upper = 0.7_rad;
  const JointHandle joint = world.create_joint(def).value();
  test::step(world, 180);  // the joint closes
  const Notes notes(world);
  ASSERT_EQ(notes.joints.size(), 1U);
  const DebugJoint& drawn = notes.joints[0];
  EXPECT_EQ(drawn.joint, joint);
  EXPECT_EQ(drawn.view.body_b, box);
  EXPECT_EQ(drawn.modes[4], AxisMode::limited);
  EXPECT_EQ(drawn.angular_upper[1], Angle(0.7_rad));
  for (int axis = 0; axis < 3; ++axis)
    EXPECT_NEAR(to_double(drawn.place_a[axis]), to_double(drawn.place_b[axis]), 1e-5);
}

TEST(DebugDraw, ChangesNothing) {
  World drawn = test::make_world(), plain = test::make_world();
  test::fill_with_random_bodies(drawn, 4, 60);
  test::fill_with_random_bodies(plain, 4, 60);
  for (int tick = 0; tick < 60; ++tick) {
    (void)drawn.step();
    (void)plain.step();
    const Notes notes(drawn);
    ASSERT_EQ(drawn.hash().total, plain.hash().total) << "tick " << tick;
  }
}

}  // namespace
}  // namespace lockstone
