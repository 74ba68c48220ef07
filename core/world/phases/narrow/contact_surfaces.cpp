#include "core/world/phases/narrow/contact_surfaces.h"

#include <algorithm>

#include "core/dynamics/state/surface.h"

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

std::int64_t cross(const Vec3<Unit>& n, const std::int64_t (&x)[3], int i) {
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  return raw::round_shift(n[j].raw * x[k] - n[k].raw * x[j], Unit::frac_bits);
}

// A surface that turns about the contact's normal n by θ in a tick carries along chords of a
// circle, but its velocity u at the tick's beginning is along the tangent: without this, friction
// would let bodies on a turntable drift outwards by θ²/2 of the radius a tick. Adds n × u·(1 − cos
// θ)/θ − u·(1 − sin θ/θ), both fractions by Padé approximants that err by less than 2^-7 of
// themselves up to one radian. From substep to substep the drive gains n × u·θ/substeps: the mean
// alone would ask friction for the whole tick's turn in the first substep. `about` is the rate of
// turning, 1/s, Q20; `speed` is u, m/s, Q20, of which no more counts than a drive holds.
void add_arc(std::int64_t about, const std::int64_t (&speed)[3], const Vec3<Unit>& normal,
             const WorldDef& def, std::int32_t sign, ContactSurface& surface) {
  constexpr std::int64_t k_one = 1 << 24, k_most = 8 * k_one;
  const std::int64_t angle =
      std::clamp(raw::round_divide(about * 16, std::int64_t{def.tick_rate}), -k_most, k_most);
  const std::int64_t square = raw::round_shift(angle * angle, 24);
  const std::int64_t at_once = raw::round_divide(angle * k_one, 2 * k_one + square / 6);
  const std::int64_t inwards = at_once + raw::round_divide(at_once, std::int64_t{def.substeps});
  const std::int64_t in_substep = raw::round_divide(2 * at_once, std::int64_t{def.substeps});
  const std::int64_t behind = raw::round_divide(square * k_one, 6 * k_one + square * 3 / 10);
  const std::int64_t along[] = {raw::saturate<std::int32_t>(speed[0]),
                                raw::saturate<std::int32_t>(speed[1]),
                                raw::saturate<std::int32_t>(speed[2])};
  std::int64_t along_normal = 0;
  for (int i = 0; i < 3; ++i)
    along_normal += normal[i].raw * along[i] >> 4;
  along_normal = raw::round_shift(along_normal, Unit::frac_bits - 4);
  for (int i = 0; i < 3; ++i) {
    const std::int64_t across =
        along[i] - raw::round_shift(normal[i].raw * along_normal, Unit::frac_bits);
    const std::int64_t towards = cross(normal, along, i);
    const std::int64_t bent = raw::round_shift(towards * inwards - across * behind, 24);
    const std::int64_t gain = raw::round_shift(towards * in_substep, 24);
    surface.drive[i].raw = raw::saturate<std::int32_t>(surface.drive[i].raw + sign * bent);
    surface.arc[i].raw = raw::saturate<std::int32_t>(surface.arc[i].raw + sign * gain);
  }
}

// ω × r along an axis, Q20.
std::int64_t speed_around(const Vec3<Rate>& turning, const Vec3<Length>& arm, int i) {
  const int j = (i + 1) % 3, k = (i + 2) % 3;
  const std::int64_t around =
      std::int64_t{turning[j].raw} * arm[k].raw - std::int64_t{turning[k].raw} * arm[j].raw;
  return raw::round_shift(around, Length::frac_bits);
}

// Of a kinematic body that turns.
void add_arc(const BodyRecord& body, const Vec3<Length>& arm, std::int32_t sign,
             const Vec3<Unit>& normal, const WorldDef& def, ContactSurface& surface) {
  constexpr int k_to_rate = Rate::frac_bits - Velocity::frac_bits;
  Vec3<Rate> turning;
  for (int i = 0; i < 3; ++i)
    turning[i].raw = raw::saturate<std::int32_t>(
        raw::scale_binary(body.spin[i].raw, k_to_rate - body.scale_exponent));
  const std::int64_t about = raw::round_shift(dot(turning, normal).raw, Unit::frac_bits);
  if (about == 0) return;
  std::int64_t along[3];
  for (int i = 0; i < 3; ++i)
    along[i] = speed_around(turning, arm, i);
  add_arc(about, along, normal, def, sign, surface);
}

bool is_round(const BodyRecord& body) {
  const ShapeKind kind = body.shape().kind;
  return kind == ShapeKind::sphere || kind == ShapeKind::capsule;
}

Length rolling_radius(const WorldData& world, const Pair& pair) {
  const bool round_a = is_round(world.bodies[pair.a]), round_b = is_round(world.bodies[pair.b]);
  const bool use_a = round_a || (!round_b && world.bodies[pair.a].is_dynamic());
  const bool use_b = round_b || (!round_a && world.bodies[pair.b].is_dynamic());
  const Length a = world.cache.inner_radius(pair.a), b = world.cache.inner_radius(pair.b);
  if (use_a && use_b) return min(a, b);
  return use_a ? a : b;
}

// v + ω × r of a surface that moves in place.
void add_drive(const WorldData& world, std::uint32_t body, const Vec3<Length>& arm,
               std::int32_t sign, const Vec3<Unit>& normal, ContactSurface& surface) {
  const BodyRecord& record = world.bodies[body];
  const Vec3<SolverVelocity> along = rotate(world.cache.rotation(body), record.surface_velocity());
  const Vec3<Rate> turning = rotate(world.cache.rotation(body), record.surface_turning());
  std::int64_t speed[3];
  for (int i = 0; i < 3; ++i) {
    speed[i] = along[i].raw + speed_around(turning, arm, i);
    surface.drive[i].raw = raw::saturate<std::int32_t>(surface.drive[i].raw + sign * speed[i]);
  }
  const std::int64_t about = raw::round_shift(dot(turning, normal).raw, Unit::frac_bits);
  surface.twist_drive.raw = raw::saturate<std::int32_t>(surface.twist_drive.raw + sign * about);
  add_arc(about, speed, normal, world.def, sign, surface);
}

void apply_rules(const WorldData& world, const Pair& pair, ContactSurface& surface,
                 Coefficient& rolling) {
  const std::optional<PairSurface> ruled = ruled_surface(
      world, world.header, rule_key(pair.a, pair.b), rule_key(surface.tag_a, surface.tag_b));
  if (!ruled) return;
  surface.friction = ruled->friction;
  surface.restitution = ruled->restitution;
  rolling = ruled->rolling_resistance;
}

}  // namespace

// A part's own surface, or the body's. Written in place: copying the whole struct right after its
// fields were written would wait for all these stores.
void find_surface(const WorldData& world, const Pair& pair, const Surface* surface_a,
                  const Surface* surface_b, const Manifold& manifold, ContactSurface& both) {
  const BodyRecord& body_a = world.bodies[pair.a];
  const BodyRecord& body_b = world.bodies[pair.b];
  const Surface a = surface_a != nullptr ? *surface_a : body_a.surface();
  const Surface b = surface_b != nullptr ? *surface_b : body_b.surface();
  both = {};
  both.friction = combined_friction(a, b);
  both.restitution = combined_restitution(a, b);
  both.tag_a = a.tag;
  both.tag_b = b.tag;
  Coefficient rolling = combined_rolling(a, b);
  if (world.header.pair_rule_count != 0 || world.header.surface_rule_count != 0)
    apply_rules(world, pair, both, rolling);
  if (rolling > Coefficient{})
    both.rolling_arm = rounded<Length>(rolling_radius(world, pair) * rolling);
  if (manifold.count == 0) return;
  const auto add_side = [&](std::uint32_t index, const BodyRecord& body,
                            Vec3<Length> ManifoldPoint::*anchor, std::int32_t sign) {
    const bool turns = !body.is_dynamic() && body.spin != Vec3<Velocity>{};
    if (!turns && !body.has_surface_motion()) return;
    const Vec3<Length> arm = centre_of(manifold, anchor);
    if (body.has_surface_motion()) add_drive(world, index, arm, sign, manifold.normal, both);
    if (turns) add_arc(body, arm, sign, manifold.normal, world.def, both);
  };
  add_side(pair.a, body_a, &ManifoldPoint::anchor_a, -1);
  add_side(pair.b, body_b, &ManifoldPoint::anchor_b, 1);
}

}  // namespace lockstone
