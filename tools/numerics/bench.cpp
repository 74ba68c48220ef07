#include "tools/numerics/bench.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdint>

#include <lockstone/units.h>

#include "core/math/divide.h"
#include "core/math/exponential.h"
#include "core/math/square_roots.h"
#include "core/math/trig.h"
#include "tools/numerics/naive_q16.h"

namespace lockstone::numerics {
namespace {

/// Inputs are Q16.16 values, which every implementation holds exactly: errors are of the function.
/// (float holds those of 24 bits or fewer; wider grids round them, as a caller would.)
struct Grid {
  double low = 0, high = 0;
  double low_y = 1, high_y = 1;
};

constexpr std::int64_t k_points = 20001;
constexpr std::size_t k_timed = 4096;

std::int32_t at(double low, double high, std::int64_t i) {
  const auto first = static_cast<std::int64_t>(std::llround(std::ldexp(low, 16)));
  const auto last = static_cast<std::int64_t>(std::llround(std::ldexp(high, 16)));
  return static_cast<std::int32_t>(first + (last - first) * i / (k_points - 1));
}

struct Inputs {
  std::vector<std::int32_t> x, y;
};

/// y runs through its range in another order than x.
Inputs inputs_of(const Grid& grid) {
  Inputs inputs;
  for (std::int64_t i = 0; i < k_points; ++i) {
    inputs.x.push_back(at(grid.low, grid.high, i));
    inputs.y.push_back(at(grid.low_y, grid.high_y, i * 7919 % k_points));
  }
  return inputs;
}

/// The median time of one call, each on the next input, results added up so that none is dropped.
template <class T, class Function>
double nanoseconds(const std::vector<T>& x, const std::vector<T>& y, int repeats, Function f) {
  using Clock = std::chrono::steady_clock;
  std::vector<double> times;
  volatile std::int64_t sink = 0;
  for (int repeat = 0; repeat < repeats; ++repeat) {
    std::int64_t sum = 0;
    const Clock::time_point start = Clock::now();
    for (std::size_t i = 0; i < k_timed; ++i)
      sum += static_cast<std::int64_t>(f(x[i], y[i]));
    const std::chrono::duration<double, std::nano> spent = Clock::now() - start;
    sink = sink + sum;
    times.push_back(spent.count() / static_cast<double>(k_timed));
  }
  std::nth_element(times.begin(), times.begin() + repeats / 2, times.end());
  return times[static_cast<std::size_t>(repeats / 2)];
}

/// Both arguments in a type, spread over the grid for timing.
template <class T, class Convert>
std::array<std::vector<T>, 2> converted(const Inputs& inputs, Convert convert) {
  std::array<std::vector<T>, 2> both;
  for (std::size_t i = 0; i < inputs.x.size(); ++i) {
    const std::size_t from = i * 4801 % inputs.x.size();
    both[0].push_back(convert(inputs.x[from]));
    both[1].push_back(convert(inputs.y[from]));
  }
  return both;
}

long double real(std::int64_t raw, int bits) {
  return std::ldexp(static_cast<long double>(raw), -bits);
}

/// One function in the four implementations; `ours` from raws with in_bits to a raw with out_bits.
template <class Ours, class Naive, class Libm>
BenchRow measure(const char* name, const Grid& grid, int in_bits, int out_bits, int repeats,
                 Ours ours, Naive naive, Libm libm) {
  const Inputs inputs = inputs_of(grid);
  const auto raw_in = [in_bits](std::int32_t q16) { return q16 * (1 << (in_bits - 16)); };
  std::string format("Q");
  format.append(std::to_string(in_bits)).append(" → Q").append(std::to_string(out_bits));
  BenchRow row{name, format, grid.low, grid.high, {}};
  for (std::size_t i = 0; i < inputs.x.size(); ++i) {
    const std::int32_t x = inputs.x[i], y = inputs.y[i];
    const long double rx = real(x, 16), ry = real(y, 16);
    long double exact = 0;
    if (!exact_value(name, rx, ry, exact)) exact = libm(rx, ry);
    const long double values[] = {
        real(ours(raw_in(x), raw_in(y)), out_bits), real(naive(NaiveQ16{x}, NaiveQ16{y}).raw, 16),
        static_cast<long double>(libm(static_cast<float>(rx), static_cast<float>(ry))),
        static_cast<long double>(libm(static_cast<double>(rx), static_cast<double>(ry)))};
    for (std::size_t k = 0; k < row.results.size(); ++k) {
      const auto error = static_cast<double>(std::fabs(values[k] - exact));
      row.results[k].max_error = std::max(row.results[k].max_error, error);
    }
  }
  const auto a = converted<std::int32_t>(inputs, raw_in);
  const auto b = converted<NaiveQ16>(inputs, [](std::int32_t q) { return NaiveQ16{q}; });
  const auto c = converted<float>(
      inputs, [](std::int32_t q) { return static_cast<float>(std::ldexp(q, -16)); });
  const auto d = converted<double>(inputs, [](std::int32_t q) { return std::ldexp(q, -16); });
  row.results[0].nanoseconds = nanoseconds(a[0], a[1], repeats, ours);
  row.results[1].nanoseconds =
      nanoseconds(b[0], b[1], repeats, [naive](NaiveQ16 x, NaiveQ16 y) { return naive(x, y).raw; });
  // A conversion of the sum's terms to an integer costs the same in both.
  row.results[2].nanoseconds = nanoseconds(c[0], c[1], repeats, libm);
  row.results[3].nanoseconds = nanoseconds(d[0], d[1], repeats, libm);
  return row;
}

using Raw = std::int32_t;
using Q16 = NaiveQ16;

constexpr Q16 k_q16_one{Q16::k_one};

std::vector<BenchRow> bench_algebra(int repeats) {
  return {
      measure(
          "mul", {-40, 40, -40, 40}, 20, 20, repeats,
          [](Raw x, Raw y) {
            return rounded<Number>(Number::from_raw(x) * Number::from_raw(y)).raw;
          },
          [](Q16 x, Q16 y) { return x * y; }, [](auto x, auto y) { return x * y; }),
      measure(
          "div", {-100, 100, 0.1, 10}, 20, 20, repeats,
          [](Raw x, Raw y) { return divide<Number>(Number::from_raw(x), Number::from_raw(y)).raw; },
          [](Q16 x, Q16 y) { return x / y; }, [](auto x, auto y) { return x / y; }),
      measure(
          "reciprocal", {0.01, 100}, 20, 20, repeats,
          [](Raw x, Raw) { return reciprocal<Number>(Number::from_raw(x)).raw; },
          [](Q16 x, Q16) { return k_q16_one / x; }, [](auto x, auto) { return 1 / x; }),
      measure(
          "sqrt", {0, 1000}, 20, 20, repeats,
          [](Raw x, Raw) { return sqrt(Number::from_raw(x)).raw; },
          [](Q16 x, Q16) { return sqrt(x); }, [](auto x, auto) { return std::sqrt(x); }),
      measure(
          "rsqrt", {0.01, 1000}, 20, 20, repeats,
          [](Raw x, Raw) { return rsqrt<Number>(Number::from_raw(x)).raw; },
          [](Q16 x, Q16) { return k_q16_one / sqrt(x); },
          [](auto x, auto) { return 1 / std::sqrt(x); }),
      measure(
          "hypot", {-90, 90, -90, 90}, 20, 20, repeats,
          [](Raw x, Raw y) { return hypot(Number::from_raw(x), Number::from_raw(y)).raw; },
          [](Q16 x, Q16 y) { return hypot(x, y); },
          [](auto x, auto y) { return std::hypot(x, y); }),
      measure(
          "exp2", {-10, 10}, 20, 20, repeats,
          [](Raw x, Raw) { return exp2<Number>(Number::from_raw(x)).raw; },
          [](Q16 x, Q16) { return exp2(x); }, [](auto x, auto) { return std::exp2(x); }),
      measure(
          "log2", {0.01, 1000}, 20, 26, repeats,
          [](Raw x, Raw) { return log2<Logarithm>(Number::from_raw(x)).raw; },
          [](Q16 x, Q16) { return log2(x); }, [](auto x, auto) { return std::log2(x); }),
  };
}

std::vector<BenchRow> bench_angles(int repeats) {
  return {
      measure(
          "sin", {-8, 8}, 27, 30, repeats,
          [](Raw x, Raw) { return sin_cos(Angle::from_raw(x)).sin.raw; },
          [](Q16 x, Q16) { return sin(x); }, [](auto x, auto) { return std::sin(x); }),
      measure(
          "cos", {-8, 8}, 27, 30, repeats,
          [](Raw x, Raw) { return sin_cos(Angle::from_raw(x)).cos.raw; },
          [](Q16 x, Q16) { return cos(x); }, [](auto x, auto) { return std::cos(x); }),
      measure(
          "tan", {-1.5, 1.5}, 27, 20, repeats,
          [](Raw x, Raw) { return tan(Angle::from_raw(x)).raw; }, [](Q16 x, Q16) { return tan(x); },
          [](auto x, auto) { return std::tan(x); }),
      measure(
          "asin", {-1, 1}, 30, 27, repeats, [](Raw x, Raw) { return asin(Unit::from_raw(x)).raw; },
          [](Q16 x, Q16) { return asin(x); }, [](auto x, auto) { return std::asin(x); }),
      measure(
          "acos", {-1, 1}, 30, 27, repeats, [](Raw x, Raw) { return acos(Unit::from_raw(x)).raw; },
          [](Q16 x, Q16) { return acos(x); }, [](auto x, auto) { return std::acos(x); }),
      measure(
          "atan", {-100, 100}, 20, 27, repeats,
          [](Raw x, Raw) { return atan2_raw(x, 1 << 20).raw; }, [](Q16 x, Q16) { return atan(x); },
          [](auto x, auto) { return std::atan(x); }),
      measure(
          "atan2", {-10, 10, -10, 10}, 20, 27, repeats,
          [](Raw x, Raw y) { return atan2_raw(x, y).raw; },
          [](Q16 x, Q16 y) { return atan2(x, y); },
          [](auto x, auto y) { return std::atan2(x, y); }),
  };
}

}  // namespace

std::vector<BenchRow> bench_numerics(int repeats) {
  std::vector<BenchRow> rows = bench_algebra(repeats);
  for (BenchRow& row : bench_angles(repeats))
    rows.push_back(std::move(row));
  return rows;
}

}  // namespace lockstone::numerics
