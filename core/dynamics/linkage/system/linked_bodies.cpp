#include "core/dynamics/linkage/system/linked_bodies.h"

#include <lockstone/assert.h>

namespace lockstone {

LinkedBodies::LinkedBodies(std::vector<LinkedBody>& bodies, std::size_t body_capacity,
                           std::size_t world_capacity)
    : bodies_(bodies), place_(world_capacity) {
  placed_.reserve(body_capacity);
}

void LinkedBodies::clear() {
  for (const std::uint32_t body : placed_)
    place_[body] = 0;
  placed_.clear();
  bodies_.clear();
}

std::uint32_t LinkedBodies::gather(std::uint32_t body, std::uint32_t solver,
                                   const BodyRecord& record, const Mat3& rotation) {
  std::uint32_t& place = place_[body];
  if (place != 0) return place - 1;
  LKS_ASSERT(placed_.size() == bodies_.size());
  placed_.push_back(body);
  place = static_cast<std::uint32_t>(placed_.size());
  set_body(record, rotation, solver, bodies_.emplace_back());
  return place - 1;
}

}  // namespace lockstone
