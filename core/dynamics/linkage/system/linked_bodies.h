// Finds the bodies that joints connect in a tick, by their number in the world.
#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/linkage/system/linked_body.h"

namespace lockstone {

class LinkedBodies {
 public:
  /// The bodies stand in `bodies`, which no one else adds to: at most `body_capacity`, of a world
  /// of `world_capacity`. No function but this allocates.
  [[gnu::cold]] LinkedBodies(std::vector<LinkedBody>& bodies, std::size_t body_capacity,
                             std::size_t world_capacity);

  /// Forgets all bodies.
  void clear();

  /// Returns the place of a body of the world; adds it if no joint has named it before. `solver`:
  /// its number in the contact solver.
  std::uint32_t gather(std::uint32_t body, std::uint32_t solver, const BodyRecord& record,
                       const Mat3& rotation);

  /// Null if no joint holds the body.
  [[nodiscard]] const LinkedBody* find(std::uint32_t body) const {
    const std::uint32_t place = place_[body];
    return place == 0 ? nullptr : &bodies_[place - 1];
  }

 private:
  std::vector<LinkedBody>& bodies_;
  std::vector<std::uint32_t> place_;   // by body of the world: in bodies_, + 1
  std::vector<std::uint32_t> placed_;  // bodies of the world that have a place
};

}  // namespace lockstone
