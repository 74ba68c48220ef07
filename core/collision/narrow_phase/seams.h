// Seams: where static shapes lie side by side as one surface.
//
// A shape does not know that its neighbour carries on where it ends: its sides and edges are met as
// if it stood alone, and a body that slides over a floor of boxes bumps into the sides between
// them. A contact is such a ghost when
// - each of its points lies on a neighbour too, which rises above the plane that the normal spans
//   there, so that no ball could touch the two there with this normal; and
// - the whole shape lies below a face that the body touches elsewhere, so that the body clears it
//   as long as that face holds.
// The first is the rule by which a mesh finds the ghosts among its own edges (mesh_contacts.h); the
// second keeps the contacts with steps and walls, and in the corner of wall and floor. That all
// static shapes near a body are judged together, whatever bodies they belong to, is Jolt Physics'
// InternalEdgeRemovingCollector.h (J. Rouwe), after Pierre Terdiman, "Contact generation for
// meshes".
#pragma once

#include <cstdint>
#include <optional>

#include <lockstone/units.h>

#include "core/collision/narrow_phase/placed_shape.h"

namespace lockstone {

/// Shapes that are no farther from each other, and steps that are no higher, count as flush. Single
/// precision places shapes to half of it a kilometre from the origin.
inline constexpr Length k_seam_width = Length::from_raw(128);  // 122 µm

/// Where a static shape is touched.
struct TouchedPoint {
  Vec3<Position> point{};
  Vec3<Unit> normal{};  ///< away from the shape
};

/// Part of an asset, 0 of a shape without parts. The triangles at a point stand for the key of a
/// group of triangles.
struct TouchedPart {
  const PlacedShape& placed;
  std::uint32_t part = 0;
};

/// A face of a static shape.
struct FaceOfShape {
  Vec3<Unit> normal{};  ///< away from the shape
  Vec3<Position> point{};
};

/// The face that is touched; nothing where it is an edge, more than 3.6° from every face.
[[nodiscard]] std::optional<FaceOfShape> touched_face(const TouchedPart& touched,
                                                      const TouchedPoint& at);

/// Whether the part does not rise above the face by more than `k_seam_width`.
[[nodiscard]] bool is_below(const TouchedPart& touched, const Vec3<Position>& at,
                            const FaceOfShape& face);

inline constexpr std::uint32_t k_no_part = 0xffffffff;

/// Whether a part of the shape, `except` apart, holds the point or comes within `k_seam_width` of
/// it, and rises above the plane that the normal spans there. Of triangles only those count that
/// `viewer` is before.
[[nodiscard]] bool covers(const PlacedShape& placed, std::uint32_t except, const TouchedPoint& at,
                          const Vec3<Position>& viewer);

/// Whether two normals differ by less than can be felt.
[[nodiscard]] bool are_alike(const Vec3<Unit>& a, const Vec3<Unit>& b);

}  // namespace lockstone
