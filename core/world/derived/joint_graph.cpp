#include "core/world/derived/joint_graph.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone {

JointGraph::JointGraph(std::uint32_t body_capacity, std::uint32_t joint_capacity)
    : is_disabled_(body_capacity), begins_(std::size_t{body_capacity} + 1) {
  links_.reserve(joint_capacity);
  awake_links_.reserve(joint_capacity);
  exempt_pairs_.reserve(joint_capacity);
  neighbours_.reserve(std::size_t{2} * joint_capacity);
}

void JointGraph::forget_lists() {
  are_neighbours_current_ = false;
  is_awake_list_current_ = false;
}

void JointGraph::add(const JointLink& link, const std::optional<Pair>& exempt) {
  forget_lists();
  const auto place = std::ranges::lower_bound(links_, link.joint, {}, &JointLink::joint);
  LKS_ASSERT(place == links_.end() || place->joint != link.joint);
  links_.insert(place, link);
  if (exempt) exempt_pairs_.insert(std::ranges::lower_bound(exempt_pairs_, *exempt), *exempt);
}

void JointGraph::remove(std::uint32_t joint, const std::optional<Pair>& exempt) {
  forget_lists();
  const auto place = std::ranges::lower_bound(links_, joint, {}, &JointLink::joint);
  LKS_ASSERT(place != links_.end() && place->joint == joint);
  links_.erase(place);
  if (!exempt) return;
  LKS_ASSERT(is_exempt(*exempt));
  exempt_pairs_.erase(std::ranges::lower_bound(exempt_pairs_, *exempt));
}

bool JointGraph::is_exempt(const Pair& pair) const {
  return std::ranges::binary_search(exempt_pairs_, pair);
}

std::span<const std::uint32_t> JointGraph::neighbours(std::uint32_t body) {
  if (links_.empty()) return {};
  LKS_ASSERT(body + std::size_t{1} < begins_.size());
  if (!are_neighbours_current_) rebuild_neighbours();
  return std::span(neighbours_).subspan(begins_[body], begins_[body + 1] - begins_[body]);
}

// Counts, then fills each body's part from its end to its beginning.
void JointGraph::rebuild_neighbours() {
  std::ranges::fill(begins_, 0U);
  for (const JointLink& link : links_) {
    if (!works(link)) continue;
    ++begins_[link.body_a];
    ++begins_[link.body_b];
  }
  std::uint32_t sum = 0;
  for (std::uint32_t& begin : begins_)
    begin = sum += begin;
  neighbours_.resize(sum);
  for (std::size_t i = links_.size(); i-- > 0;) {
    if (!works(links_[i])) continue;
    neighbours_[--begins_[links_[i].body_a]] = links_[i].body_b;
    neighbours_[--begins_[links_[i].body_b]] = links_[i].body_a;
  }
  are_neighbours_current_ = true;
}

}  // namespace lockstone
