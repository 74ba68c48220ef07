#include "core/dynamics/linkage/cluster/energy_account.h"

#include <algorithm>
#include <utility>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/rows/cluster_energy.h"
#include "core/dynamics/linkage/rows/row_motion.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

// A cluster may gain 2^-this of its kinetic energy, and regain as much after a loss.
constexpr int k_gain_shift = 10;

// In a tick the account forgets 2^-this of itself: half in three seconds.
constexpr int k_forget_shift = 8;

// From fraction bits of the record to those of energies here.
constexpr int k_record_shift = 32 - k_gained_frac_bits;

// Less than this, twice for each mass, is rounding: (0.1 mm/s)², Q32.
constexpr std::int64_t k_rounding_energy = 43;

// Twice the work of the body's torque in the substep, by its mass, (m/s)², Q32: at the mean rate.
std::int64_t work_of_torque(const JointRun& run, const LinkedBody& body) {
  const auto& [x, y, z] = run.bodies[body.solver].spin_gain;
  if ((x | y | z) == 0) return 0;
  const Vec3<Velocity> gain{Velocity::from_raw(x), Velocity::from_raw(y), Velocity::from_raw(z)};
  const Vec3<Velocity> now = motion_of(body, run.rows[body.solver]).surface;
  return energy_product({}, {}, gain, start_motion_of(body).surface + now);
}

}  // namespace

void EnergyAccount::open(JointCluster& cluster) {
  LKS_ASSERT(cluster.body_count > 0 && cluster.joint_count > 0);
  const auto stands = [&](std::uint32_t index) {
    return system_.bodies[index].pushed || system_.bodies[index].solver == 0;
  };
  const auto may_be_pushed = [&](std::uint32_t index) {
    const LinkedBody& body = system_.bodies[index];
    return body.touches || body.is_among_contacts || body.in_balls;
  };
  cluster.is_driven = std::ranges::any_of(system_.joints_of(cluster), [](const LinkedJoint& joint) {
    return std::ranges::any_of(joint.record->axes, &JointAxisRecord::is_driven);
  });
  cluster.is_passive =
      !cluster.moves_first && !cluster.is_driven &&
      std::ranges::none_of(system_.bodies_of(cluster), may_be_pushed) &&
      std::ranges::all_of(system_.joints_of(cluster), [&](const LinkedJoint& joint) {
        return !joint.turns_locks && stands(joint.a) && stands(joint.b);
      });
  cluster.first_gained = 0;
  if (cluster.is_passive) {
    const std::int64_t stored = system_.joints_of(cluster)[0].record->energy_gained;
    cluster.first_gained =
        (stored - raw::round_shift(stored, k_forget_shift)) * (std::int64_t{1} << k_record_shift);
  }
  cluster.gained = cluster.first_gained;
  find_heaviest_body(cluster);
  cluster.knows_energy = false;
}

std::int32_t EnergyAccount::stored_gain(const JointCluster& cluster) {
  return raw::saturate<std::int32_t>(raw::round_shift(cluster.gained, k_record_shift));
}

void EnergyAccount::find_heaviest_body(JointCluster& cluster) {
  cluster.unit = {};
  for (const std::uint32_t index : system_.bodies_of(cluster)) {
    const BlockFloat inverse = system_.bodies[index].record->inverse_mass_value();
    if (!system_.bodies[index].pushed) continue;
    const bool is_heavier = ratio(inverse, cluster.unit) < Unit::from_raw(1 << 29);
    if (cluster.unit == BlockFloat{} || is_heavier) cluster.unit = inverse;
  }
  for (const std::uint32_t index : system_.bodies_of(cluster)) {
    LinkedBody& body = system_.bodies[index];
    if (body.pushed) body.mass = quotient(cluster.unit, body.record->inverse_mass_value());
  }
  LKS_ASSERT(cluster.unit.mantissa > 0);
}

void EnergyAccount::begin(const JointRun& run, JointCluster& cluster) {
  if (!cluster.is_passive) return;
  LKS_ASSERT(!run.before.empty());
  for (const std::uint32_t index : system_.bodies_of(cluster)) {
    LinkedBody& body = system_.bodies[index];
    if (!body.pushed) continue;
    body.start = run.before[body.solver];
    body.start_position = body.pose.position;
    body.start_inertia = body.inverse_inertia;
    body.start_rotation = body.pose.rotation;
    body.starts_heavier = body.least_inertia != 0;
  }
  if (!cluster.knows_energy)
    cluster.energy = sum_over(system_, cluster, [&](const LinkedBody& body) {
      return energy_of(motion_of(body, body.start));
    });
  cluster.gained = raw::saturating_add(cluster.gained, -cluster.energy);
}

// Impulses of the last substep may suit this one badly: after a blow, or where links turn fast. The
// share that leaves the least energy is repeated.
void EnergyAccount::limit_warm_start(const JointRun& run, const JointCluster& cluster) {
  const JointGroup& group = system_.groups_of(cluster)[0];
  if (!group.is_direct || group.has_solved_loops() || cluster.is_driven) return;
  const EnergyPath path = energy_path(run, system_, cluster, &LinkedBody::unpushed);
  if (path.gain() <= path.first / 4 + k_rounding_energy) return;
  const std::int32_t share = share_of(-(path.linear / 2), path.square);
  LKS_ASSERT(share >= 0 && share <= 1 << k_share_bits);
  go_part(run, system_, cluster, &LinkedBody::unpushed, share);
  for (LinkedJoint& joint : system_.joints_of(cluster))
    for (std::int64_t& impulse : joint.locks)
      impulse = product_rounded(impulse, share, k_share_bits);
}

// The velocities without positional correction: the substep's first ones, with the gain of gravity
// and forces, such that locks and limits do not open where the bodies are now.
void EnergyAccount::project_start(const JointRun& run, const JointCluster& cluster) {
  for (const std::uint32_t index : system_.bodies_of(cluster)) {
    LinkedBody& body = system_.bodies[index];
    if (!body.pushed) continue;
    lanes::BodyVelocity& row = run.rows[body.solver];
    body.saved_row = row;
    const SolverBody& solver = run.bodies[body.solver];
    // A body whose spin stays while it turns far may turn with more energy than before.
    const std::int32_t kept = root_of_share(turning_energy_of(start_motion_of(body)),
                                            turning_energy_of(motion_of(body, body.start)));
    LKS_ASSERT(kept >= 0 && kept <= 1 << k_share_bits);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      row.velocity[axis] = bounded(body.start.velocity[axis], k_row_bound) +
                           solver.gain[axis] * (std::int64_t{1} << 18);
      row.spin[axis] =
          product_rounded(bounded(body.start.spin[axis], k_row_bound), kept, k_share_bits) +
          solver.spin_gain[axis] * (std::int64_t{1} << 18);
    }
  }
  for (LinkedJoint& joint : system_.joints_of(cluster)) {
    joint.saved = joint.locks;
    joint.carried = joint.relaxed;
  }
  locks_.lock_speeds(run, cluster);
  for (LinkedJoint& joint : system_.joints_of(cluster)) {
    joint.locks = joint.saved;
    joint.relaxed = joint.carried;
  }
}

void EnergyAccount::settle(const JointRun& run, JointCluster& cluster) {
  if (!cluster.is_passive) return;
  cluster.energy = sum_over(system_, cluster, [&](const LinkedBody& body) {
    return energy_of(motion_of(body, run.rows[body.solver]));
  });
  LKS_ASSERT(cluster.energy >= -k_rounding_energy);
  cluster.knows_energy = true;
  const std::int64_t work = sum_over(system_, cluster, [&](const LinkedBody& body) {
    ProductSum twice;  // by half a substep's rate
    for (int i = 0; i < 3; ++i)
      twice.add(
          run.bodies[body.solver].gain[static_cast<std::size_t>(i)],
          (body.pose.position[i].raw - body.start_position[i].raw) * system_.step.substep_rate());
    return raw::saturating_add(twice.rounded(31), work_of_torque(run, body));
  });
  cluster.gained = raw::saturating_add(cluster.gained, raw::saturating_add(cluster.energy, -work));
  // Where little moves, at a turning point, the account stays as it came from faster ticks.
  const std::int64_t share = cluster.energy >> k_gain_shift;
  cluster.gained = std::max(cluster.gained, std::min(-share, cluster.first_gained));
  if (cluster.gained <= std::max(share, cluster.first_gained) + k_rounding_energy) return;
  cluster.knows_energy = false;
  returns_.fetch_add(1, std::memory_order_relaxed);
  begin_pushes(run, system_, system_.bodies_of(cluster));
  return_gain(run, cluster);
  cluster.gained = 0;
  end_pushes(run, system_, system_.bodies_of(cluster));
}

void EnergyAccount::return_gain(const JointRun& run, const JointCluster& cluster) {
  project_start(run, cluster);
  const std::span<const std::uint32_t> bodies = system_.bodies_of(cluster);
  for (const std::uint32_t index : bodies) {
    LinkedBody& body = system_.bodies[index];
    if (body.pushed) std::swap(body.saved_row, run.rows[body.solver]);
  }
  const EnergyPath path = energy_path(run, system_, cluster, &LinkedBody::saved_row);
  LKS_ASSERT(path.first >= -k_rounding_energy && path.square >= -k_rounding_energy);
  const std::int64_t allowed = raw::saturating_add(cluster.energy, -cluster.gained);
  if (path.first > allowed) {
    go_part(run, system_, cluster, &LinkedBody::saved_row, 0);
    // Rest fits all locks, so a share of any velocities that fit does.
    for (const std::uint32_t index : bodies)
      system_.bodies[index].saved_row = {};
    go_part(run, system_, cluster, &LinkedBody::saved_row, root_of_share(allowed, path.first));
  } else {
    go_part(run, system_, cluster, &LinkedBody::saved_row,
            greatest_share(path.square, path.linear, raw::saturating_add(allowed, -path.first)));
  }
}

}  // namespace lockstone
