// Shapes made smaller, so that resting and sliding contacts are no impacts.
#pragma once

#include <array>

#include "core/collision/pieces.h"
#include "core/geometry/polytope.h"

namespace lockstone {

/// A piece whose surface lies deeper by about half of its inner radius. Of a polytope each vertex
/// goes inward by that much along the mean normal of its faces; the faces are not to be used.
struct ErodedShape {
  explicit ErodedShape(const Piece& piece);
  ErodedShape(const ErodedShape&) = delete;
  ErodedShape& operator=(const ErodedShape&) = delete;

  Shape shape;
  Length depth{};
  geometry::Polytope polytope{};  ///< only of polytopes
  bool is_polytope = false;

  [[nodiscard]] const geometry::Polytope* polytope_or_null() const {
    return is_polytope ? &polytope : nullptr;
  }

 private:
  void erode_vertices(const geometry::Polytope& full);

  std::array<Vec3<Length>, geometry::k_max_polytope_vertices> vertices_;
};

/// Half of the radius of a ball that the piece holds.
[[nodiscard]] Length erosion_depth(const Piece& piece);

}  // namespace lockstone
