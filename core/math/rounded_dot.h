// The part of a 64-bit vector along a direction.
#pragma once

#include <cstdint>

#include <lockstone/fixed.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// v · direction as raw bits of v's type, each of the three products rounded; for a unit vector and
/// |v| below half the range of 64 bits.
template <class Dim, int FracBits>
[[nodiscard]] constexpr std::int64_t rounded_dot(const Vec3<Fixed<Dim, std::int64_t, FracBits>>& v,
                                                 const Vec3<Unit>& direction) {
  std::int64_t sum = 0;
  for (int i = 0; i < 3; ++i)
    sum += raw::multiply_shift(v[i].raw, direction[i].raw, Unit::frac_bits);
  return sum;
}

}  // namespace lockstone
