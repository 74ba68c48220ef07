// The kinetic energy of a cluster's bodies, and how velocities are scaled to keep it within bounds.
//
// Energies are twice the energy by the mass of the cluster's heaviest body (`JointCluster::unit`),
// m²/s², Q32. They count a body's own inertia, also where it is taken to be heavier to turn.
#pragma once

#include <cstdint>

#include "core/dynamics/body/energy.h"
#include "core/dynamics/linkage/system/joint_run.h"
#include "core/dynamics/linkage/system/joint_system.h"
#include "core/math/block_float.h"

namespace lockstone {

/// Velocity, surface velocity and spin of a body, by its own inertia.
struct JointMotion {
  Vec3<Velocity> velocity{}, surface{}, spin{};
};

[[nodiscard]] JointMotion motion_of(const LinkedBody& body, const lanes::BodyVelocity& row);

/// The motion at the substep's beginning, by the inertia of then.
[[nodiscard]] JointMotion start_motion_of(const LinkedBody& body);

/// Twice the energy for each mass: of all motion, and of turning alone.
[[nodiscard]] std::int64_t energy_of(const JointMotion& motion);
[[nodiscard]] std::int64_t turning_energy_of(const JointMotion& motion);

/// The sum of `each` (a number for each mass) over the pushed bodies of a cluster.
template <class Each>
[[nodiscard]] std::int64_t sum_over(const JointSystem& system, const JointCluster& cluster,
                                    const Each& each) {
  std::int64_t sum = 0;
  for (const std::uint32_t index : system.bodies_of(cluster)) {
    const LinkedBody& body = system.bodies[index];
    if (!body.pushed) continue;
    sum = raw::saturating_add(sum, scale_saturating(each(body), body.mass, 0));
  }
  return sum;
}

/// Velocities that a stage noted: `unpushed` or `saved_row`.
using NotedVelocities = lanes::BodyVelocity LinkedBody::*;

/// The energy on the way from noted velocities to the present ones: where a share s of the way is
/// gone, it is first + s·linear + s²·square.
struct EnergyPath {
  std::int64_t first = 0, linear = 0, square = 0;

  /// The change along the whole way.
  [[nodiscard]] std::int64_t gain() const { return raw::saturating_add(square, linear); }
};
[[nodiscard]] EnergyPath energy_path(const JointRun& run, const JointSystem& system,
                                     const JointCluster& cluster, NotedVelocities from);

/// Goes from noted velocities only a share (k_share_bits) of the way to the present ones.
void go_part(const JointRun& run, const JointSystem& system, const JointCluster& cluster,
             NotedVelocities from, std::int32_t share);

/// Whether the velocities that are about to move positions have much more energy than those before,
/// which `saved_row` has.
[[nodiscard]] bool closes_too_fast(const JointRun& run, const JointSystem& system,
                                   const JointCluster& cluster);

/// After a projection, which cannot gain energy but for rounding: goes along it, from `saved_row`,
/// only as far as energy falls. Where locks cannot hold together, rounding may be all there is.
void limit_projection(const JointRun& run, JointSystem& system, const JointCluster& cluster);

/// Leaves as much of their difference to those before as the energy to close locks allows.
void limit_closing(const JointRun& run, JointSystem& system, const JointCluster& cluster);

}  // namespace lockstone
