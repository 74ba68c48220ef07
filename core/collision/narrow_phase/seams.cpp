#include "core/collision/narrow_phase/seams.h"

#include <cstdlib>

#include <lockstone/assert.h>

#include "core/collision/narrow_phase/pieces.h"
#include "core/geometry/convex/polytope.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/q50.h"

namespace lockstone {
namespace {

using geometry::Fine;
using geometry::fine;

/// Above the rounding errors of points and supports.
constexpr Fine k_rise = Fine{1} << (geometry::k_fine_bits - 15);  // 31 µm

/// How far behind its front a triangle counts as solid: farther than a load presses a body in.
constexpr Length k_triangle_depth = Length::from_ratio(1, 50);

/// Further than a shape reaches.
constexpr Fine k_no_end = Fine{1} << 62;

constexpr std::int64_t k_face_cosine = (std::int64_t{1} << 60) - (std::int64_t{1} << 51);

/// A point near a piece, in the piece's frame.
Vec3<Length> local_point(const Piece& piece, const Vec3<Position>& point) {
  return rotate_inverse(piece.rotation, saturated<Length>(point - piece.origin));
}

/// Within a prism as deep as `k_triangle_depth` behind the front.
bool is_in_triangle(const geometry::Polytope& triangle, const Vec3<Length>& point) {
  const geometry::PolytopeFace& front = triangle.faces.front();
  LKS_ASSERT(front.edge_count == 3);
  const Fine height = lockstone::dot(front.normal, point).raw - front.offset;
  if (height > fine(k_seam_width) || height < -fine(k_triangle_depth)) return false;
  for (int i = 0; i < 3; ++i) {
    const int edge = front.first_edge + i;
    const Vec3<Length> side = geometry::edge_vector(triangle, edge);
    const Vec3<Length> outward = rounded<Length>(cross(side, front.normal));
    const Length longest = max(max(abs(side.x), abs(side.y)), abs(side.z));
    const Vec3<Length> way = point - geometry::start_of(triangle, edge);
    if (lockstone::dot(outward, way) > longest * k_seam_width) return false;
  }
  return true;
}

bool is_in_hull(const geometry::Polytope& hull, const Vec3<Length>& point) {
  for (const geometry::PolytopeFace& face : hull.faces)
    if (lockstone::dot(face.normal, point).raw - face.offset > fine(hull.radius + k_seam_width))
      return false;
  return true;
}

/// Whether the piece holds the point (its own frame), or nearly.
bool holds(const Piece& piece, const Vec3<Length>& point) {
  if (piece.triangle.is_triangle) return is_in_triangle(*piece.polytope, point);
  if (piece.polytope != nullptr) return is_in_hull(*piece.polytope, point);
  if (piece.shape.kind == ShapeKind::half_space) return point.y <= k_seam_width;
  return geometry::traits_of(piece.shape).holds(piece.shape, point, k_seam_width);
}

/// How far the piece reaches from the origin of its frame along a unit vector of that frame.
Fine reach_along(const Piece& piece, const Vec3<Unit>& axis) {
  if (piece.polytope != nullptr)
    return geometry::support_of(*piece.polytope, axis).height + fine(piece.polytope->radius);
  const Shape& shape = piece.shape;
  if (shape.kind == ShapeKind::half_space) return are_alike(axis, Mat3{}.y) ? 0 : k_no_end;
  return geometry::traits_of(shape).reach(shape, axis);
}

/// How far the piece rises above the plane through the point with this normal.
Fine rise_above(const Piece& piece, const TouchedPoint& at) {
  const Vec3<Unit> axis = rotate_inverse(piece.rotation, at.normal);
  return raw::subtract(reach_along(piece, axis),
                       lockstone::dot(axis, local_point(piece, at.point)).raw);
}

/// The outward normal of the face that looks most along the axis, both in the piece's frame.
Vec3<Unit> face_along(const Piece& piece, const Vec3<Unit>& axis) {
  LKS_ASSERT(geometry::is_unit(axis));
  if (piece.triangle.is_triangle) return piece.polytope->faces.front().normal;
  if (piece.polytope != nullptr) {
    const geometry::PolytopeFace* best = &piece.polytope->faces.front();
    for (const geometry::PolytopeFace& face : piece.polytope->faces)
      if (lockstone::dot(face.normal, axis) > lockstone::dot(best->normal, axis)) best = &face;
    // Where the surface is round, each direction is that of a face.
    constexpr std::int64_t k_near = (std::int64_t{1} << 60) - (std::int64_t{1} << 49);
    const bool is_round =
        piece.polytope->radius > Length{} && lockstone::dot(best->normal, axis).raw < k_near;
    return is_round ? axis : best->normal;
  }
  if (piece.shape.kind == ShapeKind::half_space) return Mat3{}.y;
  return geometry::traits_of(piece.shape).face_along(piece.shape, axis);
}

/// Calls `f(piece)` for the pieces at a point, and for no other piece of an asset with triangles.
template <class F>
class AtPoint final : public PieceVisitor {
 public:
  AtPoint(const Vec3<Position>& point, F& f) : point_(point), f_(f) {}
  void visit(const Piece& piece) override {
    if (!piece.triangle.is_triangle || holds(piece, local_point(piece, point_))) f_(piece);
  }

 private:
  const Vec3<Position>& point_;
  F& f_;
};

template <class F>
void for_each_piece_at(const PlacedShape& placed, const Vec3<Position>& point, F&& f) {
  AtPoint<F> visitor(point, f);
  visit_pieces(brought_near(placed, point), {point, Mat3{}, {}}, k_triangle_depth, visitor);
}

// A contact with triangles has a key, which is no convex part's number.
bool is_part(const Piece& piece, std::uint32_t part) {
  if (part == k_no_part) return false;
  return piece.triangle.is_triangle ? part >= geometry::k_first_triangle_part : piece.part == part;
}

}  // namespace

bool are_alike(const Vec3<Unit>& a, const Vec3<Unit>& b) {
  constexpr std::int64_t k_least = 1 << (Unit::frac_bits - 11);
  const auto is_near = [&](int i) {  // opposite units are 2 apart, which no unit is
    return std::abs(std::int64_t{a[i].raw} - b[i].raw) <= k_least;
  };
  return is_near(0) && is_near(1) && is_near(2);
}

std::optional<FaceOfShape> touched_face(const TouchedPart& touched, const TouchedPoint& at) {
  std::optional<FaceOfShape> found;
  std::int64_t best = k_face_cosine;
  for_each_piece_at(touched.placed, at.point, [&](const Piece& piece) {
    if (!is_part(piece, touched.part)) return;
    const Vec3<Unit> axis = rotate_inverse(piece.rotation, at.normal);
    const Vec3<Unit> normal = face_along(piece, axis);
    const std::int64_t cosine = lockstone::dot(normal, axis).raw;
    if (cosine < best) return;
    best = cosine;
    const Vec3<Unit> outward = rotate(piece.rotation, normal);
    LKS_ASSERT(geometry::is_unit(outward));
    const Fine height = rise_above(piece, {at.point, outward});
    constexpr int k_bits = geometry::k_fine_bits - Position::frac_bits;
    const geometry::RawVec way = geometry::shifted(geometry::along(outward, height), k_bits);
    found = {outward,
             at.point + Vec3<Position>{Position::from_raw(way.x), Position::from_raw(way.y),
                                       Position::from_raw(way.z)}};
  });
  return found;
}

bool is_below(const TouchedPart& touched, const Vec3<Position>& at, const FaceOfShape& face) {
  bool any = false, all = true;
  for_each_piece_at(touched.placed, at, [&](const Piece& piece) {
    if (!is_part(piece, touched.part)) return;
    any = true;
    all = all && rise_above(piece, {face.point, face.normal}) <= fine(k_seam_width);
  });
  return any && all;
}

bool covers(const PlacedShape& placed, std::uint32_t except, const TouchedPoint& at,
            const Vec3<Position>& viewer) {
  bool found = false;
  for_each_piece_at(placed, at.point, [&](const Piece& piece) {
    if (is_part(piece, except) || is_behind(viewer, piece)) return;
    found = found || (holds(piece, local_point(piece, at.point)) && rise_above(piece, at) > k_rise);
  });
  return found;
}

}  // namespace lockstone
