// Locks and limits do no work, so a cluster of joints that nothing else drives has no more energy
// than gravity and forces give it. Where links turn faster than the substep resolves, a step may
// still give it some. Each tick keeps an account of that for each cluster: once the gain exceeds a
// part of its energy, the velocities go towards those of a step without positional correction,
// which is a projection in the metric of the masses and so gains nothing, as far as it takes to
// return the gain.

#include <algorithm>
#include <utility>

#include "core/dynamics/body/energy.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/joint_solver.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

// In a tick a cluster may gain 2^-this of its kinetic energy: where steps hold the joints, whose
// errors come and go, and where they do not.
constexpr int k_free_gain_shift = 6, k_rough_gain_shift = 10;

// Less than this, twice for each mass, is rounding: (0.1 mm/s)², Q32.
constexpr std::int64_t k_least_gain = 43;

// To close locks, positions may move with so much more energy than bodies have, twice by the
// heaviest body's mass: (0.5 m/s)², Q32.
constexpr std::int64_t k_closing_energy = std::int64_t{1} << 30;

Velocity to_velocity(std::int64_t x) {
  return Velocity::from_raw(raw::round_shift(bounded(x, k_row_bound), 18));
}

std::int64_t product_of(const JointMotion& a, const JointMotion& b) {
  return energy_product(a.velocity, b.velocity, a.spin, b.surface);
}

std::int64_t turning_of(const JointMotion& motion) {
  return energy_product({}, {}, motion.spin, motion.surface);
}

}  // namespace

// Of a row. A body may be taken to be heavier to turn.
JointMotion JointSolver::motion_of(const Body& body, const lanes::RowBody& row) {
  JointMotion motion;
  for (int i = 0; i < 3; ++i) {
    motion.velocity[i] = to_velocity(row.velocity[static_cast<std::size_t>(i)]);
    motion.spin[i] = to_velocity(row.spin[static_cast<std::size_t>(i)]);
  }
  motion.surface = surface_velocity(body.inverse_inertia, motion.spin);
  if (body.least_inertia != 0)
    motion.spin = spin_of(*body.record, body.pose.rotation, motion.surface);
  return motion;
}

Vec3<Velocity> JointSolver::own_spin(std::uint32_t index, const Vec3<Velocity>& spin,
                                     const Vec3<Velocity>& surface) const {
  const std::uint32_t place = place_[index];
  if (place == 0 || bodies_[place - 1].least_inertia == 0) return spin;
  const Body& body = bodies_[place - 1];
  return spin_of(*body.record, body.pose.rotation, surface);
}

// Of masses as parts of the heaviest body's.
template <class Each>
std::int64_t JointSolver::sum_over(const Cluster& cluster, const Each& each) const {
  std::int64_t sum = 0;
  for (const std::uint32_t index : bodies_of(cluster)) {
    const Body& body = bodies_[index];
    if (!body.pushed) continue;
    sum = raw::saturating_add(sum, scale_saturating(each(body), body.mass, 0));
  }
  return sum;
}

// At the beginning of a tick: whether anything but gravity and forces drives a cluster, and its
// heaviest body.
void JointSolver::open_account(Cluster& cluster) {
  const auto stands = [&](std::uint32_t index) {
    return bodies_[index].pushed || bodies_[index].solver == 0;
  };
  const auto may_be_pushed = [&](std::uint32_t index) {
    const Body& body = bodies_[index];
    return body.touches || body.is_among_contacts || body.in_net;
  };
  cluster.gained = 0;
  for (Group& group : groups_of(cluster))
    group.is_rough = false;
  cluster.is_driven = std::ranges::any_of(joints_of(cluster), [](const Joint& joint) {
    return std::ranges::any_of(joint.record->axes, &JointAxisRecord::is_driven);
  });
  cluster.is_passive = !cluster.free && !cluster.is_driven &&
                       std::ranges::none_of(bodies_of(cluster), may_be_pushed) &&
                       std::ranges::all_of(joints_of(cluster), [&](const Joint& joint) {
                         return stands(joint.a) && stands(joint.b);
                       });
  cluster.unit = {};
  for (const std::uint32_t index : bodies_of(cluster)) {
    const BlockFloat inverse = bodies_[index].record->inverse_mass_value();
    if (!bodies_[index].pushed) continue;
    const bool is_heavier = ratio(inverse, cluster.unit) < Unit::from_raw(1 << 29);
    if (cluster.unit == BlockFloat{} || is_heavier) cluster.unit = inverse;
  }
  for (const std::uint32_t index : bodies_of(cluster)) {
    Body& body = bodies_[index];
    if (body.pushed) body.mass = quotient(cluster.unit, body.record->inverse_mass_value());
  }
  cluster.knows_energy = false;
}

// At the beginning of a substep.
void JointSolver::begin_account(const JointRun& run, Cluster& cluster) {
  if (!cluster.is_passive) return;
  for (const std::uint32_t index : bodies_of(cluster)) {
    Body& body = bodies_[index];
    if (!body.pushed) continue;
    body.start = run.before[body.solver];
    body.start_position = body.pose.position;
    body.start_turning = turning_of(motion_of(body, body.start));
  }
  if (!cluster.knows_energy)
    cluster.energy = sum_over(cluster, [&](const Body& body) {
      const JointMotion motion = motion_of(body, body.start);
      return product_of(motion, motion);
    });
  cluster.gained = raw::saturating_add(cluster.gained, -cluster.energy);
}

// The bodies' velocities go from `from` towards the present ones, by a share.
void JointSolver::go_part(const JointRun& run, const Cluster& cluster,
                          const lanes::RowBody Body::*from, std::int32_t share) {
  for (const std::uint32_t index : bodies_of(cluster)) {
    const Body& body = bodies_[index];
    if (!body.pushed) continue;
    lanes::RowBody& row = run.rows[body.solver];
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

// After the impulses of the last substep, which may suit this one badly: after a blow, or where
// links turn fast. If they give much energy, less of them is repeated: the share that leaves the
// least.
void JointSolver::limit_warm_start(const JointRun& run, const Cluster& cluster) {
  const Group& group = groups_of(cluster)[0];
  if (!group.exact || has_solved_loops(group) || cluster.is_driven) return;
  const auto [energy, linear, square] = energies_between(run, cluster, &Body::unpushed);
  if (raw::saturating_add(square, linear) <= energy / 4 + k_least_gain) return;
  const std::int32_t share = share_of(-(linear / 2), square);
  go_part(run, cluster, &Body::unpushed, share);
  for (Joint& joint : joints_of(cluster))
    for (std::int64_t& impulse : joint.locks)
      impulse = product_rounded(impulse, share, k_share_bits);
}

// The velocities without positional correction: the substep's first ones, with the gain of gravity
// and forces, such that locks and limits do not open where the bodies are now.
void JointSolver::project_start(const JointRun& run, const Cluster& cluster) {
  for (const std::uint32_t index : bodies_of(cluster)) {
    Body& body = bodies_[index];
    if (!body.pushed) continue;
    lanes::RowBody& row = run.rows[body.solver];
    body.saved_row = row;
    const SolverBody& solver = run.bodies[body.solver];
    // A body whose spin stays while it turns far may turn with more energy than before.
    const std::int32_t kept =
        root_of_share(body.start_turning, turning_of(motion_of(body, body.start)));
    for (std::size_t axis = 0; axis < 3; ++axis) {
      row.velocity[axis] = bounded(body.start.velocity[axis], k_row_bound) +
                           solver.gain[axis] * (std::int64_t{1} << 18);
      row.spin[axis] =
          product_rounded(bounded(body.start.spin[axis], k_row_bound), kept, k_share_bits) +
          solver.spin_gain[axis] * (std::int64_t{1} << 18);
    }
  }
  for (Joint& joint : joints_of(cluster)) {
    joint.saved = joint.locks;
    joint.carried = joint.relaxed;
  }
  hold_speeds(run, cluster);
  for (Joint& joint : joints_of(cluster)) {
    joint.locks = joint.saved;
    joint.relaxed = joint.carried;
  }
}

// Twice the energies by the heaviest body's mass: with velocities `from`, and by how much a share s
// of the way from there to the present ones changes it, s²·square + s·linear.
JointSolver::Energies JointSolver::energies_between(const JointRun& run, const Cluster& cluster,
                                                    const lanes::RowBody Body::*from) const {
  Energies sums;
  for (const std::uint32_t index : bodies_of(cluster)) {
    const Body& body = bodies_[index];
    if (!body.pushed) continue;
    const JointMotion first = motion_of(body, body.*from),
                      now = motion_of(body, run.rows[body.solver]);
    const JointMotion way{now.velocity - first.velocity, now.surface - first.surface,
                          now.spin - first.spin};
    const auto add = [&](std::int64_t& sum, const JointMotion& a, const JointMotion& b) {
      sum = raw::saturating_add(sum, scale_saturating(product_of(a, b), body.mass, 0));
    };
    add(sums.first, first, first);
    add(sums.linear, first, way);
    add(sums.square, way, way);
  }
  sums.linear = raw::saturating_add(sums.linear, sums.linear);
  return sums;
}

// Whether the velocities that are about to move positions have much more energy than those before,
// which `saved_row` has.
bool JointSolver::closes_too_fast(const JointRun& run, const Cluster& cluster) const {
  const Energies between = energies_between(run, cluster, &Body::saved_row);
  return raw::saturating_add(between.square, between.linear) >
         between.first / 16 + k_closing_energy;
}

// The same velocities: as much of their difference to those before as that energy allows.
void JointSolver::limit_closing(const JointRun& run, const Cluster& cluster) {
  const Energies between = energies_between(run, cluster, &Body::saved_row);
  if (raw::saturating_add(between.square, between.linear) <= k_closing_energy) return;
  const std::int32_t share = greatest_share(between.square, between.linear, k_closing_energy);
  go_part(run, cluster, &Body::saved_row, share);
  for (Joint& joint : joints_of(cluster)) {
    for (std::size_t i = 0; i < k_joint_axes; ++i) {
      const std::int64_t closing = bounded(joint.locks[i] - joint.saved[i], k_product_bound);
      joint.locks[i] = joint.saved[i] + product_rounded(closing, share, k_share_bits);
    }
  }
}

// After a substep: the cluster returns its gain of the tick, if that is more than it may keep.
void JointSolver::settle_account(const JointRun& run, Cluster& cluster) {
  if (!cluster.is_passive) return;
  cluster.energy = sum_over(cluster, [&](const Body& body) {
    const JointMotion motion = motion_of(body, run.rows[body.solver]);
    return product_of(motion, motion);
  });
  cluster.knows_energy = true;
  const std::int64_t energy = cluster.energy;
  const std::int64_t work = sum_over(cluster, [&](const Body& body) {
    ProductSum twice;  // by half a substep's rate
    for (int i = 0; i < 3; ++i)
      twice.add(run.bodies[body.solver].gain[static_cast<std::size_t>(i)],
                (body.pose.position[i].raw - body.start_position[i].raw) * step_.substep_rate());
    return twice.rounded(31);
  });
  cluster.gained = raw::saturating_add(cluster.gained, raw::saturating_add(energy, -work));
  const bool is_rough = std::ranges::any_of(
      groups_of(cluster), [&](const Group& group) { return group.is_rough || is_stiff(group); });
  const int shift = is_rough ? k_rough_gain_shift : k_free_gain_shift;
  if (cluster.gained <= (energy >> shift) + k_least_gain) return;
  cluster.knows_energy = false;
  energy_limits_.fetch_add(1, std::memory_order_relaxed);
  begin_pushes(run, cluster);
  project_start(run, cluster);
  for (const std::uint32_t index : bodies_of(cluster))
    if (bodies_[index].pushed) std::swap(bodies_[index].saved_row, run.rows[bodies_[index].solver]);
  const Energies between = energies_between(run, cluster, &Body::saved_row);
  const std::int64_t allowed = raw::saturating_add(energy, -cluster.gained);
  if (between.first > allowed) {
    go_part(run, cluster, &Body::saved_row, 0);
    // Rest fits all locks, so a share of any velocities that fit does.
    for (const std::uint32_t index : bodies_of(cluster))
      bodies_[index].saved_row = {};
    go_part(run, cluster, &Body::saved_row, root_of_share(allowed, between.first));
  } else {
    go_part(run, cluster, &Body::saved_row,
            greatest_share(between.square, between.linear,
                           raw::saturating_add(allowed, -between.first)));
  }
  cluster.gained = 0;
  end_pushes(run, bodies_of(cluster));
}

}  // namespace lockstone
