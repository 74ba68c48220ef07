// Time and error of the elementary functions, beside a plain Q16.16 and libm.
#pragma once

#include <array>
#include <string>
#include <vector>

namespace lockstone::numerics {

struct Measured {
  double nanoseconds = 0;  ///< median of the repeats
  double max_error = 0;    ///< absolute, over the grid
};

inline constexpr std::array<const char*, 4> k_implementations = {"lockstone", "naive Q16.16",
                                                                 "float", "double"};

struct BenchRow {
  std::string function;
  std::string format;        ///< ours, inputs → output
  double low = 0, high = 0;  ///< of the first argument
  std::array<Measured, 4> results;
};

[[nodiscard]] std::vector<BenchRow> bench_numerics(int repeats);

/// Where the exact values come from.
[[nodiscard]] const char* exact_source();

/// The value of a function of the bench by MPFR; false when this build has none.
[[nodiscard]] bool exact_value(const std::string& function, long double x, long double y,
                               long double& value);

}  // namespace lockstone::numerics
