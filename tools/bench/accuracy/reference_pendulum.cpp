#include "tools/bench/accuracy/reference_pendulum.h"

#include <cmath>
#include <numbers>

namespace lockstone::bench {
namespace {

using State = std::array<double, 4>;  // two angles from straight down, and their rates

State slope(const State& s, double gravity, double gyration) {
  const double delta = s[0] - s[1], c = std::cos(delta), sine = std::sin(delta);
  const double a = 2 + gyration, d = 1 + gyration, det = a * d - c * c;
  const double p = -sine * s[3] * s[3] - 2 * gravity * std::sin(s[0]);
  const double q = sine * s[2] * s[2] - gravity * std::sin(s[1]);
  return {s[2], s[3], (p * d - c * q) / det, (a * q - c * p) / det};
}

State moved(const State& s, const State& slope, double h) {
  State result;
  for (std::size_t i = 0; i < 4; ++i)
    result[i] = s[i] + h * slope[i];
  return result;
}

}  // namespace

double elliptic_k(double modulus) {
  double a = 1, b = std::sqrt(1 - modulus * modulus);
  for (int i = 0; i < 8; ++i) {
    const double mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return std::numbers::pi / (2 * a);
}

std::array<double, 2> double_pendulum_angles(double seconds, double gravity, double gyration) {
  constexpr double h = 1e-6;
  State s{std::numbers::pi / 2, std::numbers::pi / 2, 0, 0};
  for (long left = std::lround(seconds / h); left > 0; --left) {
    const State k1 = slope(s, gravity, gyration);
    const State k2 = slope(moved(s, k1, h / 2), gravity, gyration);
    const State k3 = slope(moved(s, k2, h / 2), gravity, gyration);
    const State k4 = slope(moved(s, k3, h), gravity, gyration);
    for (std::size_t j = 0; j < 4; ++j)
      s[j] += h / 6 * (k1[j] + 2 * k2[j] + 2 * k3[j] + k4[j]);
  }
  return {s[0], s[1]};
}

}  // namespace lockstone::bench
