// When a body in motion first runs into another: continuous collision of two bodies.
#pragma once

#include <cstdint>

#include <lockstone/asset.h>
#include <lockstone/quat.h>
#include <lockstone/shape.h>

#include "core/collision/narrow_phase/placed_shape.h"
#include "core/geometry/distance/motion/time_of_impact.h"

namespace lockstone {

/// A shape on a body whose sweep is that of its centre of mass and principal axes.
struct MovingShape {
  const Shape& shape;
  const geometry::AssetGeometry* asset;
  const Sweep& motion;
};

struct Impact {
  bool hit = false;
  Unit fraction{};  ///< of the interval; the shapes are then about k_impact_gap apart
  std::uint32_t part_a = 0;
  std::uint32_t part_b = 0;
  /// From A to B, where A would pass through B with its middle, deep in B as it was already; else
  /// zero.
  Vec3<Unit> crossing{};
};

/// The gap that is left at an impact, or a part of the thickness of the thinner shape.
inline constexpr Length k_impact_gap = Length::from_ratio(1, 2000);

/// How deep A must come to sink into B for an impact.
enum class ImpactDepth : std::uint8_t {
  half,     ///< half of A's thickness
  shallow,  ///< an eighth more than at the beginning: nothing stops B
};

/// The first moment at which A would run into B by more than half of A's inner radius, or an
/// eighth. A shape that touches or overlaps at the beginning and only slides along, or sinks in
/// less than that, has no impact: the contact solver handles it. Of a mesh only the fronts are met.
/// Every part of B near A's way is tried; ties go to the lower parts.
[[nodiscard]] Impact first_impact(const MovingShape& a, const MovingShape& b,
                                  ImpactDepth depth = ImpactDepth::half);

/// Whether A and B touch at any moment, triangles from either side. Ways that pass within 8 µm
/// count.
[[nodiscard]] bool touch_on_way(const MovingShape& a, const MovingShape& b);

}  // namespace lockstone
