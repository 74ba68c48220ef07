#include "core/collision/continuous/relative_path.h"

#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/literals.h>
#include <lockstone/testing/floating.h>

#include "core/geometry/distance/motion/time_of_impact.h"
#include "tests/support/random.h"

namespace lockstone {
namespace {

using namespace literals;

Sweep random_sweep(test::Random& random, std::int64_t reach_raw, std::int64_t turn_raw) {
  Sweep sweep;
  for (int i = 0; i < 3; ++i) {
    sweep.start.position[i].raw = random.between(-reach_raw, reach_raw);
    sweep.translation[i].raw = random.between(-reach_raw, reach_raw) / 4;
    sweep.rotation[i].raw = random.between(-turn_raw, turn_raw);
  }
  return sweep;
}

double metres_between(const Vec3<Position>& a, const Vec3<Position>& b) {
  double square = 0;
  for (int i = 0; i < 3; ++i)
    square += std::pow(testing::to_double(a[i] - b[i]), 2);
  return std::sqrt(square);
}

// The length of the line through where B sees the point of A at equal steps of time: at most that
// of the way itself.
double seen_way(const Sweep& a, const Sweep& b, const Vec3<Length>& point) {
  constexpr int k_steps = 64;
  double way = 0;
  Vec3<Position> last{};
  for (int i = 0; i <= k_steps; ++i) {
    const Unit moment = Unit::from_ratio(i, k_steps);
    const Vec3<Position> seen = apply_inverse(pose_at(b, moment), apply(pose_at(a, moment), point));
    if (i > 0) way += metres_between(last, seen);
    last = seen;
  }
  return way;
}

TEST(RelativePath, IsNoShorterThanThatOfAnyPoint) {
  test::Random random;
  double closest = 0;
  for (int round = 0; round < 2000; ++round) {
    const std::int64_t reach = std::int64_t{1} << random.between(28, 36);
    const Sweep a = random_sweep(random, reach, std::int64_t{1} << random.between(24, 33));
    const Sweep b = random_sweep(random, reach, std::int64_t{1} << random.between(24, 30));
    const Length radius = Length::from_raw(static_cast<std::int32_t>(random.between(0, 1 << 21)));
    Vec3<Length> point{};
    point[static_cast<int>(random.between(0, 2))] = radius;
    const double bound = testing::to_double(relative_way(a, b, radius));
    const double way = seen_way(a, b, point);
    ASSERT_LT(way, bound + 2e-6) << "round " << round;
    closest = std::max(closest, way / (bound + 1e-9));
  }
  EXPECT_GT(closest, 0.95);  // and not by much, where the point is the one that goes farthest
}

TEST(RelativePath, IsZeroForAPointThatIsCarriedRound) {
  Sweep drum;
  drum.rotation.z.raw = (std::int64_t{1} << 32) / 137;
  Sweep cube = drum;
  cube.start.position = {16_m, {}, {}};
  cube.translation.y = Position::from_ratio(16, 137);
  EXPECT_LT(relative_way(cube, drum, 0.3_m), 0.001_m);
  EXPECT_GT(relative_way(cube, Sweep{}, 0.3_m), 0.1_m);
}

TEST(RelativePath, IsWithoutBoundWhereTheOtherTurnsFar) {
  Sweep top;
  top.rotation.y.raw = std::int64_t{1} << 31;
  EXPECT_EQ(relative_way(Sweep{}, top, 1_m), Position::max());
}

}  // namespace
}  // namespace lockstone
