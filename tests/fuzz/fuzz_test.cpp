// Every parser of bytes from outside, for a moment each: its good examples, the corpus, and
// mutations of both.
//
//   LOCKSTONE_FUZZ_SECONDS=30    how long (without it: a number of inputs, whatever they take)
//   LOCKSTONE_TEST_SEED=…        which mutations
//   LOCKSTONE_FUZZ_LAST=FILE     writes each input there before it is run, and so keeps the one
//   that stopped the program

#include <algorithm>
#include <chrono>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>

#include <gtest/gtest.h>

#include "tests/fuzz/mutate.h"
#include "tests/fuzz/target.h"

namespace lockstone::fuzz {
namespace {

using Clock = std::chrono::steady_clock;

class FuzzTest : public ::testing::TestWithParam<Target> {};

Bytes read_file(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const auto bytes = std::as_bytes(std::span(text));
  return {bytes.begin(), bytes.end()};
}

std::vector<Bytes> read_corpus(std::string_view name) {
  const std::filesystem::path folder = std::filesystem::path(LOCKSTONE_CORPUS) / name;
  std::vector<std::filesystem::path> paths;
  if (std::filesystem::is_directory(folder)) {
    for (const auto& entry : std::filesystem::directory_iterator(folder))
      paths.push_back(entry.path());
  }
  std::sort(paths.begin(), paths.end());
  std::vector<Bytes> corpus;
  std::transform(paths.begin(), paths.end(), std::back_inserter(corpus), read_file);
  return corpus;
}

/// How long to go on: a number of inputs, so that a slow machine proves as much, or a time.
class Budget {
 public:
  Budget() : text_(std::getenv("LOCKSTONE_FUZZ_SECONDS")) {
    if (text_ != nullptr) end_ = Clock::now() + std::chrono::seconds(std::atoi(text_));
  }
  [[nodiscard]] bool spent(std::size_t runs) const {
    constexpr std::size_t k_runs = 400;
    return text_ == nullptr ? runs >= k_runs : runs >= k_runs && Clock::now() >= end_;
  }

 private:
  const char* text_;
  Clock::time_point end_;
};

bool run(const Target& target, const Bytes& bytes) {
  static const char* last = std::getenv("LOCKSTONE_FUZZ_LAST");
  if (last != nullptr) {
    std::ofstream file(last, std::ios::binary | std::ios::trunc);
    file.write(reinterpret_cast<const char*>(bytes.data()),
               static_cast<std::streamsize>(bytes.size()));
  }
  return target.run(bytes);
}

// As they are, and with right checksums.
void run_both(const Target& target, Bytes bytes) {
  (void)run(target, bytes);
  if (target.mend == nullptr) return;
  target.mend(bytes);
  (void)run(target, bytes);
}

TEST_P(FuzzTest, LetsGoodExamplesIn) {
  const std::vector<Bytes> seeds = GetParam().seeds();
  ASSERT_FALSE(seeds.empty());
  for (const Bytes& seed : seeds) {
    EXPECT_TRUE(run(GetParam(), seed));
    if (GetParam().mend == nullptr) continue;
    Bytes mended = seed;
    GetParam().mend(mended);
    EXPECT_EQ(mended, seed) << "nothing was to be set right";
  }
}

TEST_P(FuzzTest, SurvivesItsCorpus) {
  for (const Bytes& bytes : read_corpus(GetParam().name))
    run_both(GetParam(), bytes);
}

TEST(FuzzCorpus, IsThereForAllBytesThatStrangersSend) {
  for (const char* name : {"enet", "log", "secure", "token", "wire"})
    EXPECT_FALSE(read_corpus(name).empty()) << name;
}

TEST_P(FuzzTest, SurvivesMutations) {
  const Target& target = GetParam();
  std::vector<Bytes> pool = target.seeds();
  const std::size_t seeds = pool.size();
  std::ranges::move(read_corpus(target.name), std::back_inserter(pool));
  test::Random random;
  std::size_t runs = 0, refused = 0;
  for (const Budget budget; !budget.spent(runs); ++runs) {
    const std::size_t from = random.next() % 2 == 0 ? seeds : pool.size();
    Bytes bytes = pool[random.next() % from];
    mutate(bytes, pool[random.next() % pool.size()], random);
    if (target.mend != nullptr && random.next() % 4 != 0) target.mend(bytes);
    if (!run(target, bytes)) ++refused;
  }
  std::printf("[ fuzz     ] %zu inputs, %zu refused\n", runs, refused);
  EXPECT_GT(refused, 0U);
}

std::string name_of(const ::testing::TestParamInfo<Target>& info) {
  return std::string(info.param.name);
}

INSTANTIATE_TEST_SUITE_P(All, FuzzTest, ::testing::ValuesIn(targets()), name_of);

}  // namespace
}  // namespace lockstone::fuzz
