// With radii a and b, distance L of the centres and s = (a − b) / L, where all else is a
// polynomial:
//   volume          π/3 (L q2 (1 + s²) + 2 (a³ + b³))
//   ∫ y             π/12 (1 − s)² L (L (a² + 2ab + 3b²) + (2 + s)(a + b)(a² + b²))
//   ∫ y²            π/30 (L³ (a² + 3ab + 6b²) + 20 L² b³ + L g + 4 (a⁵ + b⁵) + s³ L² f + s⁴ L q4)
//   ∫ x² + z²       π/30 (8 (a⁵ + b⁵) + L q4 (3 + 6 s² − s⁴))
// with y from the lower centre, qn = aⁿ + aⁿ⁻¹b + … + bⁿ, f = a³ + 2a²b + 3ab² + 4b³ and
// g = a⁴ + a³b + a²b² − 9ab³ + 21b⁴: the sums over both caps and the frustum between them.
#include "core/geometry/shapes/tapered_ends.h"

#include <algorithm>

#include "core/math/int128.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

constexpr std::int64_t k_whole_taper = std::int64_t{1} << k_tapered_bits;

/// x / of, for x ≤ of.
std::int64_t share_of(std::uint64_t x, std::uint64_t of) {
  LKS_ASSERT(x <= of && of > 0);
  return static_cast<std::int64_t>(round_divide(UInt128{0, x} << k_tapered_bits, of));
}

std::int64_t times(std::int64_t x, std::int64_t y) {
  return saturated_product(x, y, k_tapered_bits);
}

std::int64_t quotient(std::int64_t x, std::int64_t y) {
  return round_divide(Int128::from(x) << k_tapered_bits, y);
}

/// All below 512 in size.
class TaperedForm {
 public:
  TaperedForm(std::uint64_t low_radius, std::uint64_t distance, std::uint64_t high_radius)
      : radius_(std::max({low_radius, high_radius, std::uint64_t{1}})) {
    const std::uint64_t least = std::min(low_radius, high_radius);
    const bool nested = radius_ - least >= distance;
    if (nested) low_radius = high_radius = radius_;
    const std::uint64_t whole = nested ? 0 : distance;
    length_ = std::max(whole, radius_);
    a_ = share_of(low_radius, radius_);
    b_ = share_of(high_radius, radius_);
    rho_ = share_of(radius_, length_);
    lambda_ = share_of(whole, length_);
    if (low_radius > high_radius) s_ = share_of(low_radius - high_radius, distance);
    if (low_radius < high_radius) s_ = -share_of(high_radius - low_radius, distance);
    square_ = times(s_, s_);
    weight_ = times(times(lambda_, sum_of_powers(2)), k_whole_taper + square_) +
              2 * times(rho_, power(a_, 3) + power(b_, 3));
  }

  [[nodiscard]] std::uint64_t radius() const { return radius_; }
  [[nodiscard]] std::uint64_t length() const { return length_; }
  [[nodiscard]] std::int64_t volume() const { return weight_; }

  /// Height of the centre of mass above the lower centre, of the distance of the centres.
  [[nodiscard]] std::int64_t centre() const {
    const std::int64_t aa = times(a_, a_), ab = times(a_, b_), bb = times(b_, b_);
    const std::int64_t linear = times(lambda_, aa + 2 * ab + 3 * bb);
    const std::int64_t cubic = times(rho_, times(a_ + b_, aa + bb));
    const std::int64_t rest = k_whole_taper - s_;
    const std::int64_t sum = linear + times(2 * k_whole_taper + s_, cubic);
    return quotient(times(times(rest, rest), sum), 4 * weight_);
  }

  /// Of R².
  [[nodiscard]] std::int64_t axial() const { return quotient(fourth_moment(), 10 * weight_); }

  /// Of M².
  [[nodiscard]] std::int64_t across() const {
    const std::int64_t height = times(centre(), lambda_);
    const std::int64_t of_radius = times(times(rho_, rho_), fourth_moment());
    return quotient(of_radius + 2 * height_moment(), 20 * weight_) - times(height, height);
  }

 private:
  static std::int64_t power(std::int64_t x, int exponent) {
    std::int64_t result = x;
    for (int i = 1; i < exponent; ++i)
      result = times(result, x);
    return result;
  }

  /// aⁿ + aⁿ⁻¹b + … + bⁿ.
  [[nodiscard]] std::int64_t sum_of_powers(int n) const {
    std::int64_t sum = k_whole_taper, of_a = k_whole_taper;
    for (int i = 0; i < n; ++i) {
      of_a = times(of_a, a_);
      sum = times(sum, b_) + of_a;
    }
    return sum;
  }

  [[nodiscard]] std::int64_t fifth_powers() const { return power(a_, 5) + power(b_, 5); }

  /// 15 ∫ r⁴ dy.
  [[nodiscard]] std::int64_t fourth_moment() const {
    const std::int64_t of_slope = 3 * k_whole_taper + 6 * square_ - times(square_, square_);
    return 8 * times(rho_, fifth_powers()) + times(times(lambda_, sum_of_powers(4)), of_slope);
  }

  /// 30 ∫ r² y² dy.
  [[nodiscard]] std::int64_t height_moment() const {
    const std::int64_t aa = times(a_, a_), ab = times(a_, b_), bb = times(b_, b_);
    const std::int64_t f = times(aa, a_ + 2 * b_) + times(bb, 3 * a_ + 4 * b_);
    const std::int64_t g = times(aa, aa + ab + bb) + times(bb, 21 * bb - 9 * ab);
    const std::int64_t l2 = times(lambda_, lambda_), r2 = times(rho_, rho_);
    std::int64_t sum = times(times(l2, lambda_), aa + 3 * ab + 6 * bb);
    sum += times(times(l2, rho_), 20 * times(b_, bb) + times(times(square_, s_), f));
    sum += times(times(lambda_, r2), g + times(times(square_, square_), sum_of_powers(4)));
    return sum + 4 * times(times(rho_, r2), fifth_powers());
  }

  std::uint64_t radius_;
  std::uint64_t length_ = 0;
  std::int64_t a_ = 0, b_ = 0;         // radii, of the greater
  std::int64_t rho_ = 0, lambda_ = 0;  // that and the distance of the centres, of the greater
  std::int64_t s_ = 0, square_ = 0;
  std::int64_t weight_ = 0;
};

}  // namespace

TaperedEnds tapered_ends(const Sizes& size) {
  LKS_ASSERT(size.x >= Length{} && size.y >= Length{} && size.z >= Length{});
  const Length greater = max(size.x, size.z), least = min(size.x, size.z);
  if (greater - least >= size.y) return {0, 0, greater, greater};
  const auto raw = [](Length x) { return static_cast<std::uint64_t>(x.raw); };
  const TaperedForm form(raw(size.x), raw(size.y), raw(size.z));
  const Fine whole = fine(size.y);
  const Fine centre = saturated_product(whole, form.centre(), k_tapered_bits);
  return {-centre, whole - centre, size.x, size.z};
}

Unit TaperedEnds::slope() const {
  if (high == low) return {};
  const Fine fall = fine(low_radius) - fine(high_radius);
  const Int128 whole = Int128::from(fall) << Unit::frac_bits;
  return Unit::from_raw(static_cast<std::int32_t>(round_divide(whole, high - low)));
}

Unit TaperedEnds::rise() const {
  constexpr std::int64_t k_one = std::int64_t{1} << (2 * Unit::frac_bits);
  const std::int64_t square = k_one - std::int64_t{slope().raw} * slope().raw;
  return Unit::from_raw(
      static_cast<std::int32_t>(isqrt_rounded(static_cast<std::uint64_t>(square))));
}

TaperedMass tapered_mass(std::uint64_t low_radius, std::uint64_t distance,
                         std::uint64_t high_radius) {
  const TaperedForm form(low_radius, distance, high_radius);
  return {form.radius(), form.length(), form.volume(), form.axial(), form.across()};
}

}  // namespace lockstone::geometry
