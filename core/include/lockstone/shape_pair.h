// Two shapes without a world: how far they are apart, where they touch, and when they would meet.
//
// Functions of their arguments alone: safe from several threads, the same on every machine, without
// allocation. For rules, editors and tools; a world's queries are faster where there is a world.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include <lockstone/asset.h>
#include <lockstone/query.h>
#include <lockstone/shape.h>
#include <lockstone/status.h>
#include <lockstone/transform.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// A shape at a place. The frames of two shapes lie within 1000 m of each other along each axis; of
/// a half-space its plane does. Parts of two compounds whose frames are more than 2000 m apart
/// along an axis are not compared.
struct ShapeAt {
  Shape shape{};
  Transform pose{};              ///< of the shape's frame; it is normalised
  const Asset* asset = nullptr;  ///< the one that `shape` names; read by shapes that name one
};

// All functions return invalid_argument when a shape does not pass `validate`, its asset is missing
// or another one, a place lies outside ±k_world_limit or beyond the bound above, an orientation has
// no direction, or the function does not take the pair.

/// The closest points of two shapes.
struct ShapeDistance {
  bool found = false;        ///< whether the distance is at most `reach`; else all is zero
  bool overlapping = false;  ///< the shapes share a point: the normal and the points are zero
  std::uint32_t part_a = 0;  ///< triangle, cell or child
  std::uint32_t part_b = 0;
  Position distance{};       ///< m; zero when overlapping
  Vec3<Unit> normal{};       ///< from A to B
  Vec3<Position> point_a{};  ///< on A's surface
  Vec3<Position> point_b{};
};

/// The distance of two shapes, of which one at least is a primitive, a hull or a compound without
/// meshes; `reach` is 0 … k_max_cast. Triangles count from both sides; the inside of a mesh is not
/// solid. Error ≤ 2 µm: the plane along the normal separates the two parts by no less. Points are
/// rounded to 1 µm. Of equal distances that of the lowest part of A counts, then of B. For a depth
/// ask `shape_contacts`.
[[nodiscard]] Result<ShapeDistance> shape_distance(const ShapeAt& a, const ShapeAt& b,
                                                   Length reach = k_max_cast);

/// A contact manifold of a part of A and a part of B.
struct ShapeManifold {
  /// Apart: on each surface. Overlapping: both the same point, in the middle or on the round one.
  struct Point {
    Vec3<Position> point_a{};
    Vec3<Position> point_b{};
    Displacement separation{};  ///< m, along the normal; negative when overlapping
  };

  Vec3<Unit> normal{};       ///< from A to B
  std::uint32_t part_a = 0;  ///< triangle, cell or child; a group of triangles is named by its key
  std::uint32_t part_b = 0;
  std::uint32_t count = 0;  ///< of points, 1 … 4
  std::array<Point, 4> points{};
};

/// The manifolds of all points nearer than `margin` (0 … 64 m) or overlapping, as a world has them
/// for two bodies, by the parts of A, then of B (of B first where A is a half-space or has
/// triangles); as many as `out` holds, at most 64. Returns how many were written. Takes the pairs
/// of `shape_distance`; triangles push from their front only.
///
/// Apart, the least separation is within 2 µm and 4e-9 of the sizes of the distance; of two boxes
/// within 15 µm, beside a box's rim within 1/2048 of it. Overlapping, the normal is an axis of
/// least overlap, where a face is preferred to an edge whose overlap is smaller by less than a
/// tenth and 0.5 mm. Points lie on the surfaces within 2 µm, of two boxes within 32 µm for each
/// edge that lay flush.
[[nodiscard]] Result<std::size_t> shape_contacts(const ShapeAt& a, const ShapeAt& b, Length margin,
                                                 std::span<ShapeManifold> out);

/// When two shapes meet.
struct ShapeImpact {
  bool hit = false;          ///< else all is zero
  bool overlapping = false;  ///< at the start: then the fraction is 0
  std::uint32_t part_a = 0;
  std::uint32_t part_b = 0;
  Unit fraction{};           ///< of the way, 0 … 1, rounded down
  Vec3<Unit> normal{};       ///< from A to B; may be zero when overlapping
  Vec3<Position> point_a{};  ///< on A's surface then; zero when overlapping at the start of a turn
};

/// Moves B, a primitive or a hull, by `translation` (each component within ±k_max_cast) without
/// turning; A, of any kind, rests. Of triangles only the front is met. No contact before the
/// fraction, up to 2 µm; there the distance is at most 1 µm plus the length of a step of the
/// fraction (2^-30 of the translation). A shape that starts within that distance hits at 0 if it
/// approaches, and not if it leaves or slides along.
[[nodiscard]] Result<ShapeImpact> shape_cast(const ShapeAt& a, const ShapeAt& b,
                                             const Vec3<Length>& translation);

/// A shape on its way: its frame goes evenly along a line and turns evenly about its origin, by the
/// shortest turn.
struct ShapeMotion {
  ShapeAt start{};
  Transform end{};  ///< each coordinate within ±k_max_cast of the start
};

/// The first fraction of the way at which two primitives, hulls or compounds without meshes, which
/// may both move and turn, come as near as `gap`, 8 µm … 1 m: there the distance is between `gap`
/// and 5/4 of it, or less at the start. Before, it is not below `gap` by more than 3 µm and 1e-8 of
/// the sizes, whatever the turn. After 256 steps, which no test has needed, the place reached
/// stands as the hit. Compares each part of A with each of B.
[[nodiscard]] Result<ShapeImpact> shape_impact(const ShapeMotion& a, const ShapeMotion& b,
                                               Length gap = Length::from_ratio(1, 2000));

}  // namespace lockstone
