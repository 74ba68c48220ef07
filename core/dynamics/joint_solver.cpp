#include "core/dynamics/joint_solver.h"

#include <algorithm>

#include "core/dynamics/joint_numbers.h"

namespace lockstone {
namespace {

// Of solves for velocities.
constexpr int k_velocity_solves = 2;

// Of sweeps over drives and limits before positions move.
constexpr int k_sweeps = 2;

// Locks of more loops say too much more than once to be solved for exactly: a bridge of planks on
// two ropes flew apart.
constexpr std::uint32_t k_most_loops = 2;

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
  Joint& joint = joints_.emplace_back();
  joint.record = &record;
  joint.a = take_up(a);
  joint.b = take_up(b);
  const BlockFloat mass_a = a.record.inverse_mass_value(), mass_b = b.record.inverse_mass_value();
  joint.inverse_mass = lockstone::add(mass_a, mass_b);
  joint.exponent = angular_exponent(a.record, b.record);
  const auto share = [&](BlockFloat part) -> Share {
    if (part.mantissa == 0) return {};
    const int distance = joint.inverse_mass.exponent - part.exponent;
    if (distance > 60) return {};
    return {raw::round_divide(std::int64_t{part.mantissa} << 31, joint.inverse_mass.mantissa),
            31 + distance};
  };
  joint.share_a = share(mass_a);
  joint.share_b = share(mass_b);
  set_drives(joint);
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

std::uint32_t JointSolver::most_locks(const JointRecord& joint) {
  if (joint.kind >= static_cast<std::uint8_t>(JointKind::pulley) || joint.is(JointKind::distance)) {
    return 1;
  }
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < k_joint_axes; ++i) {
    const JointAxisRecord& axis = joint.axes[i];
    const bool rigid = joint.mode(i) == AxisMode::locked && !axis.is_spring();
    const bool closed = joint.mode(i) == AxisMode::limited && axis.lower == axis.upper;
    count += rigid || closed ? 1 : 0;
  }
  return count;
}

// The joints of each pushed body, by index.
void JointSolver::link_bodies() {
  for (Body& body : bodies_)
    body.joint_count = 0;
  const auto for_each_end = [&](auto&& f) {
    for (std::uint32_t i = 0; i < joints_.size(); ++i) {
      if (bodies_[joints_[i].a].pushed) f(bodies_[joints_[i].a], i);
      if (bodies_[joints_[i].b].pushed) f(bodies_[joints_[i].b], i);
    }
  };
  for_each_end([](Body& body, std::uint32_t) { ++body.joint_count; });
  std::uint32_t total = 0;
  for (Body& body : bodies_) {
    body.first_joint = total;
    total += body.joint_count;
    body.joint_count = 0;
  }
  by_body_.assign(total, 0);
  for_each_end([&](Body& body, std::uint32_t joint) {
    by_body_[body.first_joint + body.joint_count++] = joint;
  });
}

// All that hangs together with a body, breadth first. Backwards, each joint of a tree comes after
// those beyond it, so that elimination fills nothing in.
void JointSolver::find_group(std::uint32_t root) {
  Group group;
  group.first = static_cast<std::uint32_t>(order_.size());
  group.first_body = static_cast<std::uint32_t>(group_bodies_.size());
  group_bodies_.push_back(root);
  visited_[root] = 1;
  for (std::size_t i = group.first_body; i < group_bodies_.size(); ++i) {
    for (const std::uint32_t index : joints_at(bodies_[group_bodies_[i]])) {
      if (seen_[index] != 0) continue;
      seen_[index] = 1;
      order_.push_back(index);
      for (const std::uint32_t body : {joints_[index].a, joints_[index].b}) {
        if (visited_[body] != 0 || !bodies_[body].pushed) continue;
        visited_[body] = 1;
        group_bodies_.push_back(body);
      }
    }
  }
  group.count = static_cast<std::uint32_t>(order_.size()) - group.first;
  group.body_count = static_cast<std::uint32_t>(group_bodies_.size()) - group.first_body;
  if (group.count > 0) plan_group(group);
}

void JointSolver::plan_group(Group group) {
  std::reverse(order_.begin() + group.first, order_.end());
  for (std::uint32_t k = 0; k < group.count; ++k)
    joints_[order_[group.first + k]].order = k;
  const auto joint_at = [&](std::uint32_t k) -> const Joint& {
    return joints_[order_[group.first + k]];
  };
  const auto neighbours = [&](std::uint32_t k, const auto& emit) {
    for (const std::uint32_t body : {joint_at(k).a, joint_at(k).b}) {
      if (!bodies_[body].pushed) continue;
      for (const std::uint32_t other : joints_at(bodies_[body]))
        emit(joints_[other].order);
    }
  };
  const auto rows = [&](std::uint32_t k) { return most_locks(*joint_at(k).record); };
  // The pushed bodies of a tree on the ground are as many as its joints.
  const bool has_few_loops = group.count <= group.body_count + k_most_loops;
  if (has_few_loops && factor_.plan(group.count, neighbours, rows)) {
    group.exact = true;
    group.column = factor_.first();
    groups_.push_back(group);
    return;
  }
  // Too much at once: each joint by itself, by index.
  std::sort(order_.begin() + group.first, order_.end());
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const auto only = [&](std::uint32_t) { return most_locks(*joint_at(k).record); };
    const bool planned = factor_.plan(
        1, [](std::uint32_t, const auto&) {}, only);
    LKS_CHECK(planned);
    joints_[order_[group.first + k]].order = 0;
    groups_.push_back({group.first + k, 1, 0, 0, factor_.first(), false, false, 0});
  }
}

void JointSolver::begin(const JointRun& run, std::uint32_t first_without_contacts) {
  for (Body& body : bodies_)
    body.centred = body.pushed && body.solver >= first_without_contacts;
  for (Joint& joint : joints_)
    load_impulses(joint);
  set_inertias(run, true);
}

void JointSolver::prepare() {
  link_bodies();
  factor_.clear();
  groups_.clear();
  order_.clear();
  group_bodies_.clear();
  seen_.assign(joints_.size(), 0);
  visited_.assign(bodies_.size(), 0);
  after_.resize(bodies_.size());
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    after_[i] = bodies_[i].pose;
    if (bodies_[i].pushed && visited_[i] == 0) find_group(i);
  }
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
  const Joint& joint = joints_[added];
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
