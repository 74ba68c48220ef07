#include "core/geometry/shapes/rim_shape.h"

#include "core/geometry/contact/collide_pairs.h"
#include "core/geometry/contact/feature/collide_convex.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/int128.h"
#include "core/math/roots.h"
#include "core/math/trig.h"

namespace lockstone::geometry {
namespace {

constexpr int k_ray_bits = 60;

/// n in the plane of a disc: its direction in the shape's axes, and whether it is long enough to
/// have one.
struct DiscLean {
  Vec3<Unit> direction{};
  bool leans = false;
};

DiscLean lean_of(const PosedShape& shape, Length radius, const Vec3<Unit>& n) {
  constexpr std::int32_t k_least = std::int32_t{1} << (Unit::frac_bits - 12);
  constexpr Fine k_least_fall = Fine{1} << (k_fine_bits - 13);
  const Vec3<Unit> local = rotate_inverse(shape.rotation, n);
  const Unit most = max(abs(local.x), abs(local.z));
  DiscLean lean;
  lean.leans = most.raw > k_least || (most * radius).raw > k_least_fall;
  lean.direction = direction_of(local.x.raw, 0, local.z.raw);
  return lean;
}

RawVec on_rim(const PosedShape& shape, const Disc& disc, Unit x, Unit z) {
  return rotate(shape.rotation, RawVec{(x * disc.radius).raw, disc.height, (z * disc.radius).raw});
}

/// The direction of point `i` of a disc.
Vec3<Unit> disc_direction(std::uint32_t i) {
  const Angle angle =
      Angle::from_raw(static_cast<std::int32_t>(843314857LL * i / k_disc_points));  // 2π i / 16
  const SinCos turn = sin_cos(angle);
  return {turn.cos, {}, turn.sin};
}

/// Whether c lies after a, up to b, which are less than half a turn apart.
bool is_between(const Vec3<Unit>& a, const Vec3<Unit>& b, const Vec3<Unit>& c) {
  const auto side = [](const Vec3<Unit>& p, const Vec3<Unit>& q) {
    return (p.x * q.z).raw - (p.z * q.x).raw;
  };
  return side(a, c) > 0 && side(c, b) >= 0;
}

}  // namespace

void add_disc(const PosedShape& shape, const Disc& disc, int sign, const Vec3<Unit>& n,
              std::uint32_t first_id, ContactFeature& out) {
  out.is_flat = true;
  out.normal = unit_axis(signed_axis(shape.rotation.y, sign));
  const DiscLean lean = lean_of(shape, disc.radius, n);
  for (std::uint32_t k = 0; k < k_disc_points; ++k) {
    // From z to x is counter-clockwise seen along −y.
    const std::uint32_t i = sign > 0 ? k_disc_points - 1 - k : k;
    const Vec3<Unit> here = disc_direction(i), next = disc_direction(i + 1);
    const bool has_deepest = lean.leans && is_between(here, next, lean.direction);
    const auto add_deepest = [&] {
      out.add(on_rim(shape, disc, lean.direction.x, lean.direction.z), first_id + k_disc_deepest);
    };
    if (has_deepest && sign > 0) add_deepest();
    out.add(on_rim(shape, disc, here.x, here.z), first_id + i);
    if (has_deepest && sign < 0) add_deepest();
  }
}

RawVec deepest_of(const PosedShape& shape, const Disc& disc, const Vec3<Unit>& n) {
  const Vec3<Unit> direction = lean_of(shape, disc.radius, n).direction;
  return on_rim(shape, disc, direction.x, direction.z);
}

Fine rim_reach(Length radius, Unit x, Unit z) {
  const auto square = [](Unit c) { return static_cast<std::uint64_t>((c * c).raw); };
  const std::uint64_t length = isqrt_rounded(square(x) + square(z));  // 30 fraction bits
  return Fine{radius.raw} * static_cast<Fine>(length);
}

Length distance_from_axis(const Vec3<Length>& point) {
  const auto square = [](Length c) { return static_cast<std::uint64_t>((c * c).raw); };
  return Length::from_raw(raw::saturate<std::int32_t>(
      static_cast<std::int64_t>(isqrt(square(point.x) + square(point.z)))));
}

std::optional<std::uint32_t> no_vertex_at(const Shape& /*shape*/, const RawVec& /*point*/) {
  return std::nullopt;
}

int no_vertices(const Shape& /*shape*/, std::array<RawVec, 8>& /*out*/) {
  return 0;
}

Manifold below_feature(const PlaneMeeting& plane) {
  ContactFeature feature;
  find_feature(plane.b, -plane.normal, feature);
  return below_points(plane, feature);
}

void take_earlier(RimHit& best, const RimHit& other) {
  if (other.hit && (!best.hit || other.fraction < best.fraction)) best = other;
}

RawVec ray_point(const AxisRay& ray, std::int64_t fraction) {
  const auto part = [fraction](std::int64_t lane) {
    return saturated_product(lane, fraction, k_ray_bits);
  };
  return ray.start + RawVec{part(ray.way.x), part(ray.way.y), part(ray.way.z)};
}

RimHit meet_disc(const AxisRay& ray, const Disc& disc, int sign) {
  const Fine above = sign * (ray.start.y - disc.height), rise = sign * ray.way.y;
  if (above < 0 || rise >= 0 || above > -rise) return {};
  RimHit hit{true, 0, {0, sign, 0}};
  hit.fraction = static_cast<std::int64_t>(
      round_divide(UInt128{0, static_cast<std::uint64_t>(above)} << k_ray_bits,
                   static_cast<std::uint64_t>(-rise)));
  const RawVec at = ray_point(ray, hit.fraction);
  hit.hit = norm(at.x, 0, at.z) <= static_cast<std::uint64_t>(fine(disc.radius));
  return hit;
}

ShapeRayHit ray_hit(const RimHit& hit, const Mat3& rotation) {
  if (!hit.hit) return {};
  const std::int64_t fraction = raw::round_shift(hit.fraction, k_ray_bits - Unit::frac_bits);
  const Vec3<Unit> local = direction_of(hit.outward.x, hit.outward.y, hit.outward.z);
  return {true, Unit::from_raw(static_cast<std::int32_t>(fraction)),
          unit_axis(lockstone::rotate(rotation, local))};
}

}  // namespace lockstone::geometry
