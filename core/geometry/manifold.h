// The result of colliding two convex shapes.
#pragma once

#include <array>
#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/shape.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

inline constexpr int k_max_manifold_points = 4;

/// One contact point. Anchors are relative to each body's centre, in world axes.
/// Apart (separation > 0): each anchor is the witness on its own body's surface, so that both meet
/// when the gap closes. Touching or overlapping: both are the midpoint between the surfaces, so that
/// an impulse pair exerts no net torque.
struct ManifoldPoint {
  Vec3<Length> anchor_a;
  Vec3<Length> anchor_b;
  Displacement separation;    ///< along the normal, negative when overlapping
  std::uint32_t feature = 0;  ///< names the meeting features, stable from tick to tick; unique within a manifold
};

/// Up to four points that share one unit normal, which points from A to B.
struct Manifold {
  Vec3<Unit> normal{};
  int count = 0;
  std::array<ManifoldPoint, k_max_manifold_points> points{};
};

/// One side of a pair. The rotation is that of the body, rounded once per tick and shared by all pairs.
struct PosedShape {
  const Shape& shape;
  const Mat3& rotation;
};

/// Contact points between A and B closer than `margin` (≥ 0, ≤ 64 m). `offset` = centre of B − centre
/// of A, in world axes, each component within ±2000 m. Depends on nothing but its arguments.
/// Features are ordered canonically. Mirror images give mirror images.
[[nodiscard]] Manifold collide(const PosedShape& a, const PosedShape& b,
                               const Vec3<Length>& offset, Length margin);

/// True when A and B overlap or touch: for triggers. Agrees with collide(margin 0) having a point
/// with separation ≤ 0.
[[nodiscard]] bool overlaps(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset);

}  // namespace lockstone
