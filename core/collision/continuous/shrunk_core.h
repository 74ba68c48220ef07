// Shapes made smaller, so that resting and sliding contacts are no impacts.
#pragma once

#include <array>

#include "core/collision/narrow_phase/pieces.h"
#include "core/geometry/convex/polytope.h"

namespace lockstone {

/// A piece whose surface lies deeper by about `depth`, less than its inner radius. Of a polytope
/// each vertex goes inward by that much along the mean normal of its faces; the faces are not to be
/// used. Then it is shortened by the factor `share` about its middle; a round shape keeps its
/// radius.
struct ShrunkCore {
  ShrunkCore(const Piece& piece, Length depth, Unit share = Unit::from_integer(1));
  ShrunkCore(const ShrunkCore&) = delete;
  ShrunkCore& operator=(const ShrunkCore&) = delete;

  Shape shape;
  geometry::Polytope polytope{};  ///< only of polytopes
  bool is_polytope = false;

  [[nodiscard]] const geometry::Polytope* polytope_or_null() const {
    return is_polytope ? &polytope : nullptr;
  }

 private:
  void move_vertices_inward(const geometry::Polytope& full, Length depth);
  void shorten(Unit share);

  std::array<Vec3<Length>, geometry::k_max_polytope_vertices> vertices_;
};

/// Radius of a ball that the piece holds.
[[nodiscard]] Length inner_radius_of(const Piece& piece);

}  // namespace lockstone
