#include "core/collision/broad_phase/bounding_volume_tree.h"

#include <algorithm>
#include <utility>
#include <vector>

#include <gtest/gtest.h>

#include "tests/support/random.h"

namespace lockstone {
namespace {

Bounds random_bounds(test::Random& random, std::int64_t spread, std::int64_t size) {
  Bounds bounds;
  for (int i = 0; i < 3; ++i) {
    const auto low = static_cast<std::int32_t>(random.between(-spread, spread));
    bounds.lower[i].raw = low;
    bounds.upper[i].raw = low + static_cast<std::int32_t>(random.between(0, size));
  }
  return bounds;
}

std::vector<std::uint32_t> bodies_in(const BoundingVolumeTree& tree, const Bounds& area) {
  std::vector<std::uint32_t> found;
  tree.traverse([&](const Bounds& b, const Layers&) { return overlap(area, b); },
                [&](std::uint32_t body) { found.push_back(body); });
  std::sort(found.begin(), found.end());
  return found;
}

TEST(BoundingVolumeTree, FindsNothingWhenEmpty) {
  BoundingVolumeTree tree(4);
  EXPECT_TRUE(tree.is_valid());
  EXPECT_TRUE(bodies_in(tree, Bounds{}).empty());
}

TEST(BoundingVolumeTree, FindsAsMuchAsAFullSearchWhileLeavesComeAndGo) {
  test::Random random;
  constexpr std::uint32_t k_count = 300;
  BoundingVolumeTree tree(k_count);
  std::vector<std::uint32_t> leaf(k_count, BoundingVolumeTree::k_null);
  std::vector<Bounds> bounds(k_count);
  for (int round = 0; round < 3000; ++round) {
    const auto body = static_cast<std::uint32_t>(random.between(0, k_count - 1));
    if (leaf[body] != BoundingVolumeTree::k_null) {
      tree.remove(leaf[body]);
      leaf[body] = BoundingVolumeTree::k_null;
    } else {
      bounds[body] = random_bounds(random, 20000, 3000);
      leaf[body] = tree.insert(bounds[body], {}, body);
    }
    if (round % 50 != 0) continue;
    ASSERT_TRUE(tree.is_valid());
    const Bounds area = random_bounds(random, 20000, 8000);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < k_count; ++i) {
      if (leaf[i] != BoundingVolumeTree::k_null && overlap(area, bounds[i])) expected.push_back(i);
    }
    ASSERT_EQ(bodies_in(tree, area), expected);
  }
}

TEST(BoundingVolumeTree, StaysFlatWhenLeavesComeInSortedOrder) {
  BoundingVolumeTree tree(4096);
  for (std::int32_t i = 0; i < 4096; ++i) {
    Bounds bounds;
    bounds.lower.x.raw = i * 2000;
    bounds.upper.x.raw = i * 2000 + 1000;
    tree.insert(bounds, {}, static_cast<std::uint32_t>(i));
  }
  EXPECT_TRUE(tree.is_valid());
  EXPECT_LE(tree.height(), 30);
}

TEST(BoundingVolumeTree, BuiltAtOnceIsFlatAndFindsAsMuchAsAFullSearch) {
  test::Random random;
  constexpr std::uint32_t k_count = 500;
  BoundingVolumeTree tree(k_count);
  std::vector<BoundingVolumeTree::Item> items;
  std::vector<Bounds> bounds;
  for (std::uint32_t body = 0; body < k_count; ++body) {
    bounds.push_back(random_bounds(random, 20000, 3000));
    items.push_back(tree.make_leaf(bounds.back(), {}, body));
  }
  tree.build(items);
  ASSERT_TRUE(tree.is_valid());
  EXPECT_EQ(tree.height(), 9);
  for (int round = 0; round < 50; ++round) {
    const Bounds area = random_bounds(random, 20000, 8000);
    std::vector<std::uint32_t> expected;
    for (std::uint32_t i = 0; i < k_count; ++i) {
      if (overlap(area, bounds[i])) expected.push_back(i);
    }
    ASSERT_EQ(bodies_in(tree, area), expected);
  }
}

TEST(BoundingVolumeTree, SkipsLeavesThatItsLayersRuleOut) {
  constexpr Layers k_one{.categories = 1, .masks = 1};
  constexpr Layers k_two{.categories = 2, .masks = 2};
  BoundingVolumeTree tree(100);
  for (std::uint32_t body = 0; body < 100; ++body)
    tree.insert({}, k_one, body);
  int tests = 0;
  const auto count_tests = [&](const Layers& mine) {
    tests = 0;
    const auto test = [&](const Bounds&, const Layers& others) {
      ++tests;
      return may_collide(mine, others);
    };
    tree.traverse(test, [](std::uint32_t) {});
    return tests;
  };
  EXPECT_EQ(count_tests(k_two), 1);
  EXPECT_EQ(count_tests(k_one), 199);
}

TEST(BoundingVolumeTree, TakesBoxesAtTheEdgeOfItsRange) {
  BoundingVolumeTree tree(64);
  test::Random random;
  for (std::uint32_t i = 0; i < 64; ++i) {
    Bounds bounds = random_bounds(random, 1 << 30, 1 << 30);
    if (i % 2 == 0) {
      bounds.lower = {BoundsCoordinate::min(), BoundsCoordinate::min(), BoundsCoordinate::min()};
      bounds.upper = {BoundsCoordinate::max(), BoundsCoordinate::max(), BoundsCoordinate::max()};
    }
    tree.insert(bounds, {}, i);
  }
  EXPECT_TRUE(tree.is_valid());
}

TEST(Bounds, RoundOutward) {
  const Position x = Position::from_raw((std::int64_t{5} << 22) + 1);
  EXPECT_EQ(round_down(x).raw, 5);
  EXPECT_EQ(round_up(x).raw, 6);
  EXPECT_EQ(round_down(-x).raw, -6);
  EXPECT_EQ(round_up(-x).raw, -5);
}

using BodyPair = std::pair<std::uint32_t, std::uint32_t>;

std::vector<BodyPair> pairs_in(const BoundingVolumeTree& tree) {
  std::vector<BodyPair> found;
  EXPECT_TRUE(tree.visit_pairs([&](std::uint32_t body, std::uint32_t other) {
    found.push_back(std::minmax(body, other));
    return true;
  }));
  std::sort(found.begin(), found.end());
  return found;
}

TEST(BoundingVolumeTree, VisitsEachTwoLeavesThatMeetOnce) {
  test::Random random;
  for (std::uint32_t count = 0; count < 120; ++count) {
    BoundingVolumeTree tree(count);
    std::vector<Bounds> bounds;
    std::vector<Layers> layers;
    std::vector<BoundingVolumeTree::Item> items;
    const bool at_once = random.between(0, 1) != 0;
    for (std::uint32_t body = 0; body < count; ++body) {
      bounds.push_back(random_bounds(random, 4000, 3000));
      const auto bits = [&] { return static_cast<std::uint32_t>(random.between(1, 3)); };
      const std::uint32_t categories = bits();
      layers.push_back({categories, bits(), random.between(0, 20) == 0});
      if (at_once)
        items.push_back(tree.make_leaf(bounds[body], layers[body], body));
      else
        (void)tree.insert(bounds[body], layers[body], body);
    }
    if (at_once) tree.build(items);
    std::vector<BodyPair> expected;
    for (std::uint32_t i = 0; i < count; ++i)
      for (std::uint32_t j = i + 1; j < count; ++j)
        if (overlap(bounds[i], bounds[j]) && may_collide(layers[i], layers[j]))
          expected.emplace_back(i, j);
    ASSERT_EQ(pairs_in(tree), expected) << count;
    if (expected.size() < 2) continue;
    int visited = 0;
    EXPECT_FALSE(tree.visit_pairs([&](std::uint32_t, std::uint32_t) { return ++visited < 2; }));
    EXPECT_EQ(visited, 2);
  }
}

}  // namespace
}  // namespace lockstone
