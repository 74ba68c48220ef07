#include "core/world/derived/joint_neighbours.h"

#include <lockstone/assert.h>

namespace lockstone {

void JointNeighbours::clear(std::span<const JointLink> links) {
  for (const JointLink& link : links)
    lists_[link.body_a] = lists_[link.body_b] = {};
}

void JointNeighbours::add(const JointLink& link) {
  LKS_ASSERT(link.body_a != link.body_b);
  Entry& entry = entries_[link.joint];
  entry = {};
  entry.body[0] = link.body_a;
  entry.body[1] = link.body_b;
  insert(link.joint, 0);
  insert(link.joint, 1);
}

void JointNeighbours::remove(const JointLink& link) {
  LKS_ASSERT(entries_[link.joint].body[0] == link.body_a);
  LKS_ASSERT(entries_[link.joint].body[1] == link.body_b);
  erase(link.joint, 0);
  erase(link.joint, 1);
}

void JointNeighbours::insert(std::uint32_t joint, std::size_t end) {
  Entry& entry = entries_[joint];
  const std::uint32_t body = entry.body[end], previous = before(body, joint);
  std::uint32_t& place = follower(body, previous);
  LKS_ASSERT(place != joint);
  entry.next[end] = place;
  place = joint;
  if (entry.next[end] == k_none) lists_[body].last = joint;
}

void JointNeighbours::erase(std::uint32_t joint, std::size_t end) {
  const Entry& entry = entries_[joint];
  const std::uint32_t body = entry.body[end], previous = before(body, joint);
  std::uint32_t& place = follower(body, previous);
  LKS_ASSERT(place == joint);
  place = entry.next[end];
  if (place == k_none) lists_[body].last = previous;
}

std::uint32_t& JointNeighbours::follower(std::uint32_t body, std::uint32_t before) {
  if (before == k_none) return lists_[body].first;
  Entry& entry = entries_[before];
  return entry.next[entry.end_of(body)];
}

// A joint that is made last mostly has the highest number.
std::uint32_t JointNeighbours::before(std::uint32_t body, std::uint32_t joint) const {
  const List& list = lists_[body];
  if (list.last != k_none && list.last < joint) return list.last;
  std::uint32_t previous = k_none;
  for (std::uint32_t each = list.first; each != k_none && each < joint;) {
    previous = each;
    each = entries_[each].next[entries_[each].end_of(body)];
  }
  return previous;
}

}  // namespace lockstone
