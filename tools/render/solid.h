// A convex piece of a body as the painter sees it, in world coordinates.
#pragma once

#include <vector>

#include <lockstone/world.h>

#include "tools/render/geometry.h"

namespace lockstone::render {

struct Color {
  int red = 128, green = 128, blue = 128;
};

/// A flat polygon, counter-clockwise seen from where its normal points.
struct Facet {
  Vec normal;  ///< unit vector
  std::vector<Vec> corners;
};

/// Spheres, capsules and boxes are given by axes and size, all others by facets: a hull by all of
/// its faces; a triangle of a mesh or height field, and the visible piece of a half-space, by one.
struct Solid {
  ShapeKind kind{};
  Vec center;
  std::array<Vec, 3> axes;  ///< unit vectors of the body's axes
  Vec size;                 ///< as Shape::size
  std::vector<Facet> facets = {};
  Color color;
  bool solid = true;  ///< false for a trigger: drawn as glass
  bool shadow = false;
  Vec shadow_at;                  ///< on the surface below the centre, if `shadow`
  Vec shadow_normal = {0, 1, 0};  ///< of that surface; y > 0

  [[nodiscard]] double radius() const { return size.x; }  ///< of spheres and capsules

  /// Of one facet: it has no inside.
  [[nodiscard]] bool is_flat() const { return facets.size() == 1; }

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
