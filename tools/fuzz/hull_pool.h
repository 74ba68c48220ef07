// Hulls of random clouds, each built when it is first asked for.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include <lockstone/hull.h>

#include "tools/fuzz/dice.h"

namespace lockstone::fuzz {

/// Of a cloud of any form and size: grids, prisms, boxes, slivers, needles, plates. Never null.
[[nodiscard]] std::shared_ptr<const Hull> random_hull(Dice& dice);

inline constexpr std::uint64_t k_hull_pool = 4096;

/// The hulls of a seed: number k depends on the seed and k alone. Safe from several threads.
class HullPool {
 public:
  explicit HullPool(std::uint64_t seed);

  /// number < k_hull_pool. Never null.
  [[nodiscard]] const std::shared_ptr<const Hull>& at(std::uint64_t number);

 private:
  std::uint64_t seed_;
  std::array<std::once_flag, k_hull_pool> built_;
  std::vector<std::shared_ptr<const Hull>> hulls_;
};

}  // namespace lockstone::fuzz
