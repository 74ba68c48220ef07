// The same geometry in long double, by closed forms: distance of separated shapes, overlap by
// separating axes, signed distance of a point to a surface.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "core/geometry/distance/manifold.h"

namespace lockstone::test {

using Real = long double;

struct RealVec {
  Real x = 0;
  Real y = 0;
  Real z = 0;

  [[nodiscard]] Real operator[](int k) const { return k == 0 ? x : k == 1 ? y : z; }
  [[nodiscard]] Real& operator[](int k) { return k == 0 ? x : k == 1 ? y : z; }
  friend RealVec operator+(const RealVec& a, const RealVec& b) {
    return {a.x + b.x, a.y + b.y, a.z + b.z};
  }
  friend RealVec operator-(const RealVec& a, const RealVec& b) {
    return {a.x - b.x, a.y - b.y, a.z - b.z};
  }
  friend RealVec operator*(const RealVec& a, Real s) { return {a.x * s, a.y * s, a.z * s}; }
};

inline Real dot(const RealVec& a, const RealVec& b) {
  return a.x * b.x + a.y * b.y + a.z * b.z;
}
inline RealVec cross(const RealVec& a, const RealVec& b) {
  return {a.y * b.z - a.z * b.y, a.z * b.x - a.x * b.z, a.x * b.y - a.y * b.x};
}
inline Real norm(const RealVec& a) {
  return std::sqrt(dot(a, a));
}

template <class D, class R, int F>
Real real(Fixed<D, R, F> x) {
  return std::ldexp(static_cast<Real>(x.raw), -F);
}
template <class T>
RealVec real(const Vec3<T>& v) {
  return {real(v.x), real(v.y), real(v.z)};
}

/// A shape placed in the world.
struct Placed {
  ShapeKind kind = ShapeKind::sphere;
  RealVec size;
  RealVec centre;
  std::array<RealVec, 3> axes;

  Placed(const PosedShape& posed, const RealVec& at)
      : kind(posed.shape.kind),
        size(real(posed.shape.size)),
        centre(at),
        axes{real(posed.rotation.x), real(posed.rotation.y), real(posed.rotation.z)} {}

  [[nodiscard]] RealVec to_local(const RealVec& p) const {
    return {dot(p - centre, axes[0]), dot(p - centre, axes[1]), dot(p - centre, axes[2])};
  }
  [[nodiscard]] Real radius() const { return kind == ShapeKind::box ? 0 : size.x; }
  /// Ends of a capsule's core.
  [[nodiscard]] RealVec end(int sign) const { return centre + axes[1] * (sign * size.y); }
  /// Extent from the centre along a unit direction.
  [[nodiscard]] Real reach(const RealVec& n) const {
    if (kind == ShapeKind::sphere) return size.x;
    if (kind == ShapeKind::capsule) return size.x + size.y * std::fabs(dot(n, axes[1]));
    Real sum = 0;
    for (int k = 0; k < 3; ++k)
      sum += size[k] * std::fabs(dot(n, axes[static_cast<std::size_t>(k)]));
    return sum;
  }
};

inline Real point_to_segment(const RealVec& p, const RealVec& a, const RealVec& b) {
  const RealVec ab = b - a;
  const Real t = std::clamp(dot(p - a, ab) / dot(ab, ab), Real{0}, Real{1});
  return norm(p - (a + ab * t));
}

inline Real segment_to_segment(const RealVec& a0, const RealVec& a1, const RealVec& b0,
                               const RealVec& b1) {
  Real best = std::min({point_to_segment(a0, b0, b1), point_to_segment(a1, b0, b1),
                        point_to_segment(b0, a0, a1), point_to_segment(b1, a0, a1)});
  const RealVec u = a1 - a0;
  const RealVec v = b1 - b0;
  const RealVec k = cross(u, v);
  const Real kk = dot(k, k);
  if (kk == 0) return best;
  const RealVec d = b0 - a0;
  const Real s = dot(cross(d, v), k) / kk;
  const Real t = dot(cross(d, u), k) / kk;
  if (s >= 0 && s <= 1 && t >= 0 && t <= 1)
    best = std::min(best, std::fabs(dot(d, k)) / std::sqrt(kk));
  return best;
}

/// Outside positive; inside the negative depth to the nearest face.
inline Real point_to_box(const RealVec& local, const RealVec& half) {
  RealVec excess;
  Real inside = -1e30L;
  bool outside = false;
  for (int k = 0; k < 3; ++k) {
    const Real beyond = std::fabs(local[k]) - half[k];
    inside = std::max(inside, beyond);
    if (beyond > 0) {
      outside = true;
      excess[k] = beyond;
    }
  }
  return outside ? norm(excess) : inside;
}

/// Signed distance of a point to the surface.
inline Real surface_distance(const Placed& shape, const RealVec& p) {
  if (shape.kind == ShapeKind::sphere) return norm(p - shape.centre) - shape.size.x;
  if (shape.kind == ShapeKind::capsule) {
    return point_to_segment(p, shape.end(-1), shape.end(1)) - shape.size.x;
  }
  return point_to_box(shape.to_local(p), shape.size);
}

struct RealSegment {
  RealVec from;
  RealVec to;
};

inline std::vector<RealSegment> edges_of(const Placed& box) {
  std::vector<RealSegment> edges;
  for (int axis = 0; axis < 3; ++axis) {
    for (int bits = 0; bits < 4; ++bits) {
      RealVec middle = box.centre;
      for (int k = 1; k < 3; ++k) {
        const int other = (axis + k) % 3;
        const Real sign = (bits & k) != 0 ? -1 : 1;
        middle = middle + box.axes[static_cast<std::size_t>(other)] * (sign * box.size[other]);
      }
      const RealVec half = box.axes[static_cast<std::size_t>(axis)] * box.size[axis];
      edges.push_back({middle - half, middle + half});
    }
  }
  return edges;
}

/// The greatest separation over these axes (of cores: radii left out).
inline Real greatest_separation(const Placed& a, const Placed& b,
                                const std::vector<RealVec>& axes) {
  Real best = -1e30L;
  for (const RealVec& axis : axes) {
    const Real length = norm(axis);
    if (length < 1e-12L) continue;
    const RealVec n = axis * (1 / length);
    const Real s = std::fabs(dot(n, b.centre - a.centre)) - (a.reach(n) - a.radius()) -
                   (b.reach(n) - b.radius());
    best = std::max(best, s);
  }
  return best;
}

/// Negative: the least overlap of the cores of a box and a box or capsule; positive values are a
/// lower bound of their distance.
inline Real separating_axes(const Placed& a, const Placed& b) {
  std::vector<RealVec> axes(a.axes.begin(), a.axes.end());
  if (b.kind == ShapeKind::box) axes.insert(axes.end(), b.axes.begin(), b.axes.end());
  for (const RealVec& u : a.axes) {
    if (b.kind == ShapeKind::capsule) axes.push_back(cross(u, b.axes[1]));
    if (b.kind != ShapeKind::box) continue;
    for (const RealVec& v : b.axes)
      axes.push_back(cross(u, v));
  }
  return greatest_separation(a, b, axes);
}

inline Real apart_box_capsule(const Placed& box, const Placed& capsule) {
  Real best = std::min(point_to_box(box.to_local(capsule.end(1)), box.size),
                       point_to_box(box.to_local(capsule.end(-1)), box.size));
  for (const RealSegment& e : edges_of(box)) {
    best = std::min(best, segment_to_segment(e.from, e.to, capsule.end(-1), capsule.end(1)));
  }
  return best;
}

inline Real apart_boxes(const Placed& a, const Placed& b) {
  const auto edges_a = edges_of(a);
  const auto edges_b = edges_of(b);
  Real best = 1e30L;
  for (const RealSegment& e : edges_a) {
    best = std::min(
        {best, point_to_box(b.to_local(e.from), b.size), point_to_box(b.to_local(e.to), b.size)});
  }
  for (const RealSegment& f : edges_b) {
    best = std::min(
        {best, point_to_box(a.to_local(f.from), a.size), point_to_box(a.to_local(f.to), a.size)});
  }
  for (const RealSegment& e : edges_a) {
    for (const RealSegment& f : edges_b) {
      best = std::min(best, segment_to_segment(e.from, e.to, f.from, f.to));
    }
  }
  return best;
}

/// Distance of the shapes when apart; minus the least overlap over the separating axes otherwise.
inline Real signed_distance(const Placed& a, const Placed& b) {
  if (a.kind < b.kind) return signed_distance(b, a);
  const Real radii = a.radius() + b.radius();
  if (b.kind == ShapeKind::sphere) {
    return surface_distance(a, b.centre) - b.radius();
  }
  if (a.kind == ShapeKind::capsule) {
    return segment_to_segment(a.end(-1), a.end(1), b.end(-1), b.end(1)) - radii;
  }
  const Real overlap = separating_axes(a, b);
  if (overlap <= 0) return overlap - radii;
  return (b.kind == ShapeKind::box ? apart_boxes(a, b) : apart_box_capsule(a, b)) - radii;
}

}  // namespace lockstone::test
