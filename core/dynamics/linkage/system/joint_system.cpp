#include "core/dynamics/linkage/system/joint_system.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone {
namespace {

// With fewer joints than this, loading ahead saved no time: other caches are near enough.
constexpr std::size_t k_cached_joints = 1024;

// Into the cache of the second level: there is room for several clusters.
void prefetch_bytes(const void* from, const void* end) {
#if defined(__GNUC__) && !defined(__wasm__)  // WebAssembly has no such instruction
  constexpr int k_writes = 1, k_second_level = 2;
  for (const auto* at = static_cast<const char*>(from); at < end; at += 64)
    __builtin_prefetch(at, k_writes, k_second_level);
#else
  (void)from, (void)end;
#endif
}

}  // namespace

JointSystem::JointSystem(const TimeStep& time_step, std::size_t body_capacity,
                         std::size_t joint_capacity)
    : step(time_step) {
  bodies.reserve(body_capacity);
  added.reserve(joint_capacity);
  joints.reserve(joint_capacity);
  by_body.reserve(2 * joint_capacity);
  order.reserve(joint_capacity);
  group_bodies.reserve(body_capacity);
  groups.reserve(joint_capacity);
  clusters.reserve(joint_capacity);
  rows.reserve(k_max_joint_rows * joint_capacity);
}

void JointSystem::clear() {
  bodies.clear();
  added.clear();
  joints.clear();
  row_count = 0;
}

std::span<JointRow> JointSystem::take_rows(std::size_t count) {
  LKS_ASSERT(row_count + count <=
             k_max_joint_rows * added.size());  // spans taken before stay valid
  if (rows.size() < row_count + count) rows.resize(row_count + count);
  const std::span<JointRow> taken = std::span(rows).subspan(row_count, count);
  row_count += count;
  return taken;
}

bool JointSystem::has_factor(const JointGroup& group) const {
  return group.is_factored && std::ranges::all_of(joints_of(group), [this](std::uint32_t index) {
           return joints[index].factored == list_rows(joints[index].rows);
         });
}

void JointSystem::note_factor(JointGroup& group) {
  for (const std::uint32_t index : joints_of(group))
    joints[index].factored = list_rows(joints[index].rows);
  group.is_factored = group.is_fresh = true;
}

void JointSystem::prefetch(const JointCluster& cluster) const {
  LKS_ASSERT(cluster.joint_count > 0);
  if (joints.size() < k_cached_joints) return;
  const LinkedJoint* first = joints.data() + cluster.first_joint;
  const LinkedJoint* last = first + cluster.joint_count - 1;
  prefetch_bytes(first, last + 1);
  prefetch_bytes(first->rows.rows.data(), last->rows.rows.data() + last->rows.rows.size());
  for (const std::uint32_t body : bodies_of(cluster))
    prefetch_bytes(&bodies[body], &bodies[body] + 1);
}

bool JointSystem::is_stiff(const JointGroup& group) const {
  return std::ranges::any_of(
      bodies_of(group), [this](std::uint32_t index) { return bodies[index].least_inertia > 0; });
}

}  // namespace lockstone
