// Which joints are solved together.

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/joint_solver.h"

namespace lockstone {
namespace {

// Locks of more loops say too much more than once to be solved for exactly: a bridge of planks on
// two ropes flew apart.
constexpr std::uint32_t k_most_loops = 2;

}  // namespace

std::span<const std::uint32_t> JointSolver::plan(std::uint32_t first_without_contacts) {
  for (Body& body : bodies_)
    body.touches = body.pushed && body.solver < first_without_contacts;
  link_bodies();
  find_pulled();
  factor_.clear();
  if (loops_ != nullptr) loops_->clear();
  groups_.clear();
  clusters_.clear();
  order_.clear();
  group_bodies_.clear();
  in_net_.clear();
  seen_.assign(links_.size(), 0);
  visited_.assign(bodies_.size(), 0);
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    if (bodies_[i].pushed && visited_[i] == 0) find_group(i);
  }
  for (std::uint32_t i = 0; i < links_.size(); ++i) {
    if (links_[i].joint == k_in_net) in_net_.push_back(i);
  }
  return in_net_;
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
    for (std::uint32_t i = 0; i < links_.size(); ++i) {
      if (bodies_[links_[i].a].pushed) f(bodies_[links_[i].a], i);
      if (bodies_[links_[i].b].pushed) f(bodies_[links_[i].b], i);
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

// Marks the bodies that joints pulled hard in the last tick: `resist_pull`.
void JointSolver::find_pulled() {
  pulls_.assign(bodies_.size(), 0);
  for (const Link& link : links_)
    add_pulls(link);
  for (std::uint32_t i = 0; i < bodies_.size(); ++i) {
    Body& body = bodies_[i];
    body.lever_inertia = lever_inertia(i);
    body.pulled = body.pushed && body.record->rotates() &&
                  2 * raw::round_divide(pulls_[i], step_.substep_rate()) > swung_inertia(body) / 8;
  }
}

// Finds all joints connected to a body, breadth first. Backwards, each joint of a tree comes after
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
      for (const std::uint32_t body : {links_[index].a, links_[index].b}) {
        if (visited_[body] != 0 || !bodies_[body].pushed) continue;
        visited_[body] = 1;
        group_bodies_.push_back(body);
      }
    }
  }
  group.count = static_cast<std::uint32_t>(order_.size()) - group.first;
  group.body_count = static_cast<std::uint32_t>(group_bodies_.size()) - group.first_body;
  if (group.count == 0) return;
  const auto first_group = static_cast<std::uint32_t>(groups_.size());
  plan_group(group);
  add_cluster(group, first_group);
}

// Makes the joints that are not in a net, by index.
void JointSolver::add_cluster(const Group& group, std::uint32_t first_group) {
  sorted_.clear();
  for (const std::uint32_t link : joints_of(group)) {
    if (links_[link].joint != k_in_net) sorted_.push_back(link);
  }
  if (sorted_.empty()) return;
  std::sort(sorted_.begin(), sorted_.end());
  const auto first_joint = static_cast<std::uint32_t>(joints_.size());
  for (const std::uint32_t link : sorted_)
    make_joint(links_[link]);
  for (std::uint32_t k = group.first; k < group.first + group.count; ++k)
    order_[k] = links_[order_[k]].joint;
  clusters_.push_back({first_joint, static_cast<std::uint32_t>(sorted_.size()), first_group,
                       static_cast<std::uint32_t>(groups_.size()) - first_group, group.first_body,
                       group.body_count});
}

void JointSolver::plan_group(Group group) {
  std::reverse(order_.begin() + group.first, order_.end());
  for (std::uint32_t k = 0; k < group.count; ++k)
    links_[order_[group.first + k]].order = k;
  const auto joint_at = [&](std::uint32_t k) -> const Link& {
    return links_[order_[group.first + k]];
  };
  const auto neighbours = [&](std::uint32_t k, const auto& emit) {
    for (const std::uint32_t body : {joint_at(k).a, joint_at(k).b}) {
      if (!bodies_[body].pushed) continue;
      for (const std::uint32_t other : joints_at(bodies_[body]))
        emit(links_[other].order);
    }
  };
  const auto rows = [&](std::uint32_t k) { return most_locks(*joint_at(k).record); };
  // The pushed bodies of a tree on the ground are as many as its joints.
  const bool has_few_loops = group.count <= group.body_count + k_most_loops;
  const bool needs_factor = has_loops(group) || has_motors(group) || is_pressed(group);
  if (loops_ != nullptr && needs_factor && plan_loops(group)) return groups_.push_back(group);
  if (has_few_loops && factor_.plan(group.count, neighbours, rows)) {
    group.exact = true;
    group.column = factor_.first();
    groups_.push_back(group);
    return;
  }
  plan_singles(group);
}

// Too much at once: balls to the net, and each other joint by itself, by index.
void JointSolver::plan_singles(const Group& group) {
  const auto begin = order_.begin() + group.first, end = begin + group.count;
  const auto rest = std::partition(begin, end, [&](std::uint32_t index) {
    Link& link = links_[index];
    link.order = 0;
    if (!fits_net(link)) return false;
    add_to_net(link);
    return true;
  });
  std::sort(rest, end);
  for (auto single = rest; single != end; ++single) {
    const auto rows = [&](std::uint32_t) { return most_locks(*links_[*single].record); };
    const bool planned = factor_.plan(
        1, [](std::uint32_t, const auto&) {}, rows);
    LKS_CHECK(planned);
    const auto place = static_cast<std::uint32_t>(single - order_.begin());
    Group& alone = groups_.emplace_back();
    alone.first = place;
    alone.count = 1;
    alone.column = factor_.first();
  }
}

// Balls that nothing limits or drives, between bodies that are pushed along every axis or stand
// still, on anchors within the range of their formats.
bool JointSolver::fits_net(const Link& link) const {
  const JointRecord& joint = *link.record;
  if (!is_point(joint)) return false;
  const auto fits = [&](const Body& body, const Vec3<Length>& anchor) {
    if (!body.pushed) return !body.record->moves();
    if ((body.record->locks & k_lock_moving) != 0) return false;
    const int shift = Length::frac_bits + body.record->scale_exponent;
    const std::int64_t bound = std::int64_t{1} << std::max(shift, 0);
    const auto inside = [&](Length x) { return x.raw <= bound && x.raw >= -bound; };
    return inside(anchor.x) && inside(anchor.y) && inside(anchor.z);
  };
  return fits(bodies_[link.a], joint.anchor_a) && fits(bodies_[link.b], joint.anchor_b);
}

void JointSolver::add_to_net(Link& link) {
  Body& a = bodies_[link.a];
  Body& b = bodies_[link.b];
  link.joint = k_in_net;
  a.in_net = b.in_net = true;
}

void JointSolver::make_joint(Link& link) {
  link.joint = static_cast<std::uint32_t>(joints_.size());
  Joint& joint = joints_.emplace_back();
  joint.record = link.record;
  const std::size_t rows = most_rows(*link.record);
  if (rows_.size() < row_count_ + rows) rows_.resize(row_count_ + rows);
  joint.rows.rows = std::span(rows_).subspan(row_count_, rows);
  row_count_ += rows;
  joint.frames = {to_matrix(link.record->orientation_a), to_matrix(link.record->orientation_b)};
  joint.a = link.a;
  joint.b = link.b;
  const BodyRecord& a = *bodies_[link.a].record;
  const BodyRecord& b = *bodies_[link.b].record;
  joint.inverse_mass = lockstone::add(a.inverse_mass_value(), b.inverse_mass_value());
  joint.exponent = angular_exponent(a, b);
  joint.lever_a = size_of(link.record->anchor_a);
  joint.lever_b = size_of(link.record->anchor_b);
  const auto share = [&](BlockFloat part) -> Share {
    if (part.mantissa == 0) return {};
    const int distance = joint.inverse_mass.exponent - part.exponent;
    if (distance > 60) return {};
    // Below 2^32: both mantissas lie in [2^30, 2^31).
    const std::int64_t mantissa =
        raw::round_divide(std::int64_t{part.mantissa} << 31, joint.inverse_mass.mantissa);
    LKS_ASSERT(mantissa >> 32 == 0);
    return {static_cast<std::uint32_t>(mantissa), 31 + distance};
  };
  joint.share_a = share(a.inverse_mass_value());
  joint.share_b = share(b.inverse_mass_value());
  set_drives(joint);
}

}  // namespace lockstone
