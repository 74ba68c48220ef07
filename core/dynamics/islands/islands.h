// Islands: bodies that hold on to each other, directly or through others.
//
// Union-find with path halving (R. Tarjan, J. van Leeuwen, "Worst-case analysis of set union
// algorithms", 1984). The root of an island is its least body, so that nothing depends on the order
// of joining.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

namespace lockstone {

class Islands {
 public:
  /// No function but this allocates.
  explicit Islands(std::uint32_t body_capacity) : parents_(body_capacity), held_(body_capacity) {}

  /// Each of these bodies an island of its own. All other functions take only these.
  void begin(std::span<const std::uint32_t> bodies) {
    for (const std::uint32_t body : bodies) {
      parents_[body] = body;
      held_[body] = 0;
    }
  }

  [[nodiscard]] std::uint32_t root(std::uint32_t body) {
    while (parents_[body] != body) {
      parents_[body] = parents_[parents_[body]];
      body = parents_[body];
    }
    return body;
  }

  void join(std::uint32_t a, std::uint32_t b) {
    const std::uint32_t root_a = root(a), root_b = root(b);
    if (root_a < root_b) parents_[root_b] = root_a;
    if (root_b < root_a) parents_[root_a] = root_b;
  }

  /// The island of this body stays awake.
  void hold(std::uint32_t body) { held_[body] = 1; }

  /// To be called after the last join and the last hold, before `is_held`. Returns the number of
  /// islands.
  std::uint32_t settle(std::span<const std::uint32_t> bodies) {
    std::uint32_t islands = 0;
    for (const std::uint32_t body : bodies) {
      const std::uint32_t island = root(body);
      islands += island == body ? 1U : 0U;
      if (held_[body] != 0) held_[island] = 1;
    }
    return islands;
  }
  [[nodiscard]] bool is_held(std::uint32_t body) { return held_[root(body)] != 0; }

 private:
  std::vector<std::uint32_t> parents_;  // by body
  std::vector<std::uint8_t> held_;      // by body; after `settle` by root
};

}  // namespace lockstone
