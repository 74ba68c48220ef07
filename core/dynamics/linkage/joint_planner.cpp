#include "core/dynamics/linkage/joint_planner.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/base/reserved.h"
#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/joint/joint_rows.h"
#include "core/dynamics/linkage/rows/joint_drives.h"
#include "core/dynamics/linkage/rows/pulled_links.h"

namespace lockstone {
namespace {

// Locks of more loops say too much more than once to be solved for exactly: a bridge of planks on
// two ropes flew apart.
constexpr std::uint32_t k_most_loops = 2;

// Whether the coloured balls can fasten a body at this anchor: one that is pushed along every axis
// with the anchor within the range of its format, or one that stands still.
bool fits_ball(const LinkedBody& body, const Vec3<Length>& anchor) {
  if (!body.pushed) return !body.record->moves();
  if ((body.record->locks & k_lock_moving) != 0) return false;
  const int shift = Length::frac_bits + body.record->scale_exponent;
  LKS_ASSERT(shift < 63);
  const std::int64_t bound = std::int64_t{1} << std::max(shift, 0);
  const auto inside = [&](Length x) { return x.raw <= bound && x.raw >= -bound; };
  return inside(anchor.x) && inside(anchor.y) && inside(anchor.z);
}

// Whether the tick before kept other impulses than those along the first three axes.
bool has_other_impulses(const JointRecord& joint) {
  std::int32_t any = 0;
  for (std::size_t axis = 0; axis < k_joint_axes; ++axis) {
    any |= joint.axes[axis].drive_impulse.raw;
    if (axis >= 3) any |= joint.axes[axis].impulse.raw;
  }
  return any != 0;
}

bool is_motor(const JointAxisRecord& axis) {
  return axis.is_driven() && !axis.is_spring();
}

}  // namespace

JointPlanner::JointPlanner(JointSystem& system, TreeLocks& trees, LoopLocks& loops,
                           std::size_t body_capacity, std::size_t joint_capacity)
    : system_(system), trees_(trees), loops_(loops) {
  seen_.reserve(joint_capacity);
  visited_.reserve(body_capacity);
  sorted_.reserve(joint_capacity);
  in_balls_.reserve(joint_capacity);
}

void JointPlanner::read(AddedJoint& joint) {
  LKS_ASSERT(joint.record->exists());
  LKS_ASSERT(joint.a < system_.bodies.size() && joint.b < system_.bodies.size());
  joint.is_driven = is_driven(*joint.record);
  joint.has_motor = joint.is_driven && std::ranges::any_of(joint.record->axes, is_motor);
  joint.fits_balls = !joint.is_driven && is_free_ball(*joint.record) &&
                     fits_ball(system_.bodies[joint.a], joint.record->anchor_a) &&
                     fits_ball(system_.bodies[joint.b], joint.record->anchor_b);
  joint.has_other_impulses = has_other_impulses(*joint.record);
  for (const std::uint32_t body : {joint.a, joint.b})
    if (system_.bodies[body].pushed) ++system_.bodies[body].joint_count;
  note_last_pull(system_, joint);
}

std::span<const std::uint32_t> JointPlanner::plan(std::uint32_t first_without_contacts) {
  link_bodies(first_without_contacts);
  find_pulled_links(system_);
  trees_.clear();
  loops_.clear();
  system_.groups.clear();
  system_.clusters.clear();
  system_.order.clear();
  system_.group_bodies.clear();
  in_balls_.clear();
  seen_.assign(system_.added.size(), 0);
  visited_.assign(system_.bodies.size(), 0);
  for (std::uint32_t i = 0; i < system_.bodies.size(); ++i) {
    if (system_.bodies[i].pushed && visited_[i] == 0) find_group(i);
  }
  for (std::uint32_t i = 0; i < system_.added.size(); ++i) {
    if (system_.added[i].joint == AddedJoint::k_in_balls) in_balls_.push_back(i);
  }
  LKS_ASSERT(system_.order.size() <= system_.added.size());
  LKS_ASSERT(system_.group_bodies.size() <= system_.bodies.size());
  return in_balls_;
}

// Lists the joints of each pushed body, by index. `read` has counted them.
void JointPlanner::link_bodies(std::uint32_t first_without_contacts) {
  std::vector<LinkedBody>& bodies = system_.bodies;
  std::uint32_t total = 0;
  for (LinkedBody& body : bodies) {
    body.touches = body.pushed && body.solver < first_without_contacts;
    body.first_joint = total;
    total += body.joint_count;
    body.joint_count = 0;
  }
  LKS_ASSERT(total <= 2 * system_.added.size());
  system_.by_body.resize(total);
  for (std::uint32_t i = 0; i < system_.added.size(); ++i) {
    for (const std::uint32_t index : {system_.added[i].a, system_.added[i].b}) {
      LinkedBody& body = bodies[index];
      if (body.pushed) system_.by_body[body.first_joint + body.joint_count++] = i;
    }
  }
}

// Finds all joints connected to a body, breadth first. Backwards, each joint of a tree comes after
// those beyond it, so that elimination fills nothing in.
void JointPlanner::find_group(std::uint32_t root) {
  std::vector<std::uint32_t>& bodies = system_.group_bodies;
  JointGroup group;
  group.first = static_cast<std::uint32_t>(system_.order.size());
  group.first_body = static_cast<std::uint32_t>(bodies.size());
  bodies.push_back(root);
  visited_[root] = 1;
  for (std::size_t i = group.first_body; i < bodies.size(); ++i) {
    for (const std::uint32_t index : system_.joints_at(system_.bodies[bodies[i]])) {
      if (seen_[index] != 0) continue;
      seen_[index] = 1;
      system_.order.push_back(index);
      for (const std::uint32_t body : {system_.added[index].a, system_.added[index].b}) {
        if (visited_[body] != 0 || !system_.bodies[body].pushed) continue;
        visited_[body] = 1;
        bodies.push_back(body);
      }
    }
  }
  group.count = static_cast<std::uint32_t>(system_.order.size()) - group.first;
  group.body_count = static_cast<std::uint32_t>(bodies.size()) - group.first_body;
  LKS_ASSERT(group.body_count <= group.count + 1);  // connected
  if (group.count == 0) return;
  const auto first_group = static_cast<std::uint32_t>(system_.groups.size());
  plan_group(group);
  add_cluster(group, first_group);
}

void JointPlanner::plan_group(JointGroup group) {
  // The pushed bodies of a tree on the ground are as many as its joints.
  const bool has_few_loops = group.count <= group.body_count + k_most_loops;
  if (!has_few_loops && !loops_.may_fit(group)) return plan_singles(group);
  std::reverse(system_.order.begin() + group.first, system_.order.end());
  const std::span<const std::uint32_t> joints = system_.joints_of(group);
  LKS_ASSERT(joints.size() == group.count && group.count <= AddedJoint::k_most_place);
  for (std::uint32_t k = 0; k < group.count; ++k)
    system_.added[joints[k]].place = k & AddedJoint::k_most_place;
  const bool needs_loops = has_loops(group) || has_motors(group) || is_pressed(group);
  if (needs_loops && loops_.plan(group)) return system_.groups.push_back(group);
  if (!has_few_loops || !trees_.plan(group)) return plan_singles(group);
  group.is_direct = true;
  system_.groups.push_back(group);
}

// Too many joints for one factor: balls become coloured balls, and each other joint is a group, by
// index.
void JointPlanner::plan_singles(const JointGroup& group) {
  std::vector<std::uint32_t>& order = system_.order;
  LKS_ASSERT(group.first + group.count <= order.size());
  const auto begin = order.begin() + group.first, end = begin + group.count;
  const auto rest = std::partition(begin, end, [&](std::uint32_t index) {
    AddedJoint& added = system_.added[index];
    added.place = 0;
    if (!added.fits_balls) return false;
    added.joint = AddedJoint::k_in_balls;
    system_.bodies[added.a].in_balls = system_.bodies[added.b].in_balls = true;
    return true;
  });
  std::sort(rest, end);
  for (auto single = rest; single != end; ++single) {
    JointGroup alone;
    alone.first = static_cast<std::uint32_t>(single - order.begin());
    alone.count = 1;
    trees_.plan_single(alone);
    system_.groups.push_back(alone);
  }
}

// Makes the joints that are not coloured balls, by index.
void JointPlanner::add_cluster(const JointGroup& group, std::uint32_t first_group) {
  sorted_.clear();
  for (const std::uint32_t index : system_.joints_of(group)) {
    if (system_.added[index].joint != AddedJoint::k_in_balls) sorted_.push_back(index);
  }
  if (sorted_.empty()) {
    for (const std::uint32_t body : system_.bodies_of(group))
      system_.bodies[body].only_balls = true;
    return;
  }
  std::sort(sorted_.begin(), sorted_.end());
  JointCluster cluster;
  cluster.first_joint = static_cast<std::uint32_t>(system_.joints.size());
  cluster.joint_count = static_cast<std::uint32_t>(sorted_.size());
  for (const std::uint32_t index : sorted_)
    make_joint(system_.added[index]);
  for (std::uint32_t& index : std::span(system_.order).subspan(group.first, group.count))
    index = system_.added[index].joint;
  cluster.first_group = first_group;
  cluster.group_count = static_cast<std::uint32_t>(system_.groups.size()) - first_group;
  cluster.first_body = group.first_body;
  cluster.body_count = group.body_count;
  LKS_ASSERT(cluster.group_count == 1 || cluster.group_count == cluster.joint_count);
  system_.clusters.push_back(cluster);
}

void JointPlanner::make_joint(AddedJoint& added) {
  added.joint = static_cast<std::uint32_t>(system_.joints.size());
  LKS_ASSERT(is_reserved(system_.joints, system_.joints.size() + 1));
  LinkedJoint& joint = system_.joints.emplace_back();
  joint.record = added.record;
  joint.a = added.a;
  joint.b = added.b;
  joint.rows.rows = system_.take_rows(most_rows(*added.record));
  joint.frames = frames_of(*joint.record, system_.step, system_.step.substeps);
  joint.turns_locks = turns_locks(*joint.record);
  set_masses(joint, system_.bodies[added.a], system_.bodies[added.b]);
  set_drives(system_, joint);
}

// A tree has as many joints as bodies that are pushed, or one less if no joint holds it to another
// body; loops may go through such a body.
bool JointPlanner::has_loops(const JointGroup& group) const {
  const auto hangs = [this](std::uint32_t index) {
    const AddedJoint& joint = system_.added[index];
    return !system_.bodies[joint.a].pushed || !system_.bodies[joint.b].pushed;
  };
  const bool is_hung = std::ranges::any_of(system_.joints_of(group), hangs);
  return group.count >= group.body_count + (is_hung ? 1 : 0);
}

// A motor pushes as well as locks do, and has a solution along with them.
bool JointPlanner::has_motors(const JointGroup& group) const {
  return std::ranges::any_of(system_.joints_of(group), [this](std::uint32_t index) {
    return system_.added[index].has_motor;
  });
}

// Whether contacts press links that are pulled hard. There locks that hold exactly turn errors of
// contacts into energy: ropes about posts flew apart.
bool JointPlanner::is_pressed(const JointGroup& group) const {
  bool touches = false, pulled = false;
  for (const std::uint32_t index : system_.bodies_of(group)) {
    touches = touches || system_.bodies[index].touches;
    pulled = pulled || system_.bodies[index].pulled;
  }
  return touches && pulled;
}

}  // namespace lockstone
