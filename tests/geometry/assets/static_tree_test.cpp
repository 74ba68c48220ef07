#include "core/geometry/assets/static_tree.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "tests/geometry/assets/asset_parts.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

using geometry::LocalBounds;
using geometry::RayWindow;
using geometry::StaticTree;

std::vector<LocalBounds> random_boxes(Dice& dice, int count) {
  std::vector<LocalBounds> boxes;
  for (int i = 0; i < count; ++i)
    boxes.push_back(random_region(dice, 50, dice.chance(10) ? 40 : 2));
  return boxes;
}

std::vector<LocalBounds> renumbered(const std::vector<LocalBounds>& boxes,
                                    const std::vector<std::uint32_t>& order) {
  std::vector<LocalBounds> result;
  for (const std::uint32_t i : order)
    result.push_back(boxes[i]);
  return result;
}

/// The way of a ray that is in the middle of the box, to a step, after half of it.
Vec3<Length> way_through(const Vec3<Length>& origin, const LocalBounds& box) {
  const auto middle = [](Length low, Length high) { return low + (high - low) / 2; };
  Vec3<Length> way;
  for (int axis = 0; axis < 3; ++axis)
    way[axis] = (middle(box.lower[axis], box.upper[axis]) - origin[axis]) * 2;
  return way;
}

std::vector<std::uint32_t> query(const StaticTree& tree, const std::vector<LocalBounds>& boxes,
                                 const LocalBounds& region) {
  std::vector<std::uint32_t> found;
  tree.overlapping(region, [&](std::uint32_t first, std::uint32_t count) {
    for (std::uint32_t i = first; i < first + count; ++i)
      if (overlap(boxes[i], region)) found.push_back(i);
  });
  return found;
}

TEST(StaticTree, FindsAsMuchAsATestOfEveryBoxInAscendingOrder) {
  Dice dice;
  for (const int count : {1, 2, 4, 5, 100, 1000}) {
    const auto given = random_boxes(dice, count);
    std::vector<std::uint32_t> order;
    const StaticTree tree = StaticTree::build(given, order);
    const auto boxes = renumbered(given, order);
    for (int i = 0; i < 200; ++i) {
      const LocalBounds region = random_region(dice, 55, 20);
      std::vector<std::uint32_t> expected;
      for (std::uint32_t k = 0; k < boxes.size(); ++k)
        if (overlap(boxes[k], region)) expected.push_back(k);
      ASSERT_EQ(query(tree, boxes, region), expected);
    }
  }
}

TEST(StaticTree, NumbersEveryItemOnce) {
  Dice dice;
  const auto boxes = random_boxes(dice, 777);
  std::vector<std::uint32_t> order;
  (void)StaticTree::build(boxes, order);
  std::sort(order.begin(), order.end());
  for (std::uint32_t i = 0; i < order.size(); ++i)
    ASSERT_EQ(order[i], i);
  EXPECT_EQ(order.size(), boxes.size());
}

TEST(StaticTree, MissesNoBoxThatARayMeets) {
  Dice dice;
  const auto given = random_boxes(dice, 500);
  std::vector<std::uint32_t> order;
  const StaticTree tree = StaticTree::build(given, order);
  const auto boxes = renumbered(given, order);
  int met = 0;
  for (int i = 0; i < test::share_of(500); ++i) {
    const Vec3<Length> origin = random_region(dice, 100, 0.1).lower;
    Vec3<Length> way = random_region(dice, 200, 0.1).lower;
    if (dice.chance(4)) way.x = {};
    if (dice.chance(4)) way.z = {};
    if (i % 2 == 1) way = way_through(origin, boxes[static_cast<std::size_t>(i)]);
    std::vector<bool> found(boxes.size());
    tree.nearest_first(RayWindow(origin, way, {}), Unit::from_integer(1).raw,
                       [&](std::uint32_t first, std::uint32_t count, std::int64_t limit) {
                         std::fill_n(found.begin() + first, count, true);
                         return limit;
                       });
    for (std::size_t k = 0; k < boxes.size(); ++k) {
      const bool meets = surely_meets(origin, way, boxes[k]);
      met += meets ? 1 : 0;
      ASSERT_TRUE(found[k] || !meets);
    }
  }
  EXPECT_GE(met, test::share_of(250));  // every second ray meets the box that it is aimed at
}

TEST(StaticTree, AsksForNothingBeyondAShortenedRay) {
  std::vector<LocalBounds> boxes;
  for (int i = 0; i < 64; ++i)
    boxes.push_back({metres(10 * i, -1, -1), metres(10 * i + 1, 1, 1)});
  std::vector<std::uint32_t> order;
  const StaticTree tree = StaticTree::build(boxes, order);
  const RayWindow ray(metres(-5, 0, 0), metres(1000, 0, 0), {});
  int leaves = 0;
  const auto nearest = [&](std::uint32_t first, std::uint32_t, std::int64_t limit) {
    ++leaves;
    std::int64_t at = 0;
    return ray.meets(boxes[order[first]], limit, at) ? at : limit;
  };
  tree.nearest_first(ray, Unit::from_integer(1).raw, nearest);
  EXPECT_EQ(leaves, 1);
}

TEST(StaticTree, BoundsItsDepthWhereAllBoxesAreEqual) {
  const std::vector<LocalBounds> boxes(5000, LocalBounds{metres(0, 0, 0), metres(1, 1, 1)});
  std::vector<std::uint32_t> order;
  const StaticTree tree = StaticTree::build(boxes, order);
  EXPECT_LE(tree.depth(), 11);
}

TEST(StaticTree, BoundsItsDepthWhereSizesGrowGeometrically) {
  std::vector<LocalBounds> boxes;
  for (int i = 0; i < 30; ++i) {
    const Length x = Length::from_raw(std::int32_t{1} << i);
    for (int k = 0; k < 40; ++k)
      boxes.push_back({{x, {}, Length::from_raw(k)}, {x, {}, Length::from_raw(k)}});
  }
  std::vector<std::uint32_t> order;
  const StaticTree tree = StaticTree::build(boxes, order);
  EXPECT_LE(tree.depth(), StaticTree::k_max_depth);
}

TEST(RayWindow, AnswersTheFractionWhereTheRayEnters) {
  Dice dice;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const LocalBounds box = random_region(dice, 900, 90);
    const Vec3<Length> origin = random_region(dice, 1400, 0.1).lower;
    const Vec3<Length> way = random_region(dice, 1400, 0.1).lower;
    std::int64_t at = 0;
    if (!RayWindow(origin, way, {}).meets(box, Unit::from_integer(1).raw, at)) {
      ASSERT_FALSE(surely_meets(origin, way, box));
      continue;
    }
    long double enter = 0;
    for (int axis = 0; axis < 3; ++axis) {
      if (way[axis].raw == 0) continue;
      const long double low = static_cast<long double>(box.lower[axis].raw) - origin[axis].raw;
      const long double high = static_cast<long double>(box.upper[axis].raw) - origin[axis].raw;
      enter = std::max(enter, std::min(low / way[axis].raw, high / way[axis].raw));
    }
    const long double scaled = std::ldexp(enter, 30);
    ASSERT_LE(static_cast<long double>(at), scaled);
    ASSERT_GE(static_cast<long double>(at), scaled - 5);
  }
}

}  // namespace
}  // namespace lockstone::test
