// Which joints are solved together, and how.
#include "core/dynamics/linkage/joint_planner.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/dynamics/joint_scene.h"

namespace lockstone {
namespace {

using test::JointScene;

// Bodies 0 … links − 1 in a row, each joined to the next one.
void add_chain(JointScene& scene, std::uint32_t links, double y) {
  std::uint32_t last = scene.body(0, y, 0);
  for (std::uint32_t i = 1; i < links; ++i) {
    const std::uint32_t next = scene.body(i, y, 0);
    scene.ball(last, next);
    last = next;
  }
}

TEST(JointPlanner, ChainIsOneDirectGroup) {
  JointScene scene;
  add_chain(scene, 8, 0);
  scene.plan();
  ASSERT_EQ(scene.system.clusters.size(), 1U);
  ASSERT_EQ(scene.system.groups.size(), 1U);
  const JointGroup& group = scene.system.groups[0];
  EXPECT_TRUE(group.is_direct);
  EXPECT_FALSE(group.has_solved_loops());
  EXPECT_EQ(group.count, 7U);
  EXPECT_EQ(group.body_count, 8U);
  EXPECT_TRUE(scene.in_balls.empty());
}

TEST(JointPlanner, TreeIsEliminatedFromItsLeaves) {
  JointScene scene;
  add_chain(scene, 8, 0);
  scene.plan();
  const std::span<const std::uint32_t> order = scene.system.joints_of(scene.system.groups[0]);
  EXPECT_TRUE(std::ranges::is_sorted(order, std::greater<>()));  // the first body is the root
}

TEST(JointPlanner, ChainsApartAreClustersThatShareNoBody) {
  JointScene scene;
  add_chain(scene, 3, 0);
  add_chain(scene, 4, 5);
  scene.plan();
  ASSERT_EQ(scene.system.clusters.size(), 2U);
  EXPECT_EQ(scene.system.clusters[0].joint_count, 2U);
  EXPECT_EQ(scene.system.clusters[1].joint_count, 3U);
  for (const std::uint32_t a : scene.system.bodies_of(scene.system.clusters[0]))
    for (const std::uint32_t b : scene.system.bodies_of(scene.system.clusters[1]))
      EXPECT_NE(a, b);
}

TEST(JointPlanner, StaticBodyDoesNotConnectClusters) {
  JointScene scene;
  const std::uint32_t ground = scene.body(0, 0, 0, MotionType::static_body);
  scene.ball(ground, scene.body(1, 0, 0));
  scene.ball(ground, scene.body(-1, 0, 0));
  scene.plan();
  EXPECT_EQ(scene.system.clusters.size(), 2U);
}

TEST(JointPlanner, RingIsSolvedAsLoops) {
  JointScene scene;
  add_chain(scene, 4, 0);
  scene.ball(3, 0);
  scene.plan();
  ASSERT_EQ(scene.system.groups.size(), 1U);
  EXPECT_TRUE(scene.system.groups[0].has_solved_loops());
  EXPECT_TRUE(scene.system.groups[0].is_direct);
}

TEST(JointPlanner, RingThroughTheGroundIsSolvedAsLoops) {
  JointScene scene;
  add_chain(scene, 3, 0);
  const std::uint32_t left = scene.body(-1, 0, 0, MotionType::static_body);
  const std::uint32_t right = scene.body(3, 0, 0, MotionType::static_body);
  scene.ball(left, 0);
  scene.plan();
  EXPECT_FALSE(scene.system.groups[0].has_solved_loops());
  scene.ball(2, right);
  scene.plan();
  EXPECT_TRUE(scene.system.groups[0].has_solved_loops());
}

TEST(JointPlanner, MotorIsSolvedAlongWithLocks) {
  JointScene scene;
  add_chain(scene, 3, 0);
  scene.joints[0].axes[3].max_effort = 1 << 20;
  scene.plan();
  EXPECT_TRUE(scene.system.groups[0].has_solved_loops());
}

// Without the factor of loops: a net of 4 × 4 bodies has 24 joints, nine loops.
TEST(JointPlanner, BallsOfManyLoopsAreLeftToTheNet) {
  JointScene scene(false);
  for (int i = 0; i < 16; ++i)
    scene.body(i % 4, i / 4, 0);
  for (std::uint32_t i = 0; i < 16; ++i) {
    if (i % 4 != 3) scene.ball(i, i + 1);
    if (i < 12) scene.ball(i, i + 4);
  }
  scene.plan();
  EXPECT_EQ(scene.in_balls.size(), 24U);
  EXPECT_TRUE(scene.system.clusters.empty());

  // One that also locks a turn is not a ball: it is a group of its own.
  scene.joints[5].modes[3] = static_cast<std::uint8_t>(AxisMode::locked);
  scene.plan();
  EXPECT_EQ(scene.in_balls.size(), 23U);
  ASSERT_EQ(scene.system.clusters.size(), 1U);
  EXPECT_EQ(scene.system.groups.size(), 1U);
  EXPECT_FALSE(scene.system.groups[0].is_direct);
}

TEST(JointPlanner, PlanDependsOnTheOrderOfJointsAlone) {
  const auto planned = [](std::uint32_t unrelated) {
    JointScene scene;
    for (std::uint32_t i = 0; i < unrelated; ++i)
      scene.body(100, 0, 0);
    const std::uint32_t first = scene.body(0, 0, 0);
    for (std::uint32_t i = 1; i < 6; ++i)
      scene.ball(first + i - 1, scene.body(i, 0, 0));
    scene.plan();
    return std::vector(scene.system.order);
  };
  EXPECT_EQ(planned(0), planned(7));
}

}  // namespace
}  // namespace lockstone
