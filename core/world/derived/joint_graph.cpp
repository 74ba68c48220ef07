#include "core/world/derived/joint_graph.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone {

JointGraph::JointGraph(std::uint32_t body_capacity, std::uint32_t joint_capacity)
    : is_disabled_(body_capacity), neighbours_(body_capacity, joint_capacity) {
  links_.reserve(joint_capacity);
  awake_links_.reserve(joint_capacity);
  exempt_pairs_.reserve(joint_capacity);
}

void JointGraph::add(const JointLink& link, const std::optional<Pair>& exempt) {
  forget_awake_list();
  const auto place = std::ranges::lower_bound(links_, link.joint, {}, &JointLink::joint);
  LKS_ASSERT(place == links_.end() || place->joint != link.joint);
  links_.insert(place, link);
  neighbours_.add(link);
  if (exempt) exempt_pairs_.insert(std::ranges::lower_bound(exempt_pairs_, *exempt), *exempt);
}

void JointGraph::remove(std::uint32_t joint, const std::optional<Pair>& exempt) {
  forget_awake_list();
  const auto place = std::ranges::lower_bound(links_, joint, {}, &JointLink::joint);
  LKS_ASSERT(place != links_.end() && place->joint == joint);
  neighbours_.remove(*place);
  links_.erase(place);
  if (!exempt) return;
  LKS_ASSERT(is_exempt(*exempt));
  exempt_pairs_.erase(std::ranges::lower_bound(exempt_pairs_, *exempt));
}

bool JointGraph::is_exempt(const Pair& pair) const {
  return std::ranges::binary_search(exempt_pairs_, pair);
}

}  // namespace lockstone
