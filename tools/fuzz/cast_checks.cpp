#include "core/geometry/dispatch/raycast.h"
#include "core/geometry/distance/motion/shape_cast.h"
#include "tools/fuzz/pair_checks.h"
#include "tools/fuzz/surface.h"

namespace lockstone::fuzz {
namespace {

// B on its way: the distance is convex along it.
struct Cast {
  const Pair& pair;
  const PosedShape a = pair.a.posed();
  const PosedShape b = pair.b.posed();

  [[nodiscard]] Real3 at(double fraction) const {
    return real(pair.cast_from) + real(pair.way) * fraction;
  }
  /// Of the plane and the fraction, whose step is 2^-30 of the way.
  [[nodiscard]] double slack() const { return 2 * k_micrometre + rim_slack(pair); }
  /// Of depths: 13e-9 of the sizes and the way more.
  [[nodiscard]] double depth_slack() const {
    const double far = norm(real(pair.cast_from)) + norm(real(pair.way));
    return slack() + 13e-9 * (pair.a.size() + pair.b.size() + far);
  }
  [[nodiscard]] double signed_distance(double fraction) const {
    const Vec3<Length> offset = to_length(at(fraction));
    const ClosestPoints found = distance(a, b, offset);
    return found.overlapping ? -real(penetration(a, b, offset).depth) : real(found.distance);
  }
  /// The least distance along the way, by golden sections.
  [[nodiscard]] double least() const {
    constexpr double k_golden = 0.6180339887498949;
    double low = 0, high = 1;
    double inner[2] = {1 - k_golden, k_golden};
    double found[2] = {signed_distance(inner[0]), signed_distance(inner[1])};
    for (int i = 0; i < 30; ++i) {
      const bool left = found[0] < found[1];
      (left ? high : low) = inner[left ? 1 : 0];
      inner[left ? 1 : 0] = inner[left ? 0 : 1];
      found[left ? 1 : 0] = found[left ? 0 : 1];
      inner[left ? 0 : 1] = left ? high - k_golden * (high - low) : low + k_golden * (high - low);
      found[left ? 0 : 1] = signed_distance(inner[left ? 0 : 1]);
    }
    return std::min({found[0], found[1], signed_distance(1)});
  }
  /// Whether the plane along a direction separates the shapes the whole way.
  [[nodiscard]] bool separates(const Vec3<Unit>& direction) const {
    const Real3 n = direction_of(real(direction));
    return separation(pair, at(0), n) > 0 && separation(pair, at(1), n) > 0;
  }
};

void check_hit(const Cast& cast, const ShapeCastHit& hit, Verdict& verdict) {
  const Pair& pair = cast.pair;
  const Real3 n = direction_of(real(hit.normal));
  const Real3 there = cast.at(real(hit.fraction));
  const double allowed = cast.slack();
  // The plane of the hit separates there, and B comes through it: so it does all the way before.
  verdict.measure(Check::cast, separation(pair, there, n), allowed);
  verdict.measure(Check::cast, std::max(0.0, dot(n, real(pair.way))), allowed);
  const Real3 on_a = real(hit.point_a), on_b = real(hit.point_b);
  verdict.measure(Check::witness, norm(on_b + there - on_a), allowed + 2 * k_micrometre);
  // Points are rounded to 0.95 µm a lane, and radii taken along a normal of 30 bits.
  const double on_surface = allowed + 2e-9 * pair.radii() + uneven_slack(pair);
  verdict.measure(Check::witness, outside(pair.a, on_a), on_surface);
  verdict.measure(Check::witness, outside(pair.b, on_b), on_surface);
}

void check_ray_at(const Body& body, const Vec3<Length>& origin, const Vec3<Length>& way,
                  Verdict& verdict) {
  const ShapeRayHit hit = cast_ray(body.posed(), origin, way);
  const Real3 o = real(origin), t = real(way);
  const double allowed = 2 * k_micrometre + std::ldexp(norm(t), -30) + 4e-9 * body.size() +
                         6e-9 * body.rim_radius() + (body.is_rounded() ? 2 * body.unevenness : 0);
  if (!hit.hit) {
    verdict.require(Check::ray_miss, !is_entered(body, o, t, allowed));
    return;
  }
  if (hit.normal == Vec3<Unit>{}) {
    verdict.require(Check::ray, hit.fraction == Unit{});
    verdict.measure(Check::ray, std::max(0.0, outside(body, o)), allowed);
    return;
  }
  const Real3 n = direction_of(real(hit.normal));
  const Real3 point = o + t * real(hit.fraction);
  verdict.measure(Check::ray, norm(real(hit.normal)) - 1, std::ldexp(1.0, -29));
  verdict.measure(Check::ray, above_planes(body, point), allowed);
  verdict.require(Check::ray, !is_entered(body, o, t * real(hit.fraction), allowed));
  verdict.measure(Check::ray, std::max(0.0, dot(n, direction_of(t))), 1e-8);
}

}  // namespace

void check_cast(const Pair& pair, Verdict& verdict) {
  if (pair.half_space() != nullptr) return;
  const Cast cast{pair};
  const ShapeCastHit hit = cast_shape(cast.a, cast.b, pair.cast_from, pair.way);
  const ShapeCastHit other = cast_shape(cast.b, cast.a, -pair.cast_from, -pair.way);
  verdict.require(Check::flip, hit.hit == other.hit && hit.fraction == other.fraction &&
                                   hit.normal == -other.normal && hit.point_a == other.point_b);
  if (hit.overlapping) {
    verdict.require(Check::cast, hit.fraction == Unit{});
    verdict.measure(Check::cast, std::max(0.0, cast.signed_distance(0)), cast.slack());
    return;
  }
  if (hit.hit) return check_hit(cast, hit, verdict);
  const ClosestPoints start = distance(cast.a, cast.b, pair.cast_from);
  const ClosestPoints end = distance(cast.a, cast.b, pair.cast_from + pair.way);
  const bool proven = cast.separates(start.normal) || cast.separates(end.normal);
  verdict.measure(Check::cast_miss, proven ? 0 : std::min(0.0, cast.least()), cast.depth_slack());
}

void check_ray(const Pair& pair, Verdict& verdict) {
  check_ray_at(pair.a, pair.ray_origin, pair.ray_way, verdict);
  check_ray_at(pair.b, pair.ray_origin, pair.ray_way, verdict);
}

}  // namespace lockstone::fuzz
