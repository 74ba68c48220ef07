// The places of one island in the pools that all converged islands share.
#pragma once

#include <cstdint>

namespace lockstone {

struct PoolShare {
  std::uint32_t bodies = 0;
  std::uint32_t problems = 0;  ///< contacts and joints
  std::uint32_t joints = 0;
  std::uint32_t blocks = 0;   ///< of the factor
  std::uint32_t targets = 0;  ///< of the factor: products of blocks

  void add(const PoolShare& other) {
    bodies += other.bodies;
    problems += other.problems;
    joints += other.joints;
    blocks += other.blocks;
    targets += other.targets;
  }
  [[nodiscard]] bool fits(const PoolShare& room) const {
    return bodies <= room.bodies && problems <= room.problems && joints <= room.joints &&
           blocks <= room.blocks && targets <= room.targets;
  }
};

/// With a body of the island, by its index in the world.
struct IslandShare {
  std::uint32_t body = 0;
  PoolShare share;
};

}  // namespace lockstone
