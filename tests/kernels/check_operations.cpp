#include <algorithm>
#include <numeric>
#include <vector>

#include "core/kernels/target.h"
#include "core/math/wide/scalar_lanes.h"
#include "tests/kernels/check.h"
#include "tests/kernels/operations.h"
#include "tests/kernels/values.h"
#include "tests/support/workload.h"

namespace lockstone::lanes::test {
namespace {

using lockstone::test::Random;

constexpr int k_rounds = lockstone::test::share_of(40000);

struct Expected {
  std::int64_t value;
  std::uint64_t counting_bits;
};

Expected compute_scalar(Operation operation, const Operands& in, std::size_t lane) {
  using namespace scalar;  // NOLINT(google-build-using-namespace): the table's expressions
  const Lane a = in.a[lane], b = in.b[lane], c = in.c[lane];
  const Lane shift = in.shift[lane], far = in.far[lane];
  switch (operation) {
#define LKS_LANE_CASE(name, wide, one, counting) \
  case Operation::name:                          \
    return {one, counting};
    LKS_LANE_OPERATIONS(LKS_LANE_CASE)
#undef LKS_LANE_CASE
    case Operation::count:
      break;
  }
  return {0, 0};
}

bool runs_here(const TargetOperations& operations) {
  const auto names = supported_targets();
  return std::find(names.begin(), names.end(), operations.target) != names.end();
}

Operands random_operands(Random& random) {
  Operands in;
  for (std::size_t lane = 0; lane < k_most_lanes; ++lane) {
    in.a[lane] = word(random);
    in.b[lane] = random.next() % 8 == 0 ? in.a[lane] : word(random);
    in.c[lane] = word(random);
    in.shift[lane] = random.between(1, 32);
    in.half[lane] = std::int64_t{1} << (in.shift[lane] - 1);
    in.far[lane] = random.between(1, 62);
    in.far_half[lane] = std::int64_t{1} << (in.far[lane] - 1);
  }
  return in;
}

std::string compare(const TargetOperations& target, Operation operation, const Operands& in) {
  Values out{};
  target.compute(operation, in, out);
  for (std::size_t lane = 0; lane < target.lanes; ++lane) {
    const Expected expected = compute_scalar(operation, in, lane);
    const auto difference = static_cast<std::uint64_t>(out[lane] ^ expected.value);
    if ((difference & expected.counting_bits) == 0) continue;
    return std::string(target.target) + " " + std::string(name_of(operation)) + " of " +
           std::to_string(in.a[lane]) + ", " + std::to_string(in.b[lane]) + ", " +
           std::to_string(in.c[lane]) + ": " + std::to_string(out[lane]) + ", expected " +
           std::to_string(expected.value) + "\n";
  }
  return {};
}

std::string complain_unless(bool right, const TargetOperations& target, const char* what) {
  return right ? std::string() : std::string(target.target) + " " + what + "\n";
}

// A third of the time a is less in few lanes or in none.
std::string compare_order(const TargetOperations& target, Operands in, Random& random) {
  if (random.next() % 3 == 0)
    for (std::size_t lane = 0; lane < k_most_lanes; ++lane)
      if (random.next() % 8 != 0) in.a[lane] = std::max(in.a[lane], in.b[lane]);
  std::uint32_t bits = 0;
  for (std::size_t lane = 0; lane < target.lanes; ++lane)
    bits |= scalar::bits_of_less(in.a[lane], in.b[lane]) << lane;
  return complain_unless(target.bits_of_less(in) == bits, target, "bits_of_less") +
         complain_unless(target.any_less(in) == (bits != 0), target, "any_less");
}

template <class Index>
std::vector<Index> shuffled(Index count, Random& random) {
  std::vector<Index> indices(static_cast<std::size_t>(count));
  std::iota(indices.begin(), indices.end(), Index{0});
  for (std::size_t i = indices.size(); i > 1; --i) {
    std::swap(indices[i - 1], indices[random.next() % i]);
  }
  return indices;
}

// Table is a std::vector of int32 or int64; Index is of the same width.
template <class Word, class Gather, class Scatter>
std::string check_fields(const TargetOperations& target, Gather gather, Scatter scatter,
                         Random& random) {
  std::vector<Word> table(64);
  for (Word& entry : table)
    entry = static_cast<Word>(word(random));
  const std::vector<Word> index = shuffled<Word>(64, random);
  Values out{};
  gather(table.data(), index.data(), out);
  bool right = true;
  std::vector<Word> wanted = table;
  Values written{};
  for (std::size_t lane = 0; lane < target.lanes; ++lane) {
    const auto at = static_cast<std::size_t>(index[lane]);
    right = right && out[lane] == table[at];
    written[lane] = word(random);
    wanted[at] = static_cast<Word>(written[lane]);
  }
  scatter(written, table.data(), index.data());
  return complain_unless(right, target, "gather") +
         complain_unless(table == wanted, target, "scatter");
}

std::string check_records(const TargetOperations& target, std::size_t stride, Random& random) {
  std::vector<std::int64_t> records(32 * stride);
  for (std::int64_t& entry : records)
    entry = word(random);
  const std::vector<std::uint32_t> index = shuffled<std::uint32_t>(32, random);
  Values words[4]{};
  target.load_four(records.data(), index.data(), stride, words);
  std::vector<std::int64_t> wanted = records;
  Values written[4]{};
  bool right = true;
  for (std::size_t i = 0; i < 4; ++i) {
    for (std::size_t lane = 0; lane < target.lanes; ++lane) {
      const std::size_t at = index[lane] * stride + i;
      right = right && words[i][lane] == records[at];
      written[i][lane] = wanted[at] = word(random);
    }
  }
  target.store_four(written, records.data(), index.data(), stride);
  return complain_unless(right, target, "load_four") +
         complain_unless(records == wanted, target, "store_four");
}

}  // namespace

std::string check_operations(std::uint64_t seed) {
  Random random(seed);
  std::string report;
  for (int round = 0; round < k_rounds && report.empty(); ++round) {
    const Operands in = random_operands(random);
    for (const TargetOperations& target : compiled_operations()) {
      if (!runs_here(target)) continue;
      for (int i = 0; i < static_cast<int>(Operation::count); ++i) {
        report += compare(target, static_cast<Operation>(i), in);
      }
      report += compare_order(target, in, random);
    }
  }
  return report;
}

std::string check_memory_operations(std::uint64_t seed) {
  Random random(seed);
  std::string report;
  for (const TargetOperations& target : compiled_operations()) {
    if (!runs_here(target)) continue;
    for (int round = 0; round < 200 && report.empty(); ++round) {
      report += check_fields<std::int64_t>(target, target.gather_64, target.scatter_64, random);
      report += check_fields<std::int32_t>(target, target.gather_32, target.scatter_32, random);
      report += check_records(target, 4, random) + check_records(target, 9, random);
    }
  }
  return report;
}

}  // namespace lockstone::lanes::test
