// The distance of two convex shapes.
#pragma once

#include "core/geometry/distance/gjk/closest_features.h"
#include "core/geometry/distance/manifold.h"

namespace lockstone {

/// The vertices of a core whose hull holds the closest point: indices as of
/// `geometry::ConvexCore`; equal entries stand for one vertex.
struct ClosestFeature {
  int count = 0;  ///< 0 … 3
  std::array<int, 3> a{};
  std::array<int, 3> b{};

  friend constexpr bool operator==(const ClosestFeature&, const ClosestFeature&) = default;
};

/// How far two shapes are apart.
struct ClosestPoints {
  bool overlapping = false;  ///< the shapes share a point
  /// The cores (the shapes without their radii) overlap: then nothing else is known. Never set
  /// beside a half-space, whose normal and points are always given.
  bool cores_overlap = false;
  Position distance{};     ///< m; zero when overlapping
  Vec3<Unit> normal{};     ///< from A to B, world axes; zero when the cores overlap
  Vec3<Length> point_a{};  ///< on A's surface, from A's centre, world axes
  Vec3<Length> point_b{};  ///< on B's surface, from B's centre
  ClosestFeature feature{};
};

/// Distance of primitives, hulls and triangles; one of the two may be a half-space.
/// `offset` = centre of B − centre of A in world axes; every component of a point of B less a point
/// of A is below 2^12 m. Error ≤ 2 µm: the plane along the normal, as it is rounded, separates by
/// no less. Points are rounded to lengths.
///
/// distance(b, a, −offset) gives the same mirrored, bit for bit. Nothing is tuned: the search ends
/// when no vertex of the shapes, brought to a lattice of 30 bits, comes nearer by exact comparison.
/// Of sizes from 64 m on, where a step of the lattice is 0.12 µm and more, it is carried on with
/// the exact vertices until a plane proves the distance.
[[nodiscard]] ClosestPoints distance(const PosedShape& a, const PosedShape& b,
                                     const Vec3<Length>& offset);

namespace geometry {

/// A fine length as a position's coordinate, to nearest.
[[nodiscard]] constexpr Position to_position(Fine length) {
  return Position::from_raw(raw::round_shift(length, k_fine_bits - Position::frac_bits));
}

/// The result of GJK on the lattice.
struct GjkResult {
  bool overlapping = false;  ///< the simplex holds the origin
  Simplex simplex{};
  int iterations = 0;
};

/// The closest simplex of B − A to the origin, begun with the vertex least along `guess` (not
/// zero, components below 2^31). Each step strictly lessens the simplex' exact distance, so none
/// comes twice and the search ends; 512 steps are asserted, and beyond them the last simplex
/// stands, which is not nearer than the closest.
[[nodiscard]] GjkResult gjk(const LatticePair& pair, const RawVec& guess);

/// Whether the pair has to be exchanged so that both orders of the arguments run one computation.
/// Equal shapes in equal poses are ordered by the offset.
[[nodiscard]] bool is_exchanged(const PosedShape& a, const PosedShape& b, const RawVec& offset);

/// Two cores in one place, prepared for queries at several offsets.
class GapQuery {
 public:
  GapQuery(const PosedShape& a, const PosedShape& b) {
    make_core(a, a_);
    make_core(b, b_);
  }
  GapQuery(const ConvexCore& a, const ConvexCore& b) : a_(a), b_(b) {}
  GapQuery(const GapQuery&) = delete;  // the lattice refers to the cores
  GapQuery& operator=(const GapQuery&) = delete;

  /// GJK, or `taper_gap`, with the centre of B at `offset`, fine, from that of A, begun where the
  /// last query ended. False when the cores overlap.
  [[nodiscard]] bool find(const RawVec& offset);

  /// Unless the cores overlap. Of a tapered core it may be a depth, negative: its centres are
  /// apart.
  [[nodiscard]] const CoreGap& gap() const { return gap_; }
  /// On the lattice; of cores that overlap, it holds the origin.
  [[nodiscard]] const Simplex& simplex() const { return simplex_; }
  /// Whose hulls hold the closest points; unless the cores overlap.
  [[nodiscard]] const Simplex& features() const { return features_; }
  [[nodiscard]] const LatticePair& lattice() const { return lattice_; }
  [[nodiscard]] FinePair fine_pair() const { return {a_, b_, offset_}; }
  /// The sum of the radii.
  [[nodiscard]] Fine radii() const { return fine(a_.radius) + fine(b_.radius); }
  [[nodiscard]] const ConvexCore& a() const { return a_; }
  [[nodiscard]] const ConvexCore& b() const { return b_; }

  /// Whether a step of the lattice is so long that the exact vertices have to decide.
  [[nodiscard]] bool is_coarse() const { return shift_ >= k_coarse_shift; }

  /// Whether a point meets rims or a tapered core: then `gap` is in closed form, and where the
  /// cores overlap it has their depth, negative.
  [[nodiscard]] bool is_closed_form() const {
    return (has_form(a_) && is_point(b_)) || (has_form(b_) && is_point(a_));
  }

  /// Puts the offset back to that of an earlier query, without its results.
  void return_to(const RawVec& offset) { offset_ = offset; }

 private:
  /// 2^-23 m: of sizes from 64 m on.
  static constexpr int k_coarse_shift = k_fine_bits - 23;

  [[nodiscard]] static bool has_form(const ConvexCore& core) {
    return core.rims.count != 0 || is_tapered(core);
  }
  [[nodiscard]] bool find_fine();
  [[nodiscard]] bool find_taper_gap();
  [[nodiscard]] bool find_in_closed_form();

  ConvexCore a_;
  ConvexCore b_;
  RawVec offset_{};
  LatticePair lattice_;
  int shift_ = -1;  ///< of the lattice at hand
  RawVec guess_{};
  Simplex simplex_{};
  Simplex features_{};
  CoreGap gap_{};
};

}  // namespace geometry
}  // namespace lockstone
