#include "core/collision/broad_phase.h"

#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace lockstone {
namespace {

struct Model {
  std::vector<Bounds> bounds;
  std::vector<bool> present;
  std::vector<bool> moves;

  [[nodiscard]] std::vector<Pair> pairs() const {
    std::vector<Pair> found;
    for (std::uint32_t a = 0; a < bounds.size(); ++a) {
      for (std::uint32_t b = 0; b < bounds.size(); ++b) {
        const bool mine = present[a] && present[b] && moves[a] && (!moves[b] || b > a);
        if (a != b && mine && overlap(bounds[a], bounds[b])) found.push_back({a, b});
      }
    }
    return found;
  }
};

Bounds random_box(test::Random& random) {
  Bounds box;
  for (int i = 0; i < 3; ++i) {
    box.lower[i].raw = static_cast<std::int32_t>(random.between(-6000, 6000));
    box.upper[i].raw = box.lower[i].raw + static_cast<std::int32_t>(random.between(100, 2500));
  }
  return box;
}

Bounds moved(Bounds box, test::Random& random) {
  for (int i = 0; i < 3; ++i) {
    const auto by = static_cast<std::int32_t>(random.between(-60, 60));
    box.lower[i].raw += by;
    box.upper[i].raw += by;
  }
  return box;
}

constexpr auto k_accept_all = [](std::uint32_t, std::uint32_t) { return true; };

TEST(BroadPhase, FindsEveryOverlappingPairOnceAndSorted) {
  test::Random random;
  constexpr std::uint32_t k_count = 120;
  Model model{std::vector<Bounds>(k_count), std::vector<bool>(k_count), std::vector<bool>(k_count)};
  BroadPhase broad_phase(k_count, 1 << 14);
  for (int round = 0; round < 200; ++round) {
    for (std::uint32_t body = 0; body < k_count; ++body) {
      const std::int64_t die = random.between(0, 99);
      if (die < 3) {
        model.present[body] = false;
        broad_phase.remove(body);
        continue;
      }
      if (die >= 60) continue;
      if (!model.present[body]) model.moves[body] = random.between(0, 3) > 0;
      model.bounds[body] =
          model.present[body] ? moved(model.bounds[body], random) : random_box(random);
      model.present[body] = true;
      broad_phase.set_bounds(body, model.bounds[body], model.moves[body]);
    }
    ASSERT_TRUE(broad_phase.is_valid());
    const auto found = broad_phase.find_pairs(k_count, k_accept_all);
    ASSERT_EQ(std::vector<Pair>(found.begin(), found.end()), model.pairs());
  }
}

TEST(BroadPhase, KeepsTheFirstPairsWhenTheyExceedTheCapacity) {
  BroadPhase roomy(40, 1 << 12);
  BroadPhase tight(40, 100);
  for (std::uint32_t body = 0; body < 40; ++body) {
    roomy.set_bounds(body, Bounds{}, true);
    tight.set_bounds(39 - body, Bounds{}, true);  // another history, another tree
  }
  const auto all = roomy.find_pairs(40, k_accept_all);
  const auto some = tight.find_pairs(40, k_accept_all);
  ASSERT_EQ(all.size(), 780U);
  EXPECT_FALSE(roomy.overflowed());
  EXPECT_TRUE(tight.overflowed());
  EXPECT_EQ(std::vector<Pair>(some.begin(), some.end()),
            std::vector<Pair>(all.begin(), all.begin() + 100));
}

TEST(BroadPhase, LeavesOutWhatIsNotAccepted) {
  BroadPhase broad_phase(4, 16);
  for (std::uint32_t body = 0; body < 4; ++body)
    broad_phase.set_bounds(body, Bounds{}, true);
  const auto found =
      broad_phase.find_pairs(4, [](std::uint32_t a, std::uint32_t b) { return a + b == 3; });
  ASSERT_EQ(found.size(), 2U);
  EXPECT_EQ(found[0], (Pair{0, 3}));
  EXPECT_EQ(found[1], (Pair{1, 2}));
}

}  // namespace
}  // namespace lockstone
