// The checks as a program by itself: no framework, can be linked statically and run by an emulator.
#include <cstdio>

#include "core/kernels/target.h"
#include "tests/kernels/check.h"
#include "tests/support/random.h"

int main() {
  namespace lanes = lockstone::lanes;
  std::printf("targets:");
  for (const std::string_view name : lanes::supported_targets()) {
    std::printf(" %.*s", static_cast<int>(name.size()), name.data());
  }
  std::printf("\n");
  const std::uint64_t seed = lockstone::test::run_seed();
  const std::string report = lanes::test::check_operations(seed) +
                             lanes::test::check_memory_operations(seed) +
                             lanes::test::check_contact_rows(seed) +
                             lanes::test::check_rotations(seed) + lanes::test::check_points(seed) +
                             lanes::test::check_manifolds(seed) + lanes::test::check_balls(seed) +
                             lanes::test::check_boxes(seed) + lanes::test::check_proximal(seed);
  std::printf("%s%s\n", report.c_str(), report.empty() ? "all equal" : "different");
  return report.empty() ? 0 : 1;
}
