// The ids of a tick's manifolds: which contacts find room depends on their order alone.
#include "core/world/phases/narrow/manifold_ids.h"

#include <gtest/gtest.h>

namespace lockstone {
namespace {

constexpr std::uint32_t k_contact_room = 100;
constexpr std::uint32_t k_one_workers_room = k_contact_room + 64;  // of one worker

class ManifoldIdsTest : public ::testing::Test {
 protected:
  void begin(std::uint32_t workers) {
    ids_.prepare(k_contact_room, workers, false);
    ids_.begin(workers, false);
  }
  std::uint32_t take(std::uint32_t count) { return ids_.take(ids_.scratch(0), count); }
  void take_each(std::uint32_t count) {
    for (std::uint32_t i = 0; i < count; ++i)
      EXPECT_NE(take(1), ManifoldIds::k_none);
  }

  ManifoldIds ids_;
};

TEST_F(ManifoldIdsTest, OfOneWorkerLeaveNoGapWhereOneIsGivenBack) {
  begin(1);
  EXPECT_EQ(take(1), 0U);
  ManifoldIds::release(ids_.scratch(0), 0);
  EXPECT_EQ(take(36), 0U);
  EXPECT_EQ(take(1), 36U);
  EXPECT_EQ(ids_.taken(), 37U);
}

TEST_F(ManifoldIdsTest, OfOneWorkerEndWithItsRoom) {
  begin(1);
  EXPECT_EQ(take(k_one_workers_room - 1), 0U);
  EXPECT_EQ(take(2), ManifoldIds::k_none);
  EXPECT_EQ(take(1), ManifoldIds::k_none);  // a later contact has no place before an earlier one
  EXPECT_TRUE(ids_.is_out_of_ids());
}

TEST_F(ManifoldIdsTest, OfSeveralWorkersAreNoMoreThanThoseOfOne) {
  begin(4);
  take_each(k_one_workers_room);
  EXPECT_FALSE(ids_.is_out_of_ids());
  take_each(1);
  EXPECT_TRUE(ids_.is_out_of_ids());
}

TEST_F(ManifoldIdsTest, OfOneWorkerAreAsManyAfterSeveral) {
  begin(4);
  begin(1);
  take_each(k_one_workers_room);
  EXPECT_EQ(take(1), ManifoldIds::k_none);
}

}  // namespace
}  // namespace lockstone
