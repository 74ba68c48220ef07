// Islands: bodies that are connected to each other, directly or through others.
//
// Union-find with path halving (R. Tarjan, J. van Leeuwen, "Worst-case analysis of set union
// algorithms", 1984). The root of an island is its least body, so that nothing depends on the order
// of joining.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <lockstone/assert.h>

namespace lockstone {

class Islands {
 public:
  /// No function but this allocates.
  explicit Islands(std::uint32_t body_capacity) : parents_(body_capacity), marks_(body_capacity) {}

  /// Each of these bodies an island of its own. All other functions take only these.
  void begin(std::span<const std::uint32_t> bodies) {
    for (const std::uint32_t body : bodies) {
      parents_[body] = body;
      marks_[body] = 0;
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
    LKS_ASSERT(a < parents_.size() && b < parents_.size());
    const std::uint32_t root_a = root(a), root_b = root(b);
    if (root_a < root_b) parents_[root_b] = root_a;
    if (root_b < root_a) parents_[root_a] = root_b;
  }

  /// The island of this body is active: it may not fall asleep.
  void mark_active(std::uint32_t body) { marks_[body] |= k_active; }

  /// The same, because a body that nothing pushes moves it.
  void mark_driven(std::uint32_t body) { marks_[body] |= k_active | k_driven; }

  /// A body of this island rests.
  void note_rest(std::uint32_t body) { marks_[body] |= k_rests; }

  /// To be called after the last join and the last mark, before they are asked for. Returns the
  /// number of islands.
  std::uint32_t settle(std::span<const std::uint32_t> bodies) {
    std::uint32_t islands = 0;
    for (const std::uint32_t body : bodies) {
      const std::uint32_t island = root(body);
      islands += island == body ? 1U : 0U;
      marks_[island] |= marks_[body];
    }
    return islands;
  }
  [[nodiscard]] bool is_active(std::uint32_t body) { return (marks_[root(body)] & k_active) != 0; }

  /// Whether some bodies of the island rest and others keep it awake by themselves.
  [[nodiscard]] bool rests_in_part(std::uint32_t body) {
    return marks_[root(body)] == (k_active | k_rests);
  }

 private:
  static constexpr std::uint8_t k_active = 1, k_driven = 2, k_rests = 4;

  std::vector<std::uint32_t> parents_;  // by body
  std::vector<std::uint8_t> marks_;     // by body; after `settle` by root
};

}  // namespace lockstone
