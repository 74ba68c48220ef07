// The parts of the joint solver: rows and motion, factors, drives and limits, energy, pulled links.
#include <cmath>

#include <gtest/gtest.h>

#include "core/dynamics/body/inertia.h"
#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/rows/cluster_energy.h"
#include "core/dynamics/linkage/rows/joint_drives.h"
#include "core/dynamics/linkage/rows/pulled_links.h"
#include "core/dynamics/linkage/rows/row_motion.h"
#include "tests/dynamics/joint_scene.h"
#include "tests/support/random.h"

namespace lockstone {
namespace {

using test::JointScene;

constexpr std::int64_t k_metre_per_second = std::int64_t{1} << 50;  // Q50

std::int64_t any_speed(test::Random& random) {
  return random.between(-1000, 1000) * (k_metre_per_second / 100);
}

// Velocities of all bodies at random, within 10 m/s.
void stir(JointScene& scene, test::Random& random) {
  for (std::size_t i = 1; i < scene.rows.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      scene.rows[i].velocity[axis] = any_speed(random);
      scene.rows[i].spin[axis] = any_speed(random);
    }
  }
}

void add_chain(JointScene& scene, int links) {
  std::uint32_t last = scene.body(0, 0, 0);
  for (int i = 1; i < links; ++i) {
    const std::uint32_t next = scene.body(i, 0.25 * (i % 2), 0.125 * (i % 3));
    scene.ball(last, next);
    last = next;
  }
}

std::int64_t greatest_speed(JointScene& scene) {
  std::int64_t greatest = 0;
  for (const LinkedJoint& joint : scene.system.joints)
    for (const JointRow& row : joint.rows.rows.first(joint.rows.locks))
      greatest = std::max(greatest, std::abs(row_speed(scene.run(), joint, row)));
  return greatest;
}

TEST(RowMotion, PushKeepsTheMomentumOfEqualMasses) {
  JointScene scene;
  add_chain(scene, 2);
  scene.plan();
  const LinkedJoint& joint = scene.system.joints[0];
  push(scene.run(), joint, 0, 3, {k_metre_per_second, -k_metre_per_second / 3, 12345});
  for (std::size_t axis = 0; axis < 3; ++axis) {
    EXPECT_NE(scene.row(0).velocity[axis], 0);
    EXPECT_EQ(scene.row(0).velocity[axis], -scene.row(1).velocity[axis]);
  }
}

TEST(RowMotion, SpeedIsThatOfTheAnchors) {
  JointScene scene;
  add_chain(scene, 2);
  scene.plan();
  const LinkedJoint& joint = scene.system.joints[0];
  scene.row(1).velocity = {3 * k_metre_per_second, 0, -k_metre_per_second};
  EXPECT_EQ(row_speed(scene.run(), joint, joint.rows.rows[0]), 3 * k_metre_per_second);
  EXPECT_EQ(row_speed(scene.run(), joint, joint.rows.rows[1]), 0);
  EXPECT_EQ(row_speed(scene.run(), joint, joint.rows.rows[2]), -k_metre_per_second);
}

TEST(RowMotion, ChangesOfAStageAlsoGoToTheSubstepsBeginning) {
  JointScene scene;
  add_chain(scene, 2);
  scene.plan();
  test::Random random(1);
  stir(scene, random);
  const std::span<const std::uint32_t> bodies = scene.system.bodies_of(scene.system.clusters[0]);
  const std::vector<lanes::BodyVelocity> old = scene.rows;
  begin_pushes(scene.run(), scene.system, bodies);
  push(scene.run(), scene.system.joints[0], 0, 3, {1 << 20, 2 << 20, 3 << 20});
  end_pushes(scene.run(), scene.system, bodies);
  for (std::size_t i = 1; i < old.size(); ++i) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      EXPECT_EQ(scene.before[i].velocity[axis],
                scene.rows[i].velocity[axis] - old[i].velocity[axis]);
      EXPECT_EQ(scene.before[i].spin[axis], scene.rows[i].spin[axis] - old[i].spin[axis]);
    }
  }
}

TEST(RowMotion, VelocitiesStayWithinBounds) {
  JointScene scene;
  add_chain(scene, 2);
  scene.plan();
  scene.row(1).velocity[0] = k_row_bound - 5;
  push(scene.run(), scene.system.joints[0], 0, 3, {k_row_bound, 0, 0});
  EXPECT_EQ(scene.row(1).velocity[0], k_row_bound);
}

// One solve leaves 2^-30 of the speeds: factors have 40 fraction bits.
TEST(TreeLocks, TakesTheSpeedsOfAllLocksAway) {
  JointScene scene;
  add_chain(scene, 12);
  scene.plan();
  test::Random random(2);
  stir(scene, random);
  JointGroup& group = scene.system.groups[0];
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const LinkedJoint& joint = scene.system.joints[scene.system.joints_of(group)[k]];
    for (std::size_t r = 0; r < joint.rows.locks; ++r)
      scene.trees.errors(group, k)[r] = row_speed(scene.run(), joint, joint.rows.rows[r]);
  }
  EXPECT_GT(greatest_speed(scene), k_metre_per_second);
  scene.trees.solve(scene.run(), group, false);
  EXPECT_LT(greatest_speed(scene), k_metre_per_second >> 24);
}

TEST(TreeLocks, FactorServesWhileTheRowsAreAlike) {
  JointScene scene;
  add_chain(scene, 3);
  scene.plan();
  JointGroup& group = scene.system.groups[0];
  EXPECT_FALSE(scene.system.has_factor(group));
  scene.trees.factor(group);
  EXPECT_TRUE(scene.system.has_factor(group));
  scene.system.joints[0].rows.rows[2].kind = RowKind::limit;
  EXPECT_FALSE(scene.system.has_factor(group));
}

// Redundant locks: four bodies, each joined to the next by a ball. Rows give way by 2^-14 of their
// response.
TEST(LoopLocks, TakesTheSpeedsOfALoopAway) {
  JointScene scene;
  add_chain(scene, 4);
  scene.ball(3, 0);
  scene.plan();
  test::Random random(3);
  stir(scene, random);
  JointGroup& group = scene.system.groups[0];
  ASSERT_TRUE(group.has_solved_loops());
  for (int solve = 0; solve < 3; ++solve) {
    for (std::uint32_t k = 0; k < group.count; ++k) {
      const LinkedJoint& joint = scene.system.joints[scene.system.joints_of(group)[k]];
      for (std::size_t r = 0; r < joint.rows.locks; ++r)
        scene.loops.errors(group, k)[r] = row_speed(scene.run(), joint, joint.rows.rows[r]);
    }
    scene.loops.solve(scene.run(), group, false);
  }
  EXPECT_LT(greatest_speed(scene), k_metre_per_second / 50);
}

TEST(JointDrives, SpringThatTheSubstepResolvesPushesHalfBeforeAndHalfAfter) {
  JointScene scene;
  add_chain(scene, 2);
  scene.joints[0].axes[3].hertz = Number::from_integer(1);
  scene.plan();
  const JointDrive& drive = scene.system.joints[0].drives[3];
  EXPECT_TRUE(drive.is_spring());
  EXPECT_EQ(drive.before.share, drive.after.share);
  EXPECT_EQ(drive.before.share, k_one / 2);
}

TEST(JointDrives, SpringThatIsTooStiffPushesBeforeAlone) {
  JointScene scene;
  add_chain(scene, 2);
  scene.joints[0].axes[3].hertz = Number::from_integer(200);
  scene.plan();
  const JointDrive& drive = scene.system.joints[0].drives[3];
  EXPECT_EQ(drive.before.share, k_one);
  EXPECT_EQ(drive.after.share, 0);
}

TEST(JointDrives, MotorReachesItsSpeedWithinItsBound) {
  JointScene scene;
  add_chain(scene, 2);
  JointAxisRecord& axis = scene.joints[0].axes[3];
  axis.speed = 1 << 20;
  axis.max_effort = std::int64_t{1} << 40;
  scene.plan();
  LinkedJoint& joint = scene.system.joints[0];
  ASSERT_EQ(joint.rows.count, 4U);
  EXPECT_TRUE(solve_drives(scene.run(), joint, true));
  const JointRow& row = joint.rows.rows[3];
  EXPECT_LT(std::abs(row_speed(scene.run(), joint, row) - row.speed), k_metre_per_second >> 20);
  EXPECT_FALSE(solve_drives(scene.run(), joint, false));

  axis.max_effort = 1;
  scene.plan();
  scene.rows.assign(scene.rows.size(), {});
  solve_drives(scene.run(), scene.system.joints[0], true);
  EXPECT_EQ(scene.system.joints[0].driven[3], scene.system.joints[0].drives[3].bound);
}

TEST(JointDrives, LimitPushesOnlyBack) {
  JointScene scene;
  add_chain(scene, 2);
  scene.joints[0].modes[3] = static_cast<std::uint8_t>(AxisMode::limited);
  scene.joints[0].axes[3].lower = 0;  // where it stands
  scene.joints[0].axes[3].upper = 1 << 26;
  scene.plan();
  LinkedJoint& joint = scene.system.joints[0];
  ASSERT_EQ(joint.rows.rows[3].kind, RowKind::limit);
  scene.row(1).spin[0] = k_metre_per_second;  // away from the limit
  EXPECT_FALSE(solve_limits(scene.run(), scene.system.step, joint, true));
  scene.row(1).spin[0] = -k_metre_per_second;  // into it
  EXPECT_TRUE(solve_limits(scene.run(), scene.system.step, joint, true));
  EXPECT_LT(std::abs(row_speed(scene.run(), joint, joint.rows.rows[3])), k_metre_per_second >> 20);
}

TEST(JointDrives, LimitThatIsFarHasNoRow) {
  JointScene scene;
  add_chain(scene, 2);
  scene.joints[0].modes[3] = static_cast<std::uint8_t>(AxisMode::limited);
  scene.joints[0].axes[3].lower = -(1 << 27);  // 1 rad
  scene.joints[0].axes[3].upper = 1 << 27;
  scene.plan();
  LinkedJoint& joint = scene.system.joints[0];
  ASSERT_EQ(joint.rows.count, 4U);
  scene.row(1).spin[0] = 100 * k_metre_per_second;
  leave_out_far_limits(scene.run(), scene.system.step, joint);
  EXPECT_EQ(joint.rows.count, 4U);
  scene.row(1).spin[0] = 0;
  leave_out_far_limits(scene.run(), scene.system.step, joint);
  EXPECT_EQ(joint.rows.count, 3U);
  EXPECT_TRUE(joint.holds_a_point);
}

TEST(ClusterEnergy, PathLeadsFromNotedVelocitiesToThePresentOnes) {
  JointScene scene;
  add_chain(scene, 3);
  scene.plan();
  const JointCluster& cluster = scene.system.clusters[0];
  for (LinkedBody& body : scene.system.bodies)
    body.mass = quotient(body.record->inverse_mass_value(), body.record->inverse_mass_value());
  const auto energy = [&] {
    return sum_over(scene.system, cluster, [&](const LinkedBody& body) {
      return energy_of(motion_of(body, scene.rows[body.solver]));
    });
  };
  test::Random random(4);
  stir(scene, random);
  const std::int64_t first = energy();
  for (LinkedBody& body : scene.system.bodies)
    body.saved_row = scene.rows[body.solver];
  stir(scene, random);
  const EnergyPath path = energy_path(scene.run(), scene.system, cluster, &LinkedBody::saved_row);
  EXPECT_NEAR(static_cast<double>(path.first), static_cast<double>(first), 64);
  EXPECT_NEAR(static_cast<double>(path.first + path.gain()), static_cast<double>(energy()), 64);

  const std::vector<lanes::BodyVelocity> whole = scene.rows;
  go_part(scene.run(), scene.system, cluster, &LinkedBody::saved_row, 1 << k_share_bits);
  EXPECT_EQ(scene.rows, whole);
  go_part(scene.run(), scene.system, cluster, &LinkedBody::saved_row, 0);
  EXPECT_EQ(energy(), first);
}

TEST(PulledLinks, LeverIsFromTheMiddleOfTwoAnchors) {
  JointScene scene;
  const std::uint32_t left = scene.body(-2, 0, 0, MotionType::static_body);
  const std::uint32_t rod = scene.body(0, 0, 0), right = scene.body(2, 0, 0);
  scene.ball(left, rod);  // at −1 m
  scene.plan();
  EXPECT_EQ(lever_inertia(scene.system, 1), k_one);  // 1 m²
  scene.ball(rod, right);                            // and at 1 m
  scene.plan();
  EXPECT_EQ(lever_inertia(scene.system, 1), 0);
}

// A rod between two anchors that is pulled by 1 km/s of impulse a substep.
TEST(PulledLinks, AreHeavierToTurnWithTheSameAngularVelocity) {
  JointScene scene;
  const std::uint32_t left = scene.body(-2, 0, 0, MotionType::static_body);
  const std::uint32_t rod = scene.body(0, 0, 0), right = scene.body(2, 0, 0);
  for (JointRecord* joint : {&scene.ball(left, rod), &scene.ball(rod, right)})
    joint->axes[0].impulse = SolverVelocity::from_integer(1000);
  scene.plan();
  EXPECT_TRUE(scene.system.bodies[1].pulled);
  LinkedBody& body = scene.system.bodies[1];
  for (LinkedJoint& joint : scene.system.joints)
    load_impulses(joint, 30);
  scene.row(rod).spin = {k_metre_per_second, 0, 0};
  const auto turning = [&] { return motion_of(body, scene.row(rod)).surface; };
  const Vec3<Velocity> before = turning();
  resist_pulls(scene.run(), scene.system);
  EXPECT_GT(body.least_inertia, 0);
  EXPECT_GT(scene.row(rod).spin[0], k_metre_per_second);
  EXPECT_NEAR(static_cast<double>(turning().x.raw), static_cast<double>(before.x.raw), 64);
  set_least_inertia(scene.run(), body, 0);
  EXPECT_NEAR(static_cast<double>(scene.row(rod).spin[0]), static_cast<double>(k_metre_per_second),
              std::ldexp(1, 26));
}

TEST(LinkedBody, MovesToWhereItWasSeen) {
  JointScene scene;
  add_chain(scene, 2);
  scene.records[0].inertia.x = Unit::from_ratio(1, 8);  // its tensor turns with it
  scene.plan();
  test::Random random(5);
  stir(scene, random);
  LinkedBody& body = scene.system.bodies[0];
  look_ahead(scene.run(), body);
  const JointPose seen = body.after;
  EXPECT_NE(seen.position, body.pose.position);
  EXPECT_NE(seen.orientation, body.pose.orientation);
  move_body(scene.run(), body);
  EXPECT_EQ(body.pose.position, seen.position);
  EXPECT_EQ(body.pose.orientation, seen.orientation);
  EXPECT_FALSE(body.has_looked);
}

}  // namespace
}  // namespace lockstone
