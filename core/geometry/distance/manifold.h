// The contact points between two convex shapes, and a shape with its rotation.
#pragma once

#include <array>
#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/shape.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

namespace geometry {
struct Polytope;
}

inline constexpr int k_max_manifold_points = 4;

/// One contact point. Anchors are relative to each body's centre, in world axes.
/// Apart (separation > 0): each anchor is the witness on its own body's surface, so that both meet
/// when the gap closes. Touching or overlapping: both are one point, so that an impulse pair exerts
/// no net torque: where a sphere or a capsule meets another kind of shape, the point on the round
/// surface, so that it rolls at its radius however deep it has sunk; else the midpoint between the
/// surfaces.
struct ManifoldPoint {
  Vec3<Length> anchor_a;
  Vec3<Length> anchor_b;
  Displacement separation;  ///< along the normal, negative when overlapping
  /// Names the meeting features: stable from tick to tick, unique within a manifold.
  std::uint32_t feature = 0;
};

/// Up to four points that share one unit normal, which points from A to B.
struct Manifold {
  Vec3<Unit> normal{};
  int count = 0;
  std::array<ManifoldPoint, k_max_manifold_points> points{};
};

/// The features of a pair's points a tick ago, if it touched with one manifold: for choices that
/// must not change back and forth while bodies come to rest.
struct HeldFeatures {
  std::array<std::uint32_t, k_max_manifold_points> features{};
  std::uint16_t count = 0;
  std::uint16_t loaded = 0;  ///< bit n: an impulse pushed at point n

  friend bool operator==(const HeldFeatures&, const HeldFeatures&) = default;

  [[nodiscard]] std::uint32_t first() const { return count == 0 ? 0 : features[0]; }
  /// Its place; `count` where there is none.
  [[nodiscard]] unsigned find(std::uint32_t feature) const {
    unsigned place = 0;
    while (place < count && features[place] != feature)
      ++place;
    return place;
  }
  [[nodiscard]] bool has(std::uint32_t feature) const { return find(feature) < count; }
  [[nodiscard]] bool is_loaded(std::uint32_t feature) const {
    return (loaded >> find(feature) & 1) != 0;
  }
};

/// One side of a pair. The rotation is that of the body, rounded once per tick and shared by all
/// pairs.
struct PosedShape {
  const Shape& shape;
  const Mat3& rotation;
  const geometry::Polytope* polytope = nullptr;  ///< of a hull or triangle; frame: the shape's
};

}  // namespace lockstone
