// Fixed point to floating point: for tools and tests only, where people look at numbers. The only
// place of the project that converts; nothing here may find its way back into a simulation.
#pragma once

#include <lockstone/fixed.h>

namespace lockstone::testing {

/// The value in the quantity's own unit, correctly rounded to double (exact below 2^53 raw).
template <class Dim, class Rep, int FracBits>
[[nodiscard]] constexpr double to_double(Fixed<Dim, Rep, FracBits> value) {
  constexpr double k_scale = static_cast<double>(std::uint64_t{1} << FracBits);
  return static_cast<double>(value.raw) / k_scale;
}

}  // namespace lockstone::testing
