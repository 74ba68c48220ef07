// Random numbers of the fuzzer: a stream of their own for every index of a seed.
//
// An expression draws once: compilers differ in the order in which they evaluate operands and
// arguments.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/shape.h>

#include "tools/fuzz/real.h"

namespace lockstone::fuzz {

/// SplitMix64: G. Steele, D. Lea, C. Flood, "Fast splittable pseudorandom number generators", 2014.
class Dice {
 public:
  /// Streams of different indices have nothing to do with each other.
  Dice(std::uint64_t seed, std::uint64_t index) : state_(seed) {
    state_ = next() ^ (index * 0xd1342543de82ef95U);
    state_ = next();
  }

  std::uint64_t next() {
    std::uint64_t z = state_ += 0x9e3779b97f4a7c15U;
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
    return z ^ (z >> 31);
  }
  /// Uniform in [low, high].
  std::int64_t between(std::int64_t low, std::int64_t high) {
    return low + static_cast<std::int64_t>(next() % (static_cast<std::uint64_t>(high - low) + 1));
  }
  bool chance(int one_in) { return between(1, one_in) == 1; }
  double uniform(double low, double high) {
    return low + (high - low) * std::ldexp(static_cast<double>(next() >> 11), -53);
  }
  double log_uniform(double low, double high) {
    return std::exp(uniform(std::log(low), std::log(high)));
  }
  Real3 in_cube(double half) {
    const double x = uniform(-half, half), y = uniform(-half, half);
    return {x, y, uniform(-half, half)};
  }
  Real3 direction() {
    Real3 v;
    do
      v = in_cube(1);
    while (norm(v) > 1 || norm(v) < 1e-3);
    return v * (1 / norm(v));
  }
  /// Of a shape, log-uniform and within its bounds.
  Length size(double low, double high) {
    return std::clamp(to_length(log_uniform(low, high)), k_min_shape_size, k_max_shape_size);
  }
  Quat quarter_turns();
  Quat orientation();

 private:
  std::uint64_t state_;
};

/// One of the 24 that map the axes onto each other; with a rounding of 2^-30 in those by thirds.
inline Quat Dice::quarter_turns() {
  Quat q;
  const Unit half = Unit::from_raw(759250125);  // √½
  for (std::int64_t turns = between(0, 3); turns > 0; --turns) {
    Quat quarter{half, {}, {}, half};
    if (chance(2)) quarter = {{}, half, {}, half};
    q = normalized(multiply(q, quarter));
  }
  return q;
}

/// Any; often the identity, upright, a little tilted or by quarter turns.
inline Quat Dice::orientation() {
  if (chance(10)) return {};
  if (chance(10)) return quarter_turns();
  if (chance(10)) {
    const double cosine = uniform(-1, 1);
    return to_quat({0, uniform(-1, 1), 0}, cosine);
  }
  const double tilt = log_uniform(1e-8, 1e-2);
  if (chance(8)) return to_quat(in_cube(tilt), 1);
  const Real3 axis = in_cube(1);
  return to_quat(axis, uniform(-1, 1));
}

}  // namespace lockstone::fuzz
