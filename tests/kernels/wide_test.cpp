#include <algorithm>

#include <gtest/gtest.h>

#include <lockstone/fixed.h>

#include "core/kernels/ball/ball_block.h"
#include "core/kernels/contact/manifold_block.h"
#include "core/kernels/points/points.h"
#include "core/kernels/target.h"
#include "core/math/wide/scalar_lanes.h"
#include "tests/kernels/check.h"
#include "tests/kernels/values.h"
#include "tests/support/workload.h"

namespace lockstone::lanes {
namespace {

using lockstone::test::Random;
using lockstone::test::run_seed;

TEST(WideTargets, ScalarIsAlwaysThereAndTheBestIsInForce) {
  ASSERT_FALSE(supported_targets().empty());
  EXPECT_EQ(supported_targets().front(), "scalar");
  EXPECT_EQ(current_target(), supported_targets().back());
}

TEST(WideTargets, AreForcedByName) {
  for (const std::string_view name : supported_targets()) {
    EXPECT_EQ(set_target(name), Status::ok);
    EXPECT_EQ(current_target(), name);
  }
}

TEST(WideTargets, AnUnknownNameChangesNothing) {
  ASSERT_EQ(set_target("scalar"), Status::ok);
  EXPECT_EQ(set_target("abacus"), Status::not_found);
  EXPECT_EQ(current_target(), "scalar");
  ASSERT_EQ(set_target(supported_targets().back()), Status::ok);
}

TEST(WideTargets, FewAreLeftToNarrowVectorsUnlessOneIsForced) {
  ASSERT_EQ(set_target("scalar"), Status::ok);
  EXPECT_EQ(&manifold_kernels(k_block_lanes), &k_scalar_manifolds);
  EXPECT_EQ(&ball_kernels(k_block_lanes), &k_scalar_balls);
  const std::string_view best = supported_targets().back();
  ASSERT_EQ(set_target(best), Status::ok);
  const ManifoldKernels& widest = manifold_kernels(1);
  EXPECT_EQ(&manifold_kernels(1000), &widest);
  ASSERT_EQ(set_target({}), Status::ok);
  EXPECT_EQ(current_target(), best);
  EXPECT_EQ(&manifold_kernels(1), &k_scalar_manifolds);
  EXPECT_EQ(&ball_kernels(1), &k_scalar_balls);
  EXPECT_EQ(&manifold_kernels(k_block_lanes), &widest);
  EXPECT_EQ(&manifold_kernels(1000), &widest);
}

// The scalar twins are the meaning of the lanes; here they meet the rules of the whole project.
TEST(ScalarLanes, RoundAsTheProjectDoes) {
  Random random;
  for (int i = 0; i < lockstone::test::share_of(200'000); ++i) {
    const std::int64_t x = test::word(random);
    const int shift = static_cast<int>(random.between(1, 32));
    EXPECT_EQ(scalar::low(scalar::round_shift_low(x, shift)),
              static_cast<std::int32_t>(raw::round_shift_any(x, shift)))
        << x << " by " << shift;
  }
}

TEST(ScalarLanes, RoundWholeWordsAsTheProjectDoes) {
  Random random;
  for (int i = 0; i < lockstone::test::share_of(200'000); ++i) {
    const int shift = static_cast<int>(random.between(1, 62));
    const std::int64_t bound = INT64_MAX - (std::int64_t{1} << (shift - 1));
    const std::int64_t x = std::min(test::word(random), bound);
    EXPECT_EQ(scalar::round_shift(x, shift), raw::round_shift_any(x, shift))
        << x << " by " << shift;
  }
}

// A bound for sizes: the bits of many together are as many as those of the largest has, or one
// fewer.
TEST(ScalarLanes, WithoutTheirSignHaveTheBitsOfTheirSizeOrOneFewer) {
  Random random;
  for (int i = 0; i < lockstone::test::share_of(100'000); ++i) {
    const std::int64_t x = test::word(random);
    const std::int64_t bits = scalar::without_sign(x);
    EXPECT_GE(bits, 0) << x;
    EXPECT_EQ(bits, x < 0 ? -(x + 1) : x);
  }
}

TEST(ScalarLanes, KeepThePositivePartWithinItsRange) {
  Random random;
  for (int i = 0; i < lockstone::test::share_of(200'000); ++i) {
    const std::int64_t x = test::word(random) >> 1;  // below 2^62
    const std::int64_t rounded = raw::round_shift_any(x, 30);
    if (rounded >= std::int64_t{1} << 32) continue;
    const auto most = static_cast<std::int32_t>(random.next() >> 33);
    const std::int64_t wanted = std::clamp<std::int64_t>(rounded, 0, most);
    EXPECT_EQ(scalar::round_shift_positive(x, 30, most), wanted) << x;
  }
}

TEST(ScalarLanes, PackAndSplitOperands) {
  Random random;
  for (int i = 0; i < lockstone::test::share_of(10'000); ++i) {
    const std::int32_t low = test::operand(random), high = test::operand(random);
    const scalar::Lane packed = scalar::pack(low, high);
    EXPECT_EQ(scalar::low(packed), low);
    EXPECT_EQ(scalar::high(packed), high);
  }
}

#if defined(LOCKSTONE_WITH_HIGHWAY)
TEST(WideLanes, ComputeTheSameAsTheirScalarTwins) {
  EXPECT_EQ(test::check_operations(run_seed()), "");
}

TEST(WideLanes, MoveWordsAndRecords) {
  EXPECT_EQ(test::check_memory_operations(run_seed()), "");
}
#endif

TEST(WideKernels, SolveContactRowsAsTheScalarTwinDoes) {
  EXPECT_EQ(test::check_contact_rows(run_seed()), "");
}

TEST(WideKernels, SweepManifoldsAsTheScalarTwinDoes) {
  EXPECT_EQ(test::check_manifolds(run_seed()), "");
}

TEST(WideKernels, SolveBallJointsAsTheScalarTwinDoes) {
  EXPECT_EQ(test::check_balls(run_seed()), "");
}

TEST(WideKernels, MeetBoxesAsTheScalarTwinDoes) {
  EXPECT_EQ(test::check_boxes(run_seed()), "");
}

TEST(WideKernels, SolveIslandsAsTheScalarTwinDoes) {
  EXPECT_EQ(test::check_proximal(run_seed()), "");
}

TEST(WideKernels, MakeTheMatricesOfToMatrix) {
  EXPECT_EQ(test::check_rotations(run_seed()), "");
}

TEST(WideKernels, FindTheFarthestPointAndTheHeightsOfTheScalarTwin) {
  EXPECT_EQ(test::check_points(run_seed()), "");
}

TEST(WideKernels, TakeTheFirstOfEquallyFarPoints) {
  const std::int32_t x[16] = {0, 1, 2, 2, 2, 0, 0, 0, 0, 0, 2, 0, 0, 0, 0, 2};
  const std::int32_t zeros[16] = {};
  EXPECT_EQ(test::on_each_target([&] {
              const Farthest found = farthest_point({x, zeros, zeros, 16}, {3, 0, 0});
              return found == Farthest{2, 6} ? std::string() : std::string("not the first\n");
            }),
            "");
}

}  // namespace
}  // namespace lockstone::lanes
