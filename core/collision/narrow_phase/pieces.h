// Convex pieces of placed shapes: the one piece of a simple shape, the parts of an asset.
#pragma once

#include <cstdint>

#include "core/collision/narrow_phase/placed_shape.h"
#include "core/geometry/convex/parts.h"
#include "core/geometry/distance/manifold.h"
#include "core/geometry/numeric/q50.h"

namespace lockstone {

/// Valid only during the visit.
struct Piece {
  Shape shape{};
  const geometry::Polytope* polytope = nullptr;
  Vec3<Position> origin{};  ///< of the piece's frame
  Mat3 rotation{};
  std::uint32_t part = 0;
  const Surface* surface = nullptr;  ///< null: the body's own
  geometry::TriangleTopology triangle{};

  [[nodiscard]] PosedShape posed() const { return {shape, rotation, polytope}; }
};

class PieceVisitor {
 public:
  virtual void visit(const Piece& piece) = 0;

 protected:
  ~PieceVisitor() = default;
};

/// Calls `f(piece)`.
template <class F>
class EachPiece final : public PieceVisitor {
 public:
  explicit EachPiece(F& f) : f_(f) {}
  void visit(const Piece& piece) override { f_(piece); }

 private:
  F& f_;
};

/// The bounds, in a placed asset's frame, of the asset's part near a box.
struct OrientedBox;
[[nodiscard]] geometry::LocalBounds local_region(const PlacedShape& placed,
                                                 const OrientedBox& region, Length margin);

/// A box in the world, turned as its rotation says.
struct OrientedBox {
  Vec3<Position> centre{};
  Mat3 rotation{};
  Vec3<Length> half_extents{};
};

/// One convex shape, or a polyhedron: no parts to visit.
[[nodiscard]] inline bool is_single(const PlacedShape& placed) {
  return placed.asset == nullptr || placed.asset->polytope() != nullptr;
}

/// The piece of a single shape.
[[nodiscard]] Piece single_piece(const PlacedShape& placed);

/// A part of a placed asset, placed.
[[nodiscard]] Piece piece_of(const PlacedShape& placed, const geometry::Part& part);

/// The point by which contacts tell the front of a triangle from its back: the centre, of a hull a
/// point inside. The middle of a hull's bounds may be outside, and behind a front that the hull is
/// before.
[[nodiscard]] Vec3<Position> middle_of(const Piece& piece);

/// How far a point is above the front of a triangle's plane.
[[nodiscard]] geometry::Fine height_above_front(const Vec3<Position>& point, const Piece& triangle);

/// Whether the piece is a triangle of a mesh and the point lies behind it: triangles are met from
/// the front only.
[[nodiscard]] bool is_behind(const Vec3<Position>& point, const Piece& piece);

/// A box that holds the piece or the shape; a half-space has none.
[[nodiscard]] OrientedBox oriented_box(const Piece& piece);
[[nodiscard]] OrientedBox oriented_box(const PlacedShape& placed);

/// A half-space has no middle: its frame is moved along its plane to where `point` is, so that
/// offsets stay small. Other shapes stay as they are.
[[nodiscard]] PlacedShape brought_near(const PlacedShape& placed, const Vec3<Position>& point);

/// Calls the visitor for every piece whose bounds come within `margin` of the box, ascending by
/// part; a single shape's piece always.
void visit_pieces(const PlacedShape& placed, const OrientedBox& region, Length margin,
                  PieceVisitor& visitor);

}  // namespace lockstone
