// Exact references for the tests of core/math: MPFR values and a seeded source of raws.
#pragma once

#include <cstdint>
#include <limits>
#include <random>

#include <mpfr.h>

#include "tests/support/random.h"

namespace lockstone::test {

/// A real number with 200 bits. Every operation rounds to nearest, far below any tested bound.
class Real {
 public:
  Real() : Real(std::int64_t{0}) {}
  explicit Real(std::int64_t raw, int frac_bits = 0) {
    mpfr_init2(value_, 200);
    mpfr_set_sj_2exp(value_, raw, -frac_bits, MPFR_RNDN);
  }
  Real(const Real& other) {
    mpfr_init2(value_, 200);
    mpfr_set(value_, other.value_, MPFR_RNDN);
  }
  Real& operator=(const Real& other) {
    mpfr_set(value_, other.value_, MPFR_RNDN);
    return *this;
  }
  ~Real() { mpfr_clear(value_); }

  friend Real operator+(const Real& a, const Real& b) { return apply(mpfr_add, a, b); }
  friend Real operator-(const Real& a, const Real& b) { return apply(mpfr_sub, a, b); }
  friend Real operator*(const Real& a, const Real& b) { return apply(mpfr_mul, a, b); }
  friend Real operator/(const Real& a, const Real& b) { return apply(mpfr_div, a, b); }
  friend Real atan2(const Real& y, const Real& x) { return apply(mpfr_atan2, y, x); }
  friend Real sqrt(const Real& x) { return apply(mpfr_sqrt, x); }
  friend Real sin(const Real& x) { return apply(mpfr_sin, x); }
  friend Real cos(const Real& x) { return apply(mpfr_cos, x); }
  friend Real asin(const Real& x) { return apply(mpfr_asin, x); }
  friend Real acos(const Real& x) { return apply(mpfr_acos, x); }
  friend Real tan(const Real& x) { return apply(mpfr_tan, x); }
  friend Real exp2(const Real& x) { return apply(mpfr_exp2, x); }
  friend Real log2(const Real& x) { return apply(mpfr_log2, x); }
  friend bool operator<(const Real& a, const Real& b) {
    return mpfr_less_p(a.value_, b.value_) != 0;
  }
  [[nodiscard]] bool is_zero() const { return mpfr_zero_p(value_) != 0; }

  /// |raw · 2^-frac_bits − this| in units of 2^-frac_bits.
  [[nodiscard]] double error_of(std::int64_t raw, int frac_bits) const {
    Real difference = Real(raw, frac_bits) - *this;
    mpfr_mul_2si(difference.value_, difference.value_, frac_bits, MPFR_RNDN);
    const double error = mpfr_get_d(difference.value_, MPFR_RNDN);
    return error < 0 ? -error : error;
  }
  [[nodiscard]] double to_double() const { return mpfr_get_d(value_, MPFR_RNDN); }

 private:
  template <class Function>
  static Real apply(Function function, const Real& a, const Real& b) {
    Real result;
    function(result.value_, a.value_, b.value_, MPFR_RNDN);
    return result;
  }
  template <class Function>
  static Real apply(Function function, const Real& a) {
    Real result;
    function(result.value_, a.value_, MPFR_RNDN);
    return result;
  }
  static void mpfr_set_sj_2exp(mpfr_t value, std::int64_t raw, int exponent, mpfr_rnd_t rounding) {
    mpfr_set_si_2exp(value, raw >> 32, exponent + 32, rounding);
    mpfr_t low;
    mpfr_init2(low, 64);
    mpfr_set_ui_2exp(low, static_cast<unsigned long>(raw & 0xffffffff), exponent, rounding);
    mpfr_add(value, value, low, rounding);
    mpfr_clear(low);
  }

  mpfr_t value_;
};

inline constexpr std::int64_t k_min = std::numeric_limits<std::int64_t>::min();
inline constexpr std::int64_t k_max = std::numeric_limits<std::int64_t>::max();

/// Raws of all scales: uniform in the number of bits, with round powers of two and their
/// neighbours.
class Raws {
 public:
  [[nodiscard]] std::uint64_t bits64() { return generator_(); }

  [[nodiscard]] std::uint64_t below_bits(int bits) {
    const int width = static_cast<int>(bits64() % static_cast<std::uint64_t>(bits + 1));
    if (width == 0) return 0;
    const std::uint64_t any = bits64() >> (64 - width);
    const std::uint64_t power = std::uint64_t{1} << (width - 1);
    switch (bits64() % 16) {
      case 0:
        return power;
      case 1:
        return power - 1;
      case 2:
        return power | (power - 1);
      default:
        return any;
    }
  }

  /// |x| < 2^bits, bits ≤ 63.
  [[nodiscard]] std::int64_t signed_below_bits(int bits) {
    const auto size = static_cast<std::int64_t>(below_bits(bits));
    return bits64() % 2 == 0 ? size : -size;
  }

  [[nodiscard]] std::int32_t any32() {
    return static_cast<std::int32_t>(static_cast<std::uint32_t>(bits64()));
  }

 private:
  std::mt19937_64 generator_{run_seed()};
};

inline double worst_of(double worst, double error) {
  return error > worst ? error : worst;
}

}  // namespace lockstone::test
