// Capsule against capsule. Two points along nearly parallel sides, after the idea of clipping one
// core against the end planes of the other (Box3D, b3CollideCapsules).
#include <lockstone/assert.h>

#include "core/geometry/contact/collide_pairs.h"
#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/normals.h"
#include "core/geometry/numeric/segment.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

struct CorePair {
  Segment a;
  Segment b;
  Fine radii = 0;  ///< the sum
  Fine smaller_radius = 0;
};

struct CoreContact {
  Vec3<Unit> normal;
  RawVec on_a;
  RawVec on_b;
  Fine distance = 0;
};

/// A direction square to both axes; parallel axes leave a choice.
Vec3<Unit> common_perpendicular(const CorePair& pair) {
  const RawVec k = cross_of(pair.a.axis, pair.b.axis);
  return k == RawVec{} ? perpendicular_to(pair.a.axis) : direction_of(k.x, k.y, k.z);
}

/// The closest points of the cores. Where the cores cross, the normal is the cross product, which
/// is exact however near they are; cores that meet leave its sign open, and it stays positive.
CoreContact closest_cores(const CorePair& pair) {
  const ClosestParameters at = closest_parameters(pair.a, pair.b);
  CoreContact contact;
  contact.on_a = point_at(pair.a, at.on_a);
  contact.on_b = point_at(pair.b, at.on_b);
  const RawVec gap = contact.on_b - contact.on_a;
  if (!at.crossing && !is_negligible(gap)) {
    const Direction d = direction(gap.x, gap.y, gap.z);
    contact.normal = d.unit;
    contact.distance = static_cast<Fine>(d.length);
    return contact;
  }
  const Vec3<Unit> square = common_perpendicular(pair);
  const Fine distance = at.crossing ? dot(pair.b.centre, square) : 0;
  contact.normal = signed_axis(square, sign_of(distance));
  contact.distance = magnitude_of(distance);
  LKS_ASSERT(contact.distance >= 0 && is_unit(contact.normal));
  return contact;
}

/// The part of A's core, by parameter, beside B's core.
struct Overlap {
  Fine low = 0;
  Fine high = 0;
};

Overlap overlap_of(const CorePair& pair) {
  const RawVec reach = along(pair.b.axis, pair.b.half);
  const Fine first = dot(pair.b.centre - reach, pair.a.axis);
  const Fine second = dot(pair.b.centre + reach, pair.a.axis);
  const Fine half = fine(pair.a.half);
  return {std::max(-half, std::min(first, second)), std::min(half, std::max(first, second))};
}

/// Whether two points describe the contact better than one: an angle below 1/32, a common side of
/// some length, and so little divergence across the normal that both points stay within 1/1000 of
/// the smaller radius of the surfaces.
bool lies_along(const CorePair& pair, const CoreContact& contact, const Overlap& overlap) {
  LKS_ASSERT(is_unit(contact.normal) && pair.radii > 0);
  const RawVec k = cross_of(pair.a.axis, pair.b.axis);
  const auto sine = static_cast<Fine>(norm(k.x, k.y, k.z) >> 30);             // 30 fraction bits
  const std::int64_t lean = lockstone::dot(contact.normal, pair.a.axis).raw;  // 60 fraction bits
  if (sine > (Fine{1} << 25) || magnitude_of(lean) > (Fine{1} << 55)) return false;
  const Fine length = overlap.high - overlap.low;
  if (length <= pair.radii / 16) return false;
  const auto across = static_cast<std::int32_t>(dot(k, contact.normal) >> 30);
  return magnitude_of(scaled(length, across)) <= pair.smaller_radius / 16;
}

}  // namespace

Manifold collide_capsules(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                          Length margin) {
  LKS_ASSERT(a.shape.kind == ShapeKind::capsule && b.shape.kind == ShapeKind::capsule);
  const Length radius_a = a.shape.size.x;
  const Length radius_b = b.shape.size.x;
  const CorePair pair{core_segment(a.shape, a.rotation, {}),
                      core_segment(b.shape, b.rotation, offset), fine(radius_a) + fine(radius_b),
                      fine(min(radius_a, radius_b))};
  const CoreContact contact = closest_cores(pair);
  Manifold manifold;
  manifold.normal = contact.normal;
  if (!keeps(contact.distance - pair.radii, margin)) return manifold;
  const Overlap overlap = overlap_of(pair);
  if (!lies_along(pair, contact, overlap)) {
    add_point(manifold, inflate(contact.on_a, radius_a, contact.on_b, radius_b, contact.normal),
              offset, contact.distance - pair.radii, margin, 0);
    return manifold;
  }
  std::uint32_t feature = 1;
  for (const Fine s : {overlap.low, overlap.high}) {
    const RawVec on_a = point_at(pair.a, s);
    const RawVec opposite = on_a + along(contact.normal, contact.distance);
    const RawVec on_b = point_at(pair.b, closest_parameter(pair.b, opposite));
    const Fine separation = dot(on_b - on_a, contact.normal) - pair.radii;
    add_point(manifold, inflate(on_a, radius_a, on_b, radius_b, contact.normal), offset, separation,
              margin, feature++);
  }
  LKS_ASSERT(is_manifold(manifold));
  return manifold;
}

}  // namespace lockstone::geometry
