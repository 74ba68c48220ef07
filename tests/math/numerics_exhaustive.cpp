// Every input of the functions of one 32-bit argument, against the exact value.
//
// usage: numerics_exhaustive [--threads N] [--stride N] [NAME…]
//
// Roots and quotients are compared in whole numbers. The others are compared with libm in double
// precision, whose error is below 2^-20 of our last place, and where that could hide a wrong
// rounding, with 200 bits of MPFR. Prints the largest
// error in last places and how many results are not the nearest; exit 1 when a bound is broken.
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <functional>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include "core/math/divide.h"
#include "core/math/exponential.h"
#include "core/math/square_roots.h"
#include "core/math/trig.h"
#include "tests/math/reference.h"

namespace lockstone::test {
namespace {

__extension__ typedef __int128 Wide;
__extension__ typedef unsigned __int128 UWide;

constexpr std::int64_t k_low = -(std::int64_t{1} << 31);
constexpr std::int64_t k_high = (std::int64_t{1} << 31) - 1;
constexpr std::int64_t k_one = std::int64_t{1} << 30;

struct Worst {
  double error = 0;  ///< last places
  std::int64_t input = 0;
  std::uint64_t inputs = 0;
  std::uint64_t not_nearest = 0;

  void add(std::int64_t raw, double e) {
    ++inputs;
    if (e > 0.5) ++not_nearest;
    if (e <= error) return;
    error = e;
    input = raw;
  }
  void merge(const Worst& other) {
    inputs += other.inputs;
    not_nearest += other.not_nearest;
    if (other.error <= error) return;
    error = other.error;
    input = other.input;
  }
};

/// Some inputs of one function: from `first` to `last` in steps of `stride`.
struct Span {
  std::int64_t first, last, stride;
};

struct Case {
  std::string name;
  std::int64_t first, last;
  double bound;  ///< largest permitted error
  std::function<Worst(Span)> run;
};

/// How far `ours` is from `value` (in last places), and the nearest bound beyond ±(2^31 − 1).
double error_of(std::int64_t ours, double value) {
  if (value > static_cast<double>(k_high)) value = static_cast<double>(k_high);
  if (value < -static_cast<double>(k_high)) value = -static_cast<double>(k_high);
  return std::fabs(static_cast<double>(ours) - value);
}

/// libm decides unless the error is ½ but for a few of its own last places: results stay below 2^31
/// of ours, so one of its is at most 2^-22 of ours.
bool needs_proof(double error) {
  return std::fabs(error - 0.5) < 0x1p-19;
}

enum class Symmetry { none, odd, even };

/// Whether f(−x) obeys the symmetry: then the slow references are asked for one half only.
template <class Ours>
bool is_symmetric(Symmetry symmetry, Ours ours, std::int64_t raw, std::int64_t result) {
  if (symmetry == Symmetry::none || -raw > k_high) return true;
  const std::int64_t mirrored = ours(static_cast<std::int32_t>(-raw));
  return mirrored == (symmetry == Symmetry::odd ? -result : result);
}

/// A function given by our result, by libm and by MPFR.
template <class Ours, class Libm, class Exact>
Case measured(std::string name, Span range, Symmetry symmetry, int in_bits, int out_bits,
              double bound, Ours ours, Libm libm, Exact exact) {
  const auto run = [=](Span span) {
    Worst worst;
    const double in_place = std::ldexp(1.0, -in_bits), out_scale = std::ldexp(1.0, out_bits);
    for (std::int64_t raw = span.first; raw <= span.last; raw += span.stride) {
      const std::int64_t result = ours(static_cast<std::int32_t>(raw));
      const double x = static_cast<double>(raw) * in_place;
      double error = error_of(result, libm(x) * out_scale);
      const bool at_bound = result == k_high || result == -k_high;
      if (needs_proof(error) && !at_bound) {
        error = exact(Real(raw, in_bits)).error_of(result, out_bits);
      }
      if (!is_symmetric(symmetry, ours, raw, result)) error = 1e9;
      worst.add(raw, error);
    }
    return worst;
  };
  return {std::move(name), range.first, range.last, bound, run};
}

/// A function whose nearest result is decided in whole numbers.
template <class Nearest>
Case decided(std::string name, Span range, Nearest is_nearest) {
  const auto run = [=](Span span) {
    Worst worst;
    for (std::int64_t raw = span.first; raw <= span.last; raw += span.stride) {
      worst.add(raw, is_nearest(static_cast<std::int32_t>(raw)) ? 0.5 : 1e9);
    }
    return worst;
  };
  return {std::move(name), range.first, range.last, 0.5, run};
}

/// r = ⌊√(n / d)⌉, or the greatest r: (2r − 1)²·d < 4n < (2r + 1)²·d.
bool is_root(std::int64_t r, UWide n, UWide d) {
  if (r < 0) return false;
  const auto u = static_cast<UWide>(r);
  const bool high_enough = r == k_high || 4 * n < (2 * u + 1) * (2 * u + 1) * d;
  return high_enough && (r == 0 || (2 * u - 1) * (2 * u - 1) * d < 4 * n);
}

template <class T>
Case sqrt_case(const char* name) {
  return decided(name, {0, k_high, 1}, [](std::int32_t raw) {
    return is_root(sqrt(T::from_raw(raw)).raw, static_cast<UWide>(raw) << T::frac_bits, 1);
  });
}

template <class T>
Case rsqrt_case(const char* name) {
  return decided(name, {1, k_high, 1}, [](std::int32_t raw) {
    const auto n = UWide{1} << (3 * T::frac_bits);
    return is_root(rsqrt_saturating<T>(T::from_raw(raw)).raw, n, static_cast<UWide>(raw));
  });
}

/// |2n/d − 2q| ≤ 1, and a tie away from zero; the nearest bound when it does not fit.
template <class T>
Case reciprocal_case(const char* name) {
  return decided(name, {k_low, k_high, 1}, [](std::int32_t raw) {
    const Wide q = reciprocal_saturating<T>(T::from_raw(raw)).raw;
    if (raw == 0) return q == k_high;
    const Wide sign = raw < 0 ? -1 : 1;
    const Wide d = sign * raw, n = Wide{1} << (2 * T::frac_bits);
    const Wide nearest = sign * ((2 * n + d) / (2 * d));
    return q == (nearest > k_high ? Wide{k_high} : nearest < k_low ? Wide{k_low} : nearest);
  });
}

std::vector<Case> trigonometry() {
  // The half below zero holds −2^31, which has no mirror image.
  const Span half{k_low, 0, 1}, unit_half{-k_one, 0, 1}, unit{-k_one, k_one, 1};
  constexpr Symmetry none = Symmetry::none, odd = Symmetry::odd, even = Symmetry::even;
  const auto angle = [](std::int32_t raw) { return Angle::from_raw(raw); };
  return {
      measured(
          "sin", half, odd, 27, 30, 0.8, [=](std::int32_t x) { return sin_cos(angle(x)).sin.raw; },
          [](double x) { return std::sin(x); }, [](const Real& x) { return sin(x); }),
      measured(
          "cos", half, even, 27, 30, 0.8, [=](std::int32_t x) { return sin_cos(angle(x)).cos.raw; },
          [](double x) { return std::cos(x); }, [](const Real& x) { return cos(x); }),
      measured(
          "tan", half, odd, 27, 20, 0.5001,
          [=](std::int32_t x) { return tan_saturating(angle(x)).raw; },
          [](double x) { return std::tan(x); }, [](const Real& x) { return tan(x); }),
      measured(
          "asin", unit_half, odd, 30, 27, 0.6,
          [](std::int32_t x) { return asin(Unit::from_raw(x)).raw; },
          [](double x) { return std::asin(x); }, [](const Real& x) { return asin(x); }),
      measured(
          "acos", unit, none, 30, 27, 0.6,
          [](std::int32_t x) { return acos(Unit::from_raw(x)).raw; },
          [](double x) { return std::acos(x); }, [](const Real& x) { return acos(x); }),
  };
}

std::vector<Case> exponentials() {
  constexpr Symmetry none = Symmetry::none;
  const auto power = [](double x) { return std::exp2(x); };
  const auto logarithm = [](double x) { return std::log2(x); };
  const auto exact_power = [](const Real& x) { return exp2(x); };
  const auto exact_logarithm = [](const Real& x) { return log2(x); };
  return {
      measured(
          "exp2_number", {k_low, k_high, 1}, none, 20, 20, 0.5001,
          [](std::int32_t x) { return exp2_saturating<Number>(Number::from_raw(x)).raw; }, power,
          exact_power),
      measured(
          "exp2_unit", {k_low, k_high, 1}, none, 30, 30, 0.5001,
          [](std::int32_t x) { return exp2_saturating<Unit>(Unit::from_raw(x)).raw; }, power,
          exact_power),
      measured(
          "log2_number", {1, k_high, 1}, none, 20, 20, 0.5001,
          [](std::int32_t x) { return log2<Number>(Number::from_raw(x)).raw; }, logarithm,
          exact_logarithm),
      measured(
          "log2_unit", {1, k_high, 1}, none, 30, 26, 0.5001,
          [](std::int32_t x) { return log2<Logarithm>(Unit::from_raw(x)).raw; }, logarithm,
          exact_logarithm),
  };
}

std::vector<Case> all_cases() {
  std::vector<Case> cases = {sqrt_case<Number>("sqrt_number"),
                             sqrt_case<Unit>("sqrt_unit"),
                             sqrt_case<Angle>("sqrt_q27"),
                             rsqrt_case<Number>("rsqrt_number"),
                             rsqrt_case<Unit>("rsqrt_unit"),
                             reciprocal_case<Number>("reciprocal_number"),
                             reciprocal_case<Unit>("reciprocal_unit")};
  for (auto& more : {exponentials(), trigonometry()})
    cases.insert(cases.end(), more.begin(), more.end());
  return cases;
}

struct Options {
  int threads = 1;
  std::int64_t stride = 1;
  std::vector<std::string> names;
};

Options parse(int argc, char** argv) {
  Options options;
  for (int i = 1; i < argc; ++i) {
    const bool has_value = i + 1 < argc;
    if (std::strcmp(argv[i], "--threads") == 0 && has_value) {
      options.threads = std::atoi(argv[++i]);
    } else if (std::strcmp(argv[i], "--stride") == 0 && has_value) {
      options.stride = std::atoll(argv[++i]);
    } else {
      options.names.emplace_back(argv[i]);
    }
  }
  return options;
}

/// Threads take pieces of the range from a counter.
Worst run_case(const Case& work, const Options& options) {
  const std::int64_t piece = options.stride << 20;
  std::atomic<std::int64_t> next{work.first};
  std::mutex mutex;
  Worst worst;
  const auto worker = [&] {
    Worst mine;
    for (std::int64_t at = next.fetch_add(piece); at <= work.last; at = next.fetch_add(piece)) {
      mine.merge(work.run({at, std::min(at + piece - 1, work.last), options.stride}));
    }
    mpfr_free_cache();
    const std::lock_guard lock(mutex);
    worst.merge(mine);
  };
  std::vector<std::thread> threads;
  for (int i = 0; i < options.threads; ++i)
    threads.emplace_back(worker);
  for (std::thread& thread : threads)
    thread.join();
  worst.merge(work.run({work.last, work.last, 1}));
  return worst;
}

bool wanted(const Case& work, const Options& options) {
  if (options.names.empty()) return true;
  for (const std::string& name : options.names)
    if (name == work.name) return true;
  return false;
}

}  // namespace
}  // namespace lockstone::test

int main(int argc, char** argv) {
  using namespace lockstone::test;
  const Options options = parse(argc, argv);
  bool ok = true;
  std::printf("%-18s %11s %11s %12s  %s\n", "function", "inputs", "max error", "not nearest",
              "worst input");
  for (const Case& work : all_cases()) {
    if (!wanted(work, options)) continue;
    const Worst worst = run_case(work, options);
    ok = ok && worst.error <= work.bound;
    std::printf("%-18s %11llu %11.9f %12llu  %lld%s\n", work.name.c_str(),
                static_cast<unsigned long long>(worst.inputs), worst.error,
                static_cast<unsigned long long>(worst.not_nearest),
                static_cast<long long>(worst.input), worst.error <= work.bound ? "" : "  BROKEN");
    std::fflush(stdout);
  }
  return ok ? 0 : 1;
}
