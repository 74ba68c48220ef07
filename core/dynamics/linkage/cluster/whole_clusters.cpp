#include "core/dynamics/linkage/cluster/whole_clusters.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone {

std::uint32_t WholeClusters::body_of(std::uint32_t cluster) const {
  LKS_ASSERT(!system_.bodies_of(system_.clusters[cluster]).empty());
  return system_.bodies[system_.bodies_of(system_.clusters[cluster])[0]].solver;
}

bool WholeClusters::is_apart(std::uint32_t cluster) const {
  const JointCluster& own = system_.clusters[cluster];
  const std::span<const LinkedJoint> joints =
      std::span(system_.joints).subspan(own.first_joint, own.joint_count);
  const auto may_be_shared = [this](std::uint32_t index) {
    const LinkedBody& body = system_.bodies[index];
    return body.solver != 0 && !body.pushed;
  };
  return std::ranges::none_of(joints, [&](const LinkedJoint& joint) {
    return may_be_shared(joint.a) || may_be_shared(joint.b);
  });
}

void WholeClusters::take(std::uint32_t cluster) {
  LKS_ASSERT(is_apart(cluster));
  JointCluster& own = system_.clusters[cluster];
  own.is_whole = true;
  for (const std::uint32_t body : system_.bodies_of(own))
    system_.bodies[body].is_whole = true;
}

void WholeClusters::warm_start(const JointRun& run, std::uint32_t cluster) {
  LKS_ASSERT(system_.clusters[cluster].is_whole);
  stages_.warm_start(run, system_.clusters[cluster]);
}

void WholeClusters::solve(const JointRun& run, std::uint32_t cluster) {
  LKS_ASSERT(system_.clusters[cluster].is_whole);
  stages_.solve(run, system_.clusters[cluster]);
}

void WholeClusters::move(const JointRun& run, std::uint32_t cluster) {
  LKS_ASSERT(system_.clusters[cluster].is_whole);
  for (const std::uint32_t body : system_.bodies_of(system_.clusters[cluster]))
    move_body(run, system_.bodies[body]);
}

void WholeClusters::relax(const JointRun& run, std::uint32_t cluster) {
  LKS_ASSERT(system_.clusters[cluster].is_whole);
  stages_.relax(run, system_.clusters[cluster]);
  account_.settle(run, system_.clusters[cluster]);
}

}  // namespace lockstone
