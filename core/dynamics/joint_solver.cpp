#include "core/dynamics/joint_solver.h"

#include <algorithm>

#include "core/dynamics/joint_numbers.h"

namespace lockstone {
namespace {

// Of solves for velocities.
constexpr int k_velocity_solves = 2;

// Of sweeps over drives and limits before positions move.
constexpr int k_sweeps = 2;

}  // namespace

JointSolver::JointSolver(const TimeStep& step, std::size_t body_capacity,
                         std::size_t joint_capacity)
    : step_(step), place_(body_capacity), factor_(joint_capacity) {
  const std::size_t bodies = std::min(body_capacity, 2 * joint_capacity);
  bodies_.reserve(bodies);
  placed_.reserve(bodies);
  group_bodies_.reserve(bodies);
  visited_.reserve(bodies);
  after_.reserve(bodies);
  pulls_.reserve(bodies);
  links_.reserve(joint_capacity);
  in_net_.reserve(joint_capacity);
  joints_.reserve(joint_capacity);
  by_body_.reserve(2 * joint_capacity);
  order_.reserve(joint_capacity);
  seen_.reserve(joint_capacity);
  groups_.reserve(joint_capacity);
}

void JointSolver::clear() {
  for (const std::uint32_t body : placed_)
    place_[body] = 0;
  placed_.clear();
  bodies_.clear();
  links_.clear();
  joints_.clear();
  clamps_ = 0;
}

std::uint32_t JointSolver::take_up(const Side& side) {
  std::uint32_t& place = place_[side.body];
  if (place != 0) return place - 1;
  placed_.push_back(side.body);
  place = static_cast<std::uint32_t>(placed_.size());
  Body body;
  body.record = &side.record;
  body.pose = {side.record.position, side.record.orientation, side.rotation};
  body.inverse_inertia = inverse_inertia(side.record, side.rotation);
  body.solver = side.solver;
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

// Where gravity acts half before and half after positions move, so do locks.
void JointSolver::load_impulses(Joint& joint) const {
  const auto is_centred = [](const Body& body) { return !body.pushed || body.centred; };
  const int shift = is_centred(bodies_[joint.a]) && is_centred(bodies_[joint.b]) ? 29 : 30;
  for (std::size_t i = 0; i < k_joint_axes; ++i) {
    joint.locks[i] = std::int64_t{joint.record->axes[i].impulse.raw} * (1 << shift);
    joint.relaxed[i] = 0;
    joint.driven[i] = std::int64_t{joint.record->axes[i].drive_impulse.raw} * (1 << 30);
  }
}

void JointSolver::begin(const JointRun& run, std::uint32_t first_without_contacts) {
  for (Body& body : bodies_)
    body.centred = body.pushed && !body.in_net && body.solver >= first_without_contacts;
  for (Joint& joint : joints_)
    load_impulses(joint);
  set_inertias(run, true);
}

void JointSolver::prepare() {
  after_.resize(bodies_.size());
  for (std::size_t i = 0; i < bodies_.size(); ++i)
    after_[i] = bodies_[i].pose;
  linearize();
}

void JointSolver::warm_start(const JointRun& run) {
  for (Joint& joint : joints_) {
    for (std::size_t i = 0; i < joint.rows.count; ++i) {
      const JointRow& row = joint.rows.rows[i];
      if (row.kind == RowKind::drive) {
        push(run, joint, row, joint.driven[row.axis]);
        continue;
      }
      std::int64_t& impulse = joint.locks[row.axis];
      joint.relaxed[row.axis] = 0;
      if (row.kind == RowKind::limit && (row.flipped ? impulse > 0 : impulse < 0)) impulse = 0;
      push(run, joint, row, row.flipped ? -impulse : impulse);
    }
  }
}

void JointSolver::solve(const JointRun& run) {
  for (int i = 0; i < k_sweeps; ++i) {
    for (Joint& joint : joints_) {
      solve_drives(run, joint);
      solve_limits(run, joint, true);
    }
    for (Group& group : groups_) {
      if (!group.exact) {
        set_speed_errors(run, group, true);
        solve_locks(run, group, true);
      } else if (i == 0 || !group.is_plain) {
        solve_positions(run, group);
      }
    }
  }
}

void JointSolver::relax(const JointRun& run) {
  set_inertias(run, false);
  linearize();
  for (int i = 0; i < k_velocity_solves; ++i) {
    for (Joint& joint : joints_)
      solve_limits(run, joint, false);
    for (Group& group : groups_) {
      set_speed_errors(run, group, false);
      solve_locks(run, group, false);
    }
  }
}

void JointSolver::store(std::size_t added, JointRecord& record) const {
  if (links_[added].joint == k_in_net) return;
  const Joint& joint = joints_[links_[added].joint];
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
      record.axes[row.axis].drive_impulse = to_record(joint.driven[row.axis]);
    } else {
      record.axes[row.axis].impulse =
          to_record(bounded(joint.locks[row.axis] + joint.relaxed[row.axis], k_product_bound));
    }
  }
}

const JointPose* JointSolver::find(std::uint32_t body) const {
  const std::uint32_t place = place_[body];
  return place == 0 ? nullptr : &bodies_[place - 1].pose;
}

}  // namespace lockstone
