// Random worlds with every kind of vectors: a few of them here, as many as asked for by
// `lockstone fuzz-vectors`.
#include <gtest/gtest.h>

#include "core/kernels/target.h"
#include "tests/support/random.h"
#include "tests/support/workload.h"
#include "tools/fuzz/vector_fuzz.h"

namespace lockstone::fuzz {
namespace {

TEST(FuzzVectors, OfARandomSeedComputeTheSameWithEveryKind) {
  VectorFuzzOptions options;
  options.seed = test::run_seed();
  options.count = test::share_of(std::uint64_t{8});
  options.ticks = 40;
  const VectorFuzzReport report = fuzz_vectors(options);
  EXPECT_EQ(report.worlds, options.count);
  EXPECT_EQ(report.kinds, lanes::supported_targets().size());
  for (const VectorFailure& failure : report.failures)
    ADD_FAILURE() << "world " << failure.index << " of seed " << options.seed << ", tick "
                  << failure.tick << " with " << failure.vectors << ": " << failure.what;
}

TEST(FuzzVectors, PrintADigestThatFollowsFromTheWorldsAlone) {
  VectorFuzzOptions options;
  options.count = 4;
  options.ticks = 10;
  const VectorFuzzReport one = fuzz_vectors(options);
  options.threads = 3;
  EXPECT_EQ(fuzz_vectors(options).digest, one.digest);
  options.first = 1;
  EXPECT_NE(fuzz_vectors(options).digest, one.digest);
}

}  // namespace
}  // namespace lockstone::fuzz
