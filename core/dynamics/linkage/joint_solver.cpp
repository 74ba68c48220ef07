#include "core/dynamics/linkage/joint_solver.h"

#include <algorithm>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

// Of iterations over drives and limits before positions move.
constexpr int k_sweeps = 2;

}  // namespace

JointSolver::JointSolver(const TimeStep& step, std::size_t body_capacity,
                         std::size_t joint_capacity, bool solves_loops)
    : step_(step), place_(body_capacity), factor_(joint_capacity) {
  const std::size_t bodies = std::min(body_capacity, 2 * joint_capacity);
  if (solves_loops) loops_ = std::make_unique<ProximalLocks>(bodies, joint_capacity);
  bodies_.reserve(bodies);
  placed_.reserve(bodies);
  group_bodies_.reserve(bodies);
  visited_.reserve(bodies);
  after_.reserve(bodies);
  pulls_.reserve(bodies);
  links_.reserve(joint_capacity);
  in_net_.reserve(joint_capacity);
  joints_.reserve(joint_capacity);
  rows_.reserve(k_max_joint_rows * joint_capacity);
  by_body_.reserve(2 * joint_capacity);
  order_.reserve(joint_capacity);
  seen_.reserve(joint_capacity);
  sorted_.reserve(joint_capacity);
  clusters_.reserve(joint_capacity);
  groups_.reserve(joint_capacity);
}

void JointSolver::clear() {
  for (const std::uint32_t body : placed_)
    place_[body] = 0;
  placed_.clear();
  bodies_.clear();
  links_.clear();
  joints_.clear();
  row_count_ = 0;
  clamps_ = 0;
  energy_limits_ = 0;
}

std::uint32_t JointSolver::take_up(const Side& side) {
  std::uint32_t& place = place_[side.body];
  if (place != 0) return place - 1;
  placed_.push_back(side.body);
  place = static_cast<std::uint32_t>(placed_.size());
  Body body;
  body.record = &side.record;
  body.pose = {side.record.position, side.record.orientation, side.rotation};
  set_principal(body);
  body.inverse_inertia = inverse_inertia_of(body, side.rotation);
  body.solver = side.solver;
  body.scale = side.record.scale_exponent;
  body.pushed = side.solver != 0 && side.record.is_dynamic();
  bodies_.push_back(body);
  return place - 1;
}

void JointSolver::add(const JointRecord& record, const Side& a, const Side& b) {
  Link& link = links_.emplace_back();
  link.record = &record;
  link.a = take_up(a);
  link.b = take_up(b);
}

void JointSolver::load_impulses(Joint& joint, int shift) const {
  for (std::size_t i = 0; i < k_joint_axes; ++i) {
    joint.locks[i] = std::int64_t{joint.record->axes[i].impulse.raw} * (1 << shift);
    joint.relaxed[i] = 0;
    joint.driven[i] = std::int64_t{joint.record->axes[i].drive_impulse.raw} * (1 << 30);
    if (joint.drives[i].is_spring())
      joint.driven[i] = product_rounded(joint.driven[i], joint.drives[i].before.share, 30);
  }
}

void JointSolver::begin(const JointRun& run) {
  const RoundDivisor rate(step_.substep_rate());
  for (Body& body : bodies_) {
    body.centred = body.pushed && !body.in_net && !body.touches && !body.is_among_contacts;
    body.rate = rate;
  }
  for (Group& group : groups_)
    group.rate = step_.substep_rate();
  // Where gravity acts half before and half after positions move, so do locks.
  const auto is_centred = [](const Body& body) { return !body.pushed || body.centred; };
  for (Joint& joint : joints_)
    load_impulses(joint, is_centred(bodies_[joint.a]) && is_centred(bodies_[joint.b]) ? 29 : 30);
  pulls_.assign(bodies_.size(), 0);
  add_pulls(joints_, false);
  for (const std::uint32_t link : in_net_)
    add_pulls(links_[link]);
  for (std::uint32_t body = 0; body < bodies_.size(); ++body) {
    resist_pull(run, body);
  }
  after_.resize(bodies_.size());
  // Poses after the substep: bodies that nothing pushes have a known motion.
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    after_[i] = bodies_[i].pushed ? bodies_[i].pose : pose_after(run, bodies_[i]);
  for (Cluster& cluster : clusters_) {
    for (Group& group : groups_of(cluster))
      group.is_plain = std::ranges::all_of(joints_of(cluster), is_plain);
    cluster.free = can_drift(cluster);
    if (cluster.free) groups_of(cluster)[0].drifts = true;
    for (const std::uint32_t body : bodies_of(cluster))
      bodies_[body].free = cluster.free;
  }
}

void JointSolver::prepare(const JointRun& run, std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    linearize(clusters_[i]);
    for (Group& group : groups_of(clusters_[i]))
      group.turns_fast = false;
    for (Joint& joint : joints_of(clusters_[i]))
      leave_out_far(run, joint);
    if (clusters_[i].free) drift(run, clusters_[i]);
    open_account(clusters_[i]);
  }
}

void JointSolver::warm_start(const JointRun& run, std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    Cluster& cluster = clusters_[i];
    const bool is_last = ++cluster.substep == step_.substeps;
    if (cluster.free) set_rate(cluster, std::int64_t{step_.substep_rate()} * (is_last ? 2 : 1));
    begin_account(run, cluster);
    begin_pushes(run, cluster);
    forget_impulses(cluster);
    for (Joint& joint : joints_of(cluster))
      warm_start(run, joint);
    limit_warm_start(run, cluster);
    end_pushes(run, bodies_of(cluster));
  }
}

void JointSolver::warm_start(const JointRun& run, Joint& joint) {
  RowImpulses impulses;
  joint.carried = joint.relaxed;
  for (std::size_t i = 0; i < joint.rows.count; ++i) {
    const JointRow& row = joint.rows.rows[i];
    if (row.kind == RowKind::drive) {
      impulses[i] = joint.driven[row.axis];
      continue;
    }
    std::int64_t& impulse = joint.locks[row.axis];
    joint.relaxed[row.axis] = 0;
    if (row.kind == RowKind::limit && (row.flipped ? impulse > 0 : impulse < 0)) impulse = 0;
    impulses[i] = row.flipped ? -impulse : impulse;
  }
  std::size_t end = joint.rows.count;
  while (end > 0 && impulses[end - 1] == 0)
    --end;
  if (end > 0) push(run, joint, 0, std::max(end, joint.rows.locks), impulses);
}

void JointSolver::solve(const JointRun& run, std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    begin_pushes(run, clusters_[i]);
    solve(run, clusters_[i]);
    end_pushes(run, bodies_of(clusters_[i]));
  }
}

void JointSolver::solve(const JointRun& run, const Cluster& cluster) {
  bool exact = false;  // and locked as the last iteration left it
  const bool motors = !has_solved_loops(groups_of(cluster)[0]);
  for (int i = 0; i < k_sweeps; ++i) {
    bool pushed = false;
    for (Joint& joint : joints_of(cluster)) {
      pushed = solve_drives(run, joint, motors) || pushed;
      pushed = solve_limits(run, joint, true) || pushed;
    }
    if (exact && !pushed) return;
    for (Group& group : groups_of(cluster)) {
      exact = group.exact;
      if (!group.exact) {
        set_speed_errors(run, group, true);
        solve_locks(run, group, true);
      } else if (pushed && i + 1 < k_sweeps && !is_stiff(group)) {
        exact = false;
        look_ahead(run, group, false);
        if (set_position_errors(group) > 0) solve_locks(run, group, true);
      } else {
        solve_positions(run, cluster, group);
      }
    }
  }
}

void JointSolver::relax(const JointRun& run, std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    relax(run, clusters_[i]);
    settle_account(run, clusters_[i]);
  }
}

void JointSolver::relax(const JointRun& run, const Cluster& cluster) {
  for (const std::uint32_t body : bodies_of(cluster))
    pulls_[body] = 0;
  add_pulls(joints_of(cluster), cluster.free);
  for (const std::uint32_t body : bodies_of(cluster)) {
    if (bodies_[body].centred && !cluster.free) resist_pull(run, body);
  }
  linearize(cluster);
  begin_pushes(run, cluster);
  for (Joint& joint : joints_of(cluster))
    solve_springs_later(run, joint);
  hold_speeds(run, cluster);
  end_pushes(run, bodies_of(cluster));
}

void JointSolver::store(std::size_t added, JointRecord& record) const {
  if (links_[added].joint == k_in_net) return;
  const Joint& joint = joints_[links_[added].joint];
  const bool free = bodies_[joint.a].free || bodies_[joint.b].free;
  const auto to_record = [](std::int64_t impulse) {
    return SolverVelocity::from_raw(raw::saturate<std::int32_t>(raw::round_shift(impulse, 30)));
  };
  for (std::size_t i = 0; i < k_joint_axes; ++i) {
    record.axes[i].impulse = {};
    record.axes[i].drive_impulse = {};
  }
  for (std::size_t i = 0; i < joint.rows.count; ++i) {
    const JointRow& row = joint.rows.rows[i];
    if (row.kind == RowKind::drive) {
      record.axes[row.axis].drive_impulse =
          to_record(joint.driven[row.axis] + joint.driven_later[row.axis]);
    } else {
      record.axes[row.axis].impulse = to_record(bounded(
          joint.locks[row.axis] + joint.relaxed[row.axis] + (free ? joint.carried[row.axis] : 0),
          k_product_bound));
    }
  }
}

IslandJoint JointSolver::island_joint(std::uint32_t index) const {
  const Joint& joint = joints_[index];
  const auto number = [this](std::uint32_t body) {
    return bodies_[body].pushed ? bodies_[body].solver : 0;
  };
  const BlockFloat inverse_a = bodies_[joint.a].record->inverse_mass_value(),
                   inverse_b = bodies_[joint.b].record->inverse_mass_value();
  IslandJoint result;
  result.joint = index;
  result.a = number(joint.a);
  result.b = number(joint.b);
  if (result.a != 0) result.part_a = part_of(ratio(inverse_a, inverse_b).raw);
  if (result.b != 0) result.part_b = part_of(ratio(inverse_b, inverse_a).raw);
  result.inverse_mass = joint.inverse_mass;
  return result;
}

void JointSolver::put_among_contacts(std::uint32_t joint) {
  bodies_[joints_[joint].a].is_among_contacts = true;
  bodies_[joints_[joint].b].is_among_contacts = true;
}

std::int64_t JointSolver::limit_impulse(std::uint32_t index, std::size_t row) const {
  const Joint& joint = joints_[index];
  const JointRow& limit = joint.rows.rows[row];
  const std::int64_t stored = joint.locks[limit.axis];
  return std::max<std::int64_t>(limit.flipped ? -stored : stored, 0);
}

void JointSolver::give(const JointRun& run, std::uint32_t index, const RowImpulses& impulses) {
  Joint& joint = joints_[index];
  std::size_t end = 0;
  for (std::size_t i = 0; i < joint.rows.count; ++i) {
    if (impulses[i] == 0) continue;
    const JointRow& row = joint.rows.rows[i];
    std::int64_t& total = joint.locks[row.axis];
    total = bounded(total + (row.flipped ? -impulses[i] : impulses[i]), k_product_bound);
    end = std::max(i + 1, joint.rows.locks);
  }
  if (end == 0) return;
  const std::array<std::uint32_t, 2> ends = {joint.a, joint.b};
  for (const std::uint32_t body : ends)
    bodies_[body].unpushed = run.rows[bodies_[body].solver];
  push(run, joint, 0, end, impulses);
  end_pushes(run, ends);
}

const JointPose* JointSolver::find(std::uint32_t body) const {
  const std::uint32_t place = place_[body];
  return place == 0 ? nullptr : &bodies_[place - 1].pose;
}

}  // namespace lockstone
