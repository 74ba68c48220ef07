#include <array>

#include <gtest/gtest.h>

#include <lockstone/testing/floating.h>

#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

struct Stack {
  World world = test::make_world();
  BodyHandle ground = test::add_ground(world);
  std::array<BodyHandle, 3> boxes{};

  Stack() {
    for (std::size_t i = 0; i < boxes.size(); ++i) {
      BodyDef def = test::dynamic_body(Shape::box(0.5_m, 0.5_m, 0.5_m), {},
                                       Position::from_ratio(1 + 2 * static_cast<int>(i), 2), {});
      def.material.tag = static_cast<std::uint32_t>(i) + 10;
      boxes[i] = test::add(world, def);
    }
    test::step(world, 60);
  }
};

void expect_middle_of(const Stack& stack) {
  std::array<BodyContact, 4> found{};
  ASSERT_EQ(contacts_of(stack.world, stack.boxes[1], found), 2U);
  EXPECT_EQ(found[0].other, stack.boxes[0]);
  EXPECT_EQ(found[1].other, stack.boxes[2]);
  EXPECT_NEAR(to_double(found[0].normal.y), -1, 1e-6);
  EXPECT_NEAR(to_double(found[1].normal.y), 1, 1e-6);
  EXPECT_EQ(found[0].tag, 11U);
  EXPECT_EQ(found[0].other_tag, 10U);
  const double weight = to_double(stack.world.mass(stack.boxes[1])) * 9.81;
  EXPECT_NEAR(to_double(found[0].normal_force) / weight, 2, 0.02);  // its own and the upper box's
  EXPECT_NEAR(to_double(found[1].normal_force) / weight, 1, 0.02);
  ASSERT_EQ(found[0].count, 4U);
  double sum = 0;
  for (const TouchingPoint& point : found[0].points) {
    EXPECT_NEAR(to_double(point.point.y), 1, 2e-3);
    sum += to_double(point.normal_force);
  }
  EXPECT_NEAR(sum / to_double(found[0].normal_force), 1, 1e-6);
}

TEST(ContactsOf, TellWhoTouchesWhereAndHowHard) {
  expect_middle_of(Stack());
}

TEST(ContactsOf, ASleepingBodyAreThoseThatItFellAsleepWith) {
  Stack stack;
  test::step(stack.world, 60);
  ASSERT_TRUE(stack.world.body(stack.boxes[1]).is_asleep);
  expect_middle_of(stack);
}

TEST(ContactsOf, FollowFromTheState) {
  Stack stack;
  Stack other;
  const std::vector<std::byte> saved = test::save(stack.world, SnapshotKind::canonical);
  test::step(other.world, 7);
  ASSERT_EQ(other.world.load(SnapshotKind::canonical, saved), Status::ok);
  expect_middle_of(other);
}

TEST(ContactsOf, AreAsManyAsThereIsRoomForInTheirOrder) {
  Stack stack;
  std::array<BodyContact, 1> found{};
  EXPECT_EQ(contacts_of(stack.world, stack.boxes[1], found), 1U);
  EXPECT_EQ(found[0].other, stack.boxes[0]);
  EXPECT_EQ(contacts_of(stack.world, stack.boxes[1], {}), 0U);
  EXPECT_EQ(contacts_of(stack.world, {}, found), 0U);
}

TEST(JointsOf, AreThoseOfTheBodyByIndex) {
  Stack stack;
  std::array<JointHandle, 3> made{};
  const auto join = [&](BodyHandle a, BodyHandle b) {
    return stack.world.create_joint(JointDef::of(JointKind::weld, a, b)).value();
  };
  made[0] = join(stack.boxes[0], stack.boxes[1]);
  made[1] = join(stack.ground, stack.boxes[0]);
  made[2] = join(stack.boxes[2], stack.boxes[1]);
  std::array<JointHandle, 4> found{};
  ASSERT_EQ(joints_of(stack.world, stack.boxes[1], found), 2U);
  EXPECT_EQ(found[0], made[0]);
  EXPECT_EQ(found[1], made[2]);
  EXPECT_EQ(joints_of(stack.world, {}, found), 0U);
}

}  // namespace
}  // namespace lockstone
