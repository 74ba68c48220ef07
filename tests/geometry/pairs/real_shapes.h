// Shapes in long double, in their own frames: how far they reach along a direction, and how far a
// point is outside.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>

#include "tests/geometry/scene.h"

namespace lockstone::test {

inline const Real k_real_pi = std::acos(Real{-1});

/// A world vector in a rotated frame.
inline RealVec in_frame(const Mat3& rotation, const RealVec& v) {
  return {dot(real(rotation.x), v), dot(real(rotation.y), v), dot(real(rotation.z), v)};
}

template <class Quantity>
double as_double(Quantity x) {
  return static_cast<double>(real(x));
}

/// A rounded box in long double.
struct RealRounded {
  RealVec half;
  Real radius;

  explicit RealRounded(const Shape& shape)
      : half(real(shape.size)), radius(real(shape.fourth_size())) {}

  /// ∫ f(z) A(z) dz over the sections across an axis, each a rectangle rounded by √(r² − t²): by
  /// Gauss and Legendre in the core, by Simpson's rule in the angle of the caps.
  template <class F>
  [[nodiscard]] Real integral(int axis, F f) const {
    const Real a = half[(axis + 1) % 3], b = half[(axis + 2) % 3], c = half[axis];
    const auto area = [&](Real round) {
      return 4 * a * b + 4 * round * (a + b) + k_real_pi * round * round;
    };
    const Real inner = c / std::sqrt(Real{3});  // exact for squares
    Real sum = area(radius) * c * (f(-inner) + f(inner));
    constexpr int k_steps = 512;
    for (int i = 0; i <= k_steps; ++i) {
      const Real angle = k_real_pi / 2 * i / k_steps;
      const Real t = radius * std::sin(angle), round = radius * std::cos(angle);
      const Real weight = i == 0 || i == k_steps ? 1 : 2 + 2 * (i % 2);
      sum += weight * round * area(round) * (f(c + t) + f(-c - t)) * k_real_pi / 2 / k_steps / 3;
    }
    return sum;
  }
  [[nodiscard]] Real volume() const {
    return integral(0, [](Real) { return 1; });
  }
  [[nodiscard]] Real square(int axis) const {
    return integral(axis, [](Real x) { return x * x; });
  }

  [[nodiscard]] Real reach(const RealVec& n) const {
    return std::fabs(n.x) * half.x + std::fabs(n.y) * half.y + std::fabs(n.z) * half.z +
           radius * norm(n);
  }
  /// Distance from the surface, negative inside.
  [[nodiscard]] Real outside(const RealVec& p) const {
    RealVec beyond;
    Real most = -1e30L;
    for (int k = 0; k < 3; ++k) {
      const Real over = std::fabs(p[k]) - half[k];
      most = std::max(most, over);
      beyond[k] = std::max(over, Real{0});
    }
    return (most > 0 ? norm(beyond) : most) - radius;
  }
};

/// The hull of two balls in long double, by sums over slices across its axis.
struct RealTaper {
  Real low_radius, high_radius, length;
  Real centre = 0;  ///< of mass, above the lower ball's

  explicit RealTaper(const Shape& shape)
      : low_radius(real(shape.size.x)),
        high_radius(real(shape.size.z)),
        length(real(shape.size.y)) {
    const Real greater = std::max(low_radius, high_radius);
    if (std::fabs(low_radius - high_radius) >= length) {
      low_radius = high_radius = greater;
      length = 0;
    }
    centre = integral([](Real rr, Real y) { return rr * y; }) /
             integral([](Real rr, Real) { return rr; });
  }

  [[nodiscard]] Real slope() const { return length > 0 ? (low_radius - high_radius) / length : 0; }

  /// ∫ f(r², y) dy, y from the lower ball's centre, by Gauss and Legendre on each piece: exact for
  /// the polynomials at hand.
  template <class F>
  [[nodiscard]] Real integral(F f) const {
    const Real s = slope(), cc = 1 - s * s;
    const Real first = low_radius * s, last = length + high_radius * s;
    const auto of_ball = [](Real r, Real up) { return r * r - up * up; };
    const auto of_side = [&](Real y) {
      const Real share = last > first ? (y - first) / (last - first) : 0;
      const Real r = low_radius + (high_radius - low_radius) * share;
      return r * r * cc;
    };
    return piece(-low_radius, first, [&](Real y) { return f(of_ball(low_radius, y), y); }) +
           piece(first, last, [&](Real y) { return f(of_side(y), y); }) +
           piece(last, length + high_radius,
                 [&](Real y) { return f(of_ball(high_radius, y - length), y); });
  }

  template <class F>
  static Real piece(Real from, Real to, F f) {
    const std::array<Real, 3> places{0, 0.538469310105683091036314420700208805L,
                                     0.906179845938663992797626878299392965L};
    const std::array<Real, 3> weights{0.568888888888888888888888888888888889L,
                                      0.478628670499366468041291514835638193L,
                                      0.236926885056189087514264040719917363L};
    const Real middle = (from + to) / 2, half = (to - from) / 2;
    Real sum = weights[0] * f(middle);
    for (std::size_t i = 1; i < 3; ++i)
      sum += weights[i] * (f(middle - half * places[i]) + f(middle + half * places[i]));
    return sum * half;
  }

  [[nodiscard]] Real reach(const RealVec& n) const {
    return std::max(-centre * n.y + low_radius, (length - centre) * n.y + high_radius);
  }
  /// Distance from the surface, negative inside: of the ball that is nearest, by thirds.
  [[nodiscard]] Real outside(const RealVec& p) const {
    const auto gap = [&](Real along) {
      const RealVec from{p.x, p.y + centre - along, p.z};
      return norm(from) - low_radius + along * slope();
    };
    Real low = 0, high = length;
    for (int i = 0; i < 120; ++i) {
      const Real first = low + (high - low) / 3, second = high - (high - low) / 3;
      (gap(first) > gap(second) ? low : high) = gap(first) > gap(second) ? first : second;
    }
    return gap((low + high) / 2);
  }
};

/// A cylinder or cone in long double, in its own frame.
struct RealRims {
  Real radius, top_radius, low, high;

  explicit RealRims(const Shape& shape) {
    const Real y = real(shape.size.y);
    const bool cone = shape.kind == ShapeKind::cone;
    radius = real(shape.size.x);
    top_radius = cone ? 0 : radius;
    low = cone ? -y / 4 : -y;
    high = cone ? y * 3 / 4 : y;
  }

  [[nodiscard]] Real reach(const RealVec& n) const {
    const Real flat = std::sqrt(n.x * n.x + n.z * n.z);
    return std::max(n.y * low + flat * radius, n.y * high + flat * top_radius);
  }
  /// How far a point is outside all bounding planes: not positive inside, at most the distance.
  [[nodiscard]] Real beyond(const RealVec& p) const {
    const Real slope = radius - top_radius, rise = high - low;
    const Real length = std::sqrt(slope * slope + rise * rise);
    const Real flat = std::sqrt(p.x * p.x + p.z * p.z);
    const Real side = ((flat - top_radius) * rise + (p.y - high) * slope) / length;
    return std::max(side, std::max(low - p.y, p.y - high));
  }
};

/// Reach of any primitive from its centre, along a world direction.
inline Real reach_of(const PosedShape& posed, const RealVec& n) {
  const RealVec local = in_frame(posed.rotation, n);
  switch (posed.shape.kind) {
    case ShapeKind::rounded_box:
      return RealRounded(posed.shape).reach(local);
    case ShapeKind::tapered_capsule:
      return RealTaper(posed.shape).reach(local);
    case ShapeKind::cylinder:
    case ShapeKind::cone:
      return RealRims(posed.shape).reach(local);
    default:
      return Placed(posed, {}).reach(n);
  }
}

}  // namespace lockstone::test
