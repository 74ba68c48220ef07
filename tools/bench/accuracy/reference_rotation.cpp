#include "tools/bench/accuracy/reference_rotation.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace lockstone::bench {
namespace {

Long3 scaled(const Long3& v, Long s) {
  return {v[0] * s, v[1] * s, v[2] * s};
}
Long3 sum(const Long3& a, const Long3& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
Long3 cross(const Long3& a, const Long3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

// ω in the world.
Long3 angular_velocity(const FreeBody& body, const LongQuat& q) {
  Long3 v = rotate(conjugate(q), body.momentum);
  for (std::size_t i = 0; i < 3; ++i)
    v[i] /= body.moments[i];
  return rotate(q, v);
}

// Both within (0, 1].
Long arithmetic_geometric_mean(Long a, Long b) {
  while (std::abs(a - b) > 1e-18L * a) {
    const Long mean = (a + b) / 2;
    b = std::sqrt(a * b);
    a = mean;
  }
  return a;
}

}  // namespace

LongQuat multiply(const LongQuat& a, const LongQuat& b) {
  return {
      a.w * b.x + a.x * b.w + a.y * b.z - a.z * b.y, a.w * b.y - a.x * b.z + a.y * b.w + a.z * b.x,
      a.w * b.z + a.x * b.y - a.y * b.x + a.z * b.w, a.w * b.w - a.x * b.x - a.y * b.y - a.z * b.z};
}

LongQuat conjugate(const LongQuat& q) {
  return {-q.x, -q.y, -q.z, q.w};
}

LongQuat exponential(const Long3& v) {
  const Long angle = std::sqrt(dot(v, v));
  const Long ratio = angle == 0 ? 0.5L : std::sin(angle / 2) / angle;
  return {v[0] * ratio, v[1] * ratio, v[2] * ratio, std::cos(angle / 2)};
}

Long3 rotate(const LongQuat& q, const Long3& v) {
  const LongQuat r = multiply(multiply(q, {v[0], v[1], v[2], 0}), conjugate(q));
  return {r.x, r.y, r.z};
}

Long angle_between(const LongQuat& a, const LongQuat& b) {
  const LongQuat d = multiply(conjugate(a), b);
  return 2 * std::atan2(std::sqrt(d.x * d.x + d.y * d.y + d.z * d.z), std::abs(d.w));
}

Long energy(const FreeBody& body, const LongQuat& q) {
  return dot(angular_velocity(body, q), body.momentum) / 2;
}

LongQuat turn_freely(const FreeBody& body, const LongQuat& start, Long seconds, int steps) {
  const Long h = seconds / steps;
  LongQuat q = start;
  const auto slope = [&](const Long3& turned) {
    return scaled(angular_velocity(body, multiply(exponential(turned), q)), h);
  };
  for (int i = 0; i < steps; ++i) {
    const Long3 k1 = slope({});
    const Long3 k2 = slope(scaled(k1, 0.5L));
    const Long3 k3 = slope(sum(scaled(k2, 0.5L), scaled(cross(k1, k2), -0.125L)));
    const Long3 k4 = slope(k3);
    const Long3 mean = scaled(sum(sum(k1, k4), scaled(sum(k2, k3), 2)), 1 / Long{6});
    q = multiply(exponential(sum(mean, scaled(cross(k1, k4), -1 / Long{12}))), q);
  }
  return q;
}

FlipTimes flip_times(const Long3& moments, Long momentum_squared, Long twice_energy) {
  const auto [i1, i2, i3] = moments;
  const Long rate_squared = (i3 - i2) * (momentum_squared - twice_energy * i1);
  // 1 − k²
  const Long complement = (i3 - i1) * (momentum_squared - twice_energy * i2) / rate_squared;
  const Long quarter =
      std::numbers::pi_v<Long> / (2 * arithmetic_geometric_mean(1, std::sqrt(complement)));
  const Long first = quarter / std::sqrt(rate_squared / (i1 * i2 * i3));
  return {first, 2 * first};
}

}  // namespace lockstone::bench
