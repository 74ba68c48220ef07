#include "core/math/sym_mat3.h"

#include <algorithm>

namespace lockstone {
namespace {

/// The adjugate and the determinant, exact. With positive minors every entry is below 2^63.
struct Adjugate {
  SymMat3<std::int64_t> minors;
  Int128 determinant;
};

std::int64_t product(std::int32_t a, std::int32_t b) {
  return std::int64_t{a} * b;
}

Adjugate adjugate(const RawSymMat3& s) {
  Adjugate a;
  a.minors = {product(s.yy, s.zz) - product(s.yz, s.yz), product(s.xx, s.zz) - product(s.xz, s.xz),
              product(s.xx, s.yy) - product(s.xy, s.xy), product(s.xz, s.yz) - product(s.xy, s.zz),
              product(s.xy, s.yz) - product(s.xz, s.yy), product(s.xy, s.xz) - product(s.yz, s.xx)};
  a.determinant = multiply_wide(std::int64_t{s.xx}, a.minors.xx) +
                  multiply_wide(std::int64_t{s.xy}, a.minors.xy) +
                  multiply_wide(std::int64_t{s.xz}, a.minors.xz);
  return a;
}

bool has_positive_minors(const RawSymMat3& s) {
  return s.xx > 0 && s.yy > 0 && s.zz > 0 && product(s.xx, s.yy) > product(s.xy, s.xy) &&
         product(s.xx, s.zz) > product(s.xz, s.xz) && product(s.yy, s.zz) > product(s.yz, s.yz);
}

int bit_length(UInt128 x) {
  return 128 - countl_zero(x);
}

/// ⌊n · 2^shift / d⌉, ties up, at most 2^63 − 1; n < 2^126, 0 < d < 2^126. Bit by bit: the divisor
/// is longer than a word, and inverses are taken when a body is made, not in a tick.
std::uint64_t round_quotient(UInt128 n, int shift, UInt128 d) {
  constexpr std::uint64_t bound = 0x7fffffffffffffff;
  const int quotient_bits = bit_length(n) + shift - bit_length(d) + 1;  // or one less
  if (n == UInt128{} || quotient_bits < 0) return 0;
  if (quotient_bits > 65) return bound;
  if (shift < 0) d = d << -shift;
  const int taken = std::min(bit_length(n), bit_length(d) - 1);
  UInt128 rest = n >> (bit_length(n) - taken);
  UInt128 quotient;
  for (int i = bit_length(n) - taken + std::max(shift, 0) - 1; i >= 0; --i) {
    const int at = i - std::max(shift, 0);
    rest = (rest << 1) + UInt128{0, at >= 0 ? (n >> at).low & 1 : 0};
    const bool bit = rest >= d;
    if (bit) rest = rest - d;
    quotient = (quotient << 1) + UInt128{0, bit ? std::uint64_t{1} : 0};
  }
  if (rest >= d - rest) quotient = quotient + UInt128{0, 1};
  return quotient > UInt128{0, bound} ? bound : quotient.low;
}

/// The exponent that brings minor · 2^frac_bits / determinant, divided by 2^(2·exponent), into
/// (⅛, 1): the quotient is between 2^(length − 1) and 2^(length + 1).
int axis_exponent(std::int64_t minor, UInt128 determinant, int frac_bits) {
  const int length =
      bit_length({0, static_cast<std::uint64_t>(minor)}) + frac_bits - bit_length(determinant);
  return (length + 2) >> 1;
}

}  // namespace

RawSymMat3 rotate_raw(const Mat3& r, const RawSymMat3& s) {
  // Row a of r·s, exact: |row of r| is 1, so below √3 · 2^61.
  const auto row = [&s](std::int64_t x, std::int64_t y, std::int64_t z) {
    return Vec3<std::int64_t>{x * s.xx + y * s.xy + z * s.xz, x * s.xy + y * s.yy + z * s.yz,
                              x * s.xz + y * s.yz + z * s.zz};
  };
  const auto entry = [](const Vec3<std::int64_t>& left, Unit x, Unit y, Unit z) {
    const Int128 sum = multiply_wide(left.x, std::int64_t{x.raw}) +
                       multiply_wide(left.y, std::int64_t{y.raw}) +
                       multiply_wide(left.z, std::int64_t{z.raw});
    const std::int64_t rounded = saturate_to_int64(round_shift(sum, 60));
    LKS_ASSERT(rounded == raw::saturate<std::int32_t>(rounded));
    return static_cast<std::int32_t>(rounded);
  };
  const Vec3<std::int64_t> x = row(r.x.x.raw, r.y.x.raw, r.z.x.raw);
  const Vec3<std::int64_t> y = row(r.x.y.raw, r.y.y.raw, r.z.y.raw);
  const Vec3<std::int64_t> z = row(r.x.z.raw, r.y.z.raw, r.z.z.raw);
  return {entry(x, r.x.x, r.y.x, r.z.x), entry(y, r.x.y, r.y.y, r.z.y),
          entry(z, r.x.z, r.y.z, r.z.z), entry(x, r.x.y, r.y.y, r.z.y),
          entry(x, r.x.z, r.y.z, r.z.z), entry(y, r.x.z, r.y.z, r.z.z)};
}

bool is_positive_definite(const RawSymMat3& s) {
  return has_positive_minors(s) && adjugate(s).determinant > Int128{};
}

EquilibratedSymMat3 inverse_raw(const RawSymMat3& s, int frac_bits) {
  const bool invertible = is_positive_definite(s);
  LKS_ASSERT(invertible);
  if (!invertible) return {};
  const auto [minors, signed_determinant] = adjugate(s);
  const UInt128 determinant = magnitude(signed_determinant);
  const int x = axis_exponent(minors.xx, determinant, frac_bits);
  const int y = axis_exponent(minors.yy, determinant, frac_bits);
  const int z = axis_exponent(minors.zz, determinant, frac_bits);
  const auto entry = [&](std::int64_t minor, int exponent) {
    const int shift = frac_bits + Unit::frac_bits - exponent;
    const auto size =
        static_cast<std::int32_t>(round_quotient({0, magnitude(minor)}, shift, determinant));
    return Unit::from_raw(minor < 0 ? -size : size);
  };
  return {{entry(minors.xx, 2 * x), entry(minors.yy, 2 * y), entry(minors.zz, 2 * z),
           entry(minors.xy, x + y), entry(minors.xz, x + z), entry(minors.yz, y + z)},
          {static_cast<std::int8_t>(x), static_cast<std::int8_t>(y), static_cast<std::int8_t>(z)}};
}

Vec3<std::int64_t> solve_raw_saturating(const RawSymMat3& s, const Vec3<std::int32_t>& b,
                                        int shift) {
  const bool solvable = is_positive_definite(s);
  LKS_ASSERT(solvable && shift >= -96 && shift <= 96);
  if (!solvable) return {};
  const auto [minors, determinant] = adjugate(s);
  const UInt128 divisor = magnitude(determinant);
  const auto component = [&](std::int64_t x, std::int64_t y, std::int64_t z) {
    const Int128 sum = multiply_wide(x, std::int64_t{b.x}) + multiply_wide(y, std::int64_t{b.y}) +
                       multiply_wide(z, std::int64_t{b.z});
    const auto size = static_cast<std::int64_t>(round_quotient(magnitude(sum), shift, divisor));
    return sum.negative() ? -size : size;
  };
  return {component(minors.xx, minors.xy, minors.xz), component(minors.xy, minors.yy, minors.yz),
          component(minors.xz, minors.yz, minors.zz)};
}

}  // namespace lockstone
