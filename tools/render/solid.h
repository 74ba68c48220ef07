// A body as the painter sees it: a convex solid in world coordinates.
#pragma once

#include <vector>

#include <lockstone/world.h>

#include "tools/render/geometry.h"

namespace lockstone::render {

struct Color {
  int red = 128, green = 128, blue = 128;
};

struct Solid {
  ShapeKind kind{};
  Vec center;
  std::array<Vec, 3> axes;  ///< unit vectors of the body's axes
  Vec size;                 ///< as Shape::size
  Color color;
  bool solid = true;  ///< false for a trigger: drawn as glass
  bool shadow = false;
  double shadow_height = 0;  ///< of the surface below the centre, if `shadow`

  [[nodiscard]] double radius() const { return size.x; }  ///< of spheres and capsules

  /// The largest value of dot(direction, point) over the solid's points.
  [[nodiscard]] double reach(const Vec& direction) const;
};

/// Extent of a solid in the picture.
struct Frame {
  double left = 0, right = 0, low = 0, high = 0;

  [[nodiscard]] bool overlaps(const Frame& other) const {
    return left < other.right && other.left < right && low < other.high && other.low < high;
  }
  void include(const Frame& other);
};
[[nodiscard]] Frame frame_of(const Solid& solid, const Camera& camera);

/// The corners of the solid's outline as seen from straight above, in order.
[[nodiscard]] std::vector<Vec> outline_from_above(const Solid& solid);

/// The order in which solids are painted, from back to front.
[[nodiscard]] std::vector<std::size_t> paint_order(const std::vector<Solid>& solids,
                                                   const Camera& camera);

}  // namespace lockstone::render
