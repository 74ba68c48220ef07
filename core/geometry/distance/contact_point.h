// Building manifolds: one place decides which points are kept and where their anchors lie.
#pragma once

#include "core/geometry/distance/manifold.h"
#include "core/geometry/numeric/q50.h"

namespace lockstone::geometry {

/// Whether a point with this separation belongs to a manifold: closer than the margin, or touching.
[[nodiscard]] constexpr bool keeps(Displacement separation, Length margin) {
  constexpr int shift = Displacement::frac_bits - Length::frac_bits;
  return separation.raw <= 0 || separation.raw < (std::int64_t{margin.raw} << shift);
}

[[nodiscard]] constexpr bool keeps(Fine separation, Length margin) {
  return keeps(to_separation(separation), margin);
}

/// Two surface points that meet, in world axes, fine, relative to A's centre.
struct Witnesses {
  RawVec on_a;
  RawVec on_b;
};

/// A vector rounded to lengths; lengths beyond ±2048 m saturate (only in pairs far apart).
[[nodiscard]] Vec3<Length> to_length(const RawVec& fine_vector);

/// Appends a point with the anchors that `ManifoldPoint` describes, unless `keeps` refuses it.
/// The manifold has room.
void add_point(Manifold& manifold, const Witnesses& witnesses, const Vec3<Length>& offset,
               Fine separation, Length margin, std::uint32_t feature);

/// Whether `ManifoldPoint` puts the anchors of a contact with a flat shape on this one's surface.
[[nodiscard]] constexpr bool is_round(const Shape& shape) {
  return is_primitive(shape.kind) && shape.kind != ShapeKind::box &&
         shape.kind != ShapeKind::rounded_box;
}

/// The same where B is round and A is not.
void add_round_point(Manifold& manifold, const Witnesses& witnesses, const Vec3<Length>& offset,
                     Fine separation, Length margin, std::uint32_t feature);

/// One of the two above, as B asks. A is not round.
inline void add_point_on(const Shape& b, Manifold& manifold, const Witnesses& witnesses,
                         const Vec3<Length>& offset, Fine separation, Length margin,
                         std::uint32_t feature) {
  const auto add = is_round(b) ? add_round_point : add_point;
  add(manifold, witnesses, offset, separation, margin, feature);
}

/// The same contact seen from the other body: normal reversed, anchors exchanged.
[[nodiscard]] Manifold flipped(const Manifold& manifold);

/// The surface points of two spheres of the given radii about core points along the normal.
[[nodiscard]] Witnesses inflate(const RawVec& core_a, Length radius_a, const RawVec& core_b,
                                Length radius_b, const Vec3<Unit>& normal);

}  // namespace lockstone::geometry
