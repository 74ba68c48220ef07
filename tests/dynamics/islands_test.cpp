#include "core/dynamics/islands/islands.h"

#include <numeric>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace lockstone {
namespace {

constexpr std::uint32_t k_bodies = 40;

struct Join {
  std::uint32_t a, b;
};

// By spreading the least index until nothing changes.
std::vector<std::uint32_t> roots_by_spreading(const std::vector<Join>& joins) {
  std::vector<std::uint32_t> roots(k_bodies);
  std::iota(roots.begin(), roots.end(), 0U);
  for (bool changed = true; changed;) {
    changed = false;
    for (const Join& join : joins) {
      const std::uint32_t least = std::min(roots[join.a], roots[join.b]);
      changed |= roots[join.a] != least || roots[join.b] != least;
      roots[join.a] = roots[join.b] = least;
    }
  }
  return roots;
}

TEST(Islands, AreNumberedByTheirLeastBodyWhateverTheOrder) {
  test::Random random;
  std::vector<std::uint32_t> bodies(k_bodies);
  std::iota(bodies.begin(), bodies.end(), 0U);
  const auto any = [&] { return static_cast<std::uint32_t>(random.between(0, k_bodies - 1)); };
  Islands islands(k_bodies);
  for (int round = 0; round < 200; ++round) {
    std::vector<Join> joins(static_cast<std::size_t>(random.between(0, 50)));
    for (Join& join : joins) {
      join.a = any();
      join.b = any();
    }
    const std::uint32_t held = any();
    islands.begin(bodies);
    for (const Join& join : joins)
      islands.join(join.a, join.b);
    islands.mark_active(held);
    const std::vector<std::uint32_t> expected = roots_by_spreading(joins);
    std::uint32_t count = 0;
    for (const std::uint32_t body : bodies)
      count += expected[body] == body ? 1U : 0U;
    EXPECT_EQ(islands.settle(bodies), count);
    for (const std::uint32_t body : bodies) {
      ASSERT_EQ(islands.root(body), expected[body]);
      ASSERT_EQ(islands.is_active(body), expected[body] == expected[held]);
    }
  }
}

}  // namespace
}  // namespace lockstone
