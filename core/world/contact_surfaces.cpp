// The combined surface of a contact's two sides.

#include "core/geometry/shape_properties.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

Vec3<Length> centre_of(const Manifold& manifold, Vec3<Length> ManifoldPoint::*anchor) {
  std::int64_t sum[3] = {};
  for (int i = 0; i < manifold.count; ++i) {
    const Vec3<Length>& at = manifold.points[static_cast<std::size_t>(i)].*anchor;
    for (int axis = 0; axis < 3; ++axis)
      sum[axis] += at[axis].raw;
  }
  const auto mean = [&](std::int64_t x) {
    return Length::from_raw(static_cast<std::int32_t>(raw::round_divide(x, manifold.count)));
  };
  return {mean(sum[0]), mean(sum[1]), mean(sum[2])};
}

bool is_round(const BodyRecord& body) {
  const ShapeKind kind = body.shape().kind;
  return kind == ShapeKind::sphere || kind == ShapeKind::capsule;
}

}  // namespace

// A part's own surface, or the body's. Written in place: copying the whole struct right after its
// fields were written would wait for all these stores.
void World::Impl::find_surface(const Pair& pair, const Surface* surface_a, const Surface* surface_b,
                               const Manifold& manifold, ContactSurface& both) const {
  const BodyRecord& body_a = bodies[pair.a];
  const BodyRecord& body_b = bodies[pair.b];
  const Surface a = surface_a != nullptr ? *surface_a : body_a.surface();
  const Surface b = surface_b != nullptr ? *surface_b : body_b.surface();
  both = {};
  both.friction = combined_friction(a, b);
  both.restitution = combined_restitution(a, b);
  both.tag_a = a.tag;
  both.tag_b = b.tag;
  if (const Coefficient rolling = combined_rolling(a, b); rolling > Coefficient{})
    both.rolling_arm = rounded<Length>(rolling_radius(pair) * rolling);
  if (manifold.count == 0) return;
  if (body_a.has_surface_motion()) {
    add_drive(pair.a, centre_of(manifold, &ManifoldPoint::anchor_a), -1, manifold.normal, both);
  }
  if (body_b.has_surface_motion()) {
    add_drive(pair.b, centre_of(manifold, &ManifoldPoint::anchor_b), 1, manifold.normal, both);
  }
}

Length World::Impl::rolling_radius(const Pair& pair) const {
  const bool round_a = is_round(bodies[pair.a]), round_b = is_round(bodies[pair.b]);
  const bool use_a = round_a || (!round_b && bodies[pair.a].is_dynamic());
  const bool use_b = round_b || (!round_a && bodies[pair.b].is_dynamic());
  const Length a = inner_radii[pair.a], b = inner_radii[pair.b];
  if (use_a && use_b) return min(a, b);
  return use_a ? a : b;
}

// v + ω × r of a surface that moves in place.
void World::Impl::add_drive(std::uint32_t body, const Vec3<Length>& arm, std::int32_t sign,
                            const Vec3<Unit>& normal, ContactSurface& surface) const {
  const BodyRecord& record = bodies[body];
  const Vec3<SolverVelocity> along = rotate(rotations[body], record.surface_velocity());
  const Vec3<Rate> turning = rotate(rotations[body], record.surface_turning());
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3, k = (i + 2) % 3;
    const std::int64_t around =
        std::int64_t{turning[j].raw} * arm[k].raw - std::int64_t{turning[k].raw} * arm[j].raw;
    const std::int64_t speed = along[i].raw + raw::round_shift(around, Length::frac_bits);
    surface.drive[i].raw = raw::saturate<std::int32_t>(surface.drive[i].raw + sign * speed);
  }
  const std::int64_t about = raw::round_shift(dot(turning, normal).raw, Unit::frac_bits);
  surface.twist_drive.raw = raw::saturate<std::int32_t>(surface.twist_drive.raw + sign * about);
}

}  // namespace lockstone
