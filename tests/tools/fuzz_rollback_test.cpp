// Random rollbacks: a few of them here, as many as asked for by `lockstone fuzz-rollback`.
#include <gtest/gtest.h>

#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tools/fuzz/rollback_fuzz.h"

namespace lockstone::fuzz {
namespace {

TEST(FuzzRollbacks, OfARandomSeedGiveTheStatesOfAFullSimulation) {
  RollbackFuzzOptions options;
  options.seed = test::run_seed();
  options.count = test::share_of(std::uint64_t{16});
  options.rounds = test::share_of(20U);
  const RollbackFuzzReport report = fuzz_rollbacks(options);
  EXPECT_EQ(report.worlds, options.count);
  EXPECT_GT(report.recalled_islands, 0U);
  for (const RollbackFailure& failure : report.failures)
    ADD_FAILURE() << "world " << failure.index << " of seed " << options.seed << ", tick "
                  << failure.tick << ": " << failure.what;
}

TEST(FuzzRollbacks, AreTheSameOnAnyNumberOfThreads) {
  RollbackFuzzOptions options;
  options.count = 4;
  options.rounds = 4;
  const RollbackFuzzReport one = fuzz_rollbacks(options);
  options.threads = 3;
  const RollbackFuzzReport three = fuzz_rollbacks(options);
  EXPECT_EQ(one.ticks, three.ticks);
  EXPECT_EQ(one.computed_islands, three.computed_islands);
  EXPECT_EQ(one.recalled_islands, three.recalled_islands);
}

}  // namespace
}  // namespace lockstone::fuzz
