// Clusters that are worked at one by one.

#include "core/dynamics/linkage/cluster/whole_clusters.h"

#include <gtest/gtest.h>

#include "tests/dynamics/joint_scene.h"

namespace lockstone::test {
namespace {

// The parts that work at the joints of a scene.
struct Parts {
  explicit Parts(JointScene& scene)
      : locks(scene.system, scene.trees, scene.loops),
        account(scene.system, locks),
        stages(scene.system, locks, account),
        clusters(scene.system, stages, account) {}

  LockSolver locks;
  EnergyAccount account;
  ClusterStages stages;
  WholeClusters clusters;
};

// Two links, on a body that is not pushed; plans it.
struct Chain {
  explicit Chain(JointScene& scene, MotionType anchor)
      : top(scene.body(0, 0, 0, anchor)), link(scene.body(1, 0, 0)), last(scene.body(2, 0, 0)) {
    scene.ball(top, link);
    scene.ball(link, last);
    scene.plan();
  }
  std::uint32_t top, link, last;
};

TEST(WholeClusters, AreApartWithBodiesThatStandStill) {
  JointScene scene;
  const Chain chain(scene, MotionType::static_body);
  const Parts parts(scene);
  ASSERT_EQ(scene.system.clusters.size(), 1U);
  EXPECT_TRUE(parts.clusters.is_apart(0));
  EXPECT_EQ(parts.clusters.joint_count(0), 2U);
  const std::uint32_t body = parts.clusters.body_of(0);
  EXPECT_TRUE(body == chain.link + 1 || body == chain.last + 1);
}

TEST(WholeClusters, AreNotApartWithABodyThatMovesByItself) {
  JointScene scene;
  const Chain chain(scene, MotionType::kinematic);
  const Parts parts(scene);
  ASSERT_EQ(scene.system.clusters.size(), 1U);
  EXPECT_FALSE(parts.clusters.is_apart(0));
}

TEST(WholeClusters, TakeTheirBodiesAlong) {
  JointScene scene;
  for (int chain = 0; chain < 2; ++chain) {
    const std::uint32_t first = scene.body(0, 3 * chain, 0), second = scene.body(1, 3 * chain, 0);
    scene.ball(first, second);
  }
  scene.plan();
  Parts parts(scene);
  ASSERT_EQ(scene.system.clusters.size(), 2U);
  parts.clusters.take(1);
  EXPECT_FALSE(scene.system.clusters[0].is_whole);
  EXPECT_TRUE(scene.system.clusters[1].is_whole);
  int taken = 0;
  for (const LinkedBody& body : scene.system.bodies)
    taken += body.is_whole ? 1 : 0;
  EXPECT_EQ(taken, 2);
}

}  // namespace
}  // namespace lockstone::test
