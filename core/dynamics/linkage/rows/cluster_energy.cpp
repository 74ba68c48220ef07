#include "core/dynamics/linkage/rows/cluster_energy.h"

#include <lockstone/assert.h>

#include "core/dynamics/body/motion.h"
#include "core/dynamics/joint/joint_numbers.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

// To close locks, positions may move with so much more energy than bodies have, twice by the
// heaviest body's mass: (0.5 m/s)², Q32.
constexpr std::int64_t k_closing_energy = std::int64_t{1} << 30;

Velocity to_velocity(std::int64_t x) {
  return Velocity::from_raw(raw::round_shift(bounded(x, k_row_bound), 18));
}

std::int64_t product_of(const JointMotion& a, const JointMotion& b) {
  return energy_product(a.velocity, b.velocity, a.spin, b.surface);
}

// How a body turns; `is_heavier`: than it is.
struct TurningState {
  const InverseInertia& inertia;
  const Mat3& rotation;
  bool is_heavier;
};

JointMotion motion_of(const BodyRecord& record, const TurningState& turning,
                      const lanes::BodyVelocity& row) {
  JointMotion motion;
  for (int i = 0; i < 3; ++i) {
    motion.velocity[i] = to_velocity(row.velocity[static_cast<std::size_t>(i)]);
    motion.spin[i] = to_velocity(row.spin[static_cast<std::size_t>(i)]);
  }
  motion.surface = surface_velocity(turning.inertia, motion.spin);
  if (turning.is_heavier) motion.spin = spin_of(record, turning.rotation, motion.surface);
  return motion;
}

}  // namespace

JointMotion motion_of(const LinkedBody& body, const lanes::BodyVelocity& row) {
  const TurningState turning{body.inverse_inertia, body.pose.rotation, body.least_inertia != 0};
  return motion_of(*body.record, turning, row);
}

JointMotion start_motion_of(const LinkedBody& body) {
  const TurningState turning{body.start_inertia, body.start_rotation, body.starts_heavier};
  return motion_of(*body.record, turning, body.start);
}

std::int64_t energy_of(const JointMotion& motion) {
  return product_of(motion, motion);
}

std::int64_t turning_energy_of(const JointMotion& motion) {
  return energy_product({}, {}, motion.spin, motion.surface);
}

EnergyPath energy_path(const JointRun& run, const JointSystem& system, const JointCluster& cluster,
                       NotedVelocities from) {
  EnergyPath path;
  for (const std::uint32_t index : system.bodies_of(cluster)) {
    const LinkedBody& body = system.bodies[index];
    if (!body.pushed) continue;
    const JointMotion first = motion_of(body, body.*from),
                      now = motion_of(body, run.rows[body.solver]);
    const JointMotion way{now.velocity - first.velocity, now.surface - first.surface,
                          now.spin - first.spin};
    const auto add = [&](std::int64_t& sum, const JointMotion& a, const JointMotion& b) {
      add_energy(sum, product_of(a, b), body.mass);
    };
    add(path.first, first, first);
    add(path.linear, first, way);
    add(path.square, way, way);
  }
  path.linear = raw::saturating_add(path.linear, path.linear);
  return path;
}

void go_part(const JointRun& run, const JointSystem& system, const JointCluster& cluster,
             NotedVelocities from, std::int32_t share) {
  LKS_ASSERT(share >= 0 && share <= 1 << k_share_bits);
  for (const std::uint32_t index : system.bodies_of(cluster)) {
    const LinkedBody& body = system.bodies[index];
    if (!body.pushed) continue;
    lanes::BodyVelocity& row = run.rows[body.solver];
    const auto between = [&](std::int64_t begin, std::int64_t& now) {
      const std::int64_t first = bounded(begin, k_row_bound);
      now = first + product_rounded(bounded(now, k_row_bound) - first, share, k_share_bits);
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      between((body.*from).velocity[axis], row.velocity[axis]);
      between((body.*from).spin[axis], row.spin[axis]);
    }
  }
}

namespace {

void keep_part(const JointRun& run, JointSystem& system, const JointCluster& cluster,
               std::int32_t share) {
  go_part(run, system, cluster, &LinkedBody::saved_row, share);
  for (LinkedJoint& joint : system.joints_of(cluster)) {
    for (std::size_t i = 0; i < k_joint_axes; ++i) {
      const std::int64_t change = bounded(joint.locks[i] - joint.saved[i], k_product_bound);
      joint.locks[i] = joint.saved[i] + product_rounded(change, share, k_share_bits);
    }
  }
}

}  // namespace

void limit_projection(const JointRun& run, JointSystem& system, const JointCluster& cluster) {
  const EnergyPath path = energy_path(run, system, cluster, &LinkedBody::saved_row);
  if (path.gain() <= 0) return;
  keep_part(run, system, cluster, share_of(-(path.linear / 2), path.square));
}

bool closes_too_fast(const JointRun& run, const JointSystem& system, const JointCluster& cluster) {
  const EnergyPath path = energy_path(run, system, cluster, &LinkedBody::saved_row);
  return path.gain() > path.first / 16 + k_closing_energy;
}

void limit_closing(const JointRun& run, JointSystem& system, const JointCluster& cluster) {
  const EnergyPath path = energy_path(run, system, cluster, &LinkedBody::saved_row);
  if (path.gain() <= k_closing_energy) return;
  const std::int32_t share = greatest_share(path.square, path.linear, k_closing_energy);
  keep_part(run, system, cluster, share);
}

}  // namespace lockstone
