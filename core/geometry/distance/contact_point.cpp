#include "core/geometry/distance/contact_point.h"

#include <utility>

namespace lockstone::geometry {
namespace {

/// (a + b) / 2 as a length. |a|, |b| < 2^12 m.
Length midpoint(Fine a, Fine b) {
  const Fine middle = raw::round_shift(raw::add(a, b), k_fine_per_length + 1);
  return Length::from_raw(raw::saturate<std::int32_t>(middle));
}

Length to_length(Fine x) {
  return Length::from_raw(raw::saturate<std::int32_t>(raw::round_shift(x, k_fine_per_length)));
}

}  // namespace

Vec3<Length> to_length(const RawVec& fine_vector) {
  return {to_length(fine_vector.x), to_length(fine_vector.y), to_length(fine_vector.z)};
}

void add_round_point(Manifold& manifold, const Witnesses& witnesses, const Vec3<Length>& offset,
                     Fine separation, Length margin, std::uint32_t feature) {
  const bool apart = to_separation(separation).raw > 0;
  const RawVec& surface = witnesses.on_b;
  add_point(manifold, {apart ? witnesses.on_a : surface, surface}, offset, separation, margin,
            feature);
}

void add_point(Manifold& manifold, const Witnesses& witnesses, const Vec3<Length>& offset,
               Fine separation, Length margin, std::uint32_t feature) {
  const Displacement rounded_separation = to_separation(separation);
  if (!keeps(rounded_separation, margin)) return;
  LKS_ASSERT(manifold.count < k_max_manifold_points);
  ManifoldPoint& point = manifold.points[static_cast<std::size_t>(manifold.count++)];
  const auto& [a, b] = witnesses;
  point.separation = rounded_separation;
  point.feature = feature;
  if (rounded_separation.raw > 0) {
    point.anchor_a = to_length(a);
    point.anchor_b = to_length(b - fine(offset));
  } else {
    point.anchor_a = {midpoint(a.x, b.x), midpoint(a.y, b.y), midpoint(a.z, b.z)};
    point.anchor_b = point.anchor_a - offset;
  }
}

Manifold flipped(const Manifold& manifold) {
  Manifold result = manifold;
  result.normal = -manifold.normal;
  for (ManifoldPoint& point : result.points)
    std::swap(point.anchor_a, point.anchor_b);
  return result;
}

Witnesses inflate(const RawVec& core_a, Length radius_a, const RawVec& core_b, Length radius_b,
                  const Vec3<Unit>& normal) {
  return {core_a + along(normal, radius_a), core_b - along(normal, radius_b)};
}

}  // namespace lockstone::geometry
