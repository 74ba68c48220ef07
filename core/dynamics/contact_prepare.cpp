#include "core/dynamics/contact_prepare.h"

#include <algorithm>

#include "core/dynamics/contact_solver.h"
#include "core/math/block_float.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

constexpr std::int64_t k_one_q30 = std::int64_t{1} << 30;

// Contacts are as stiff as the substep resolves, 3/16 of its rate (at 1/4 tall stacks hum, at 1/8
// they buckle under their weight), and heavily overdamped, so that penetration is pushed out
// without adding energy.
constexpr std::int64_t contact_hertz(std::int64_t substep_rate) {
  return substep_rate * 3 / 16;
}
constexpr std::int32_t k_contact_damping_ratio = 10;

// 2π in Q28, from the digits 6.28318530717958647692.
constexpr std::int64_t k_two_pi_q28 = 1686629713;

// With ω = 2π·hertz: a1 = 2ζ + hω, a2 = hω·a1, a3 = 1/(1 + a2);
// bias rate = ω/a1, mass scale = a2·a3, impulse scale = a3.
Softness make_softness(std::int64_t hertz, std::int64_t substep_rate) {
  const std::int64_t h_omega_q28 = raw::round_divide(k_two_pi_q28 * hertz, substep_rate);
  const std::int64_t a1_q28 = (std::int64_t{2 * k_contact_damping_ratio} << 28) + h_omega_q28;
  const std::int64_t a2_q24 = raw::round_shift((h_omega_q28 >> 2) * (a1_q28 >> 4), 26);
  const std::int64_t one_plus_q24 = (std::int64_t{1} << 24) + a2_q24;
  const std::int64_t a3_q30 = raw::round_divide(std::int64_t{1} << 54, one_plus_q24);
  const std::int64_t omega_q20 = raw::round_shift(k_two_pi_q28 * hertz, 8);
  const std::int64_t rate_q20 = raw::round_divide(omega_q20 << 20, a1_q28 >> 8);
  return {static_cast<std::int32_t>(rate_q20), static_cast<std::int32_t>(k_one_q30 - a3_q30),
          static_cast<std::int32_t>(a3_q30)};
}

// What a body contributes to a pair.
struct Side {
  const InverseInertia& inertia;
  int scale_exponent;
  std::int32_t share;  // α, Q30
};

// r̄ = r / 2^k in Q30 from r in Q20; beyond ±2 it is clamped.
Lanes32 normalized_arm(const Vec3<Length>& r, int scale_exponent, int& saturations) {
  Lanes32 arm{};
  for (int i = 0; i < 3; ++i) {
    const std::int64_t wide = std::int64_t{r[i].raw} << (10 - scale_exponent);
    arm[static_cast<std::size_t>(i)] = raw::saturate<std::int32_t>(wide);
    saturations += arm[static_cast<std::size_t>(i)] != wide ? 1 : 0;
  }
  return arm;
}

// r̄ × u in Q30, clamped to ±1: an arm on or in the body gives no more.
Lanes32 lever(const Lanes32& r, const Lanes32& u) {
  const auto entry = [](std::int64_t q60) {
    return static_cast<std::int32_t>(std::clamp(raw::round_shift(q60, 30), -k_one_q30, k_one_q30));
  };
  return {entry(std::int64_t{r[1]} * u[2] - std::int64_t{r[2]} * u[1]),
          entry(std::int64_t{r[2]} * u[0] - std::int64_t{r[0]} * u[2]),
          entry(std::int64_t{r[0]} * u[1] - std::int64_t{r[1]} * u[0])};
}

Lanes32 scaled(const Lanes32& v, std::int32_t factor_q30) {
  Lanes32 result{};
  for (std::size_t i = 0; i < 3; ++i) {
    result[i] = static_cast<std::int32_t>(raw::round_shift(std::int64_t{v[i]} * factor_q30, 30));
  }
  return result;
}

// M·a in Q(30 − exponent) of the pair, which is at least that of the body.
Lanes32 respond(const InverseInertia& m, const Lanes32& a, int pair_exponent) {
  const int shift = 30 + pair_exponent - m.exponent;
  const auto row = [&](std::int32_t x, std::int32_t y, std::int32_t z) {
    return static_cast<std::int32_t>(raw::round_shift(dot({x, y, z}, a), shift));
  };
  return {row(m.xx, m.xy, m.xz), row(m.xy, m.yy, m.yz), row(m.xz, m.yz, m.zz)};
}

ContactRow make_row(const Lanes32& lever_a, const Lanes32& lever_b, const Side& a, const Side& b,
                    int exponent) {
  ContactRow row;
  row.gain_a = scaled(lever_a, a.share);
  row.gain_b = scaled(lever_b, b.share);
  row.read_a = respond(a.inertia, lever_a, exponent);
  row.read_b = respond(b.inertia, lever_b, exponent);
  // 1/m̄ = 1 + Σ gain·read in Q30; each sum is below 2^62.
  const std::int64_t turning = raw::round_shift(dot(row.gain_a, row.read_a), 30 - exponent) +
                               raw::round_shift(dot(row.gain_b, row.read_b), 30 - exponent);
  const std::int64_t inverse = k_one_q30 + std::max<std::int64_t>(turning, 0);
  row.mass = static_cast<std::int32_t>(raw::round_divide(std::int64_t{1} << 60, inverse));
  return row;
}

std::int32_t soft_mass(std::int32_t mass_q30, const Softness& softness) {
  return static_cast<std::int32_t>(
      raw::round_shift(std::int64_t{mass_q30} * softness.mass_scale, 30));
}

ContactAxis make_axis(const Vec3<Unit>& u, const Side& a, const Side& b) {
  const Lanes32 unit = {u.x.raw, u.y.raw, u.z.raw};
  return {unit, scaled(unit, a.share), scaled(unit, b.share)};
}

struct Tangents {
  Vec3<Unit> first;
  Vec3<Unit> second;
};

// The first tangent lies across a coordinate axis, the second across normal and first. Zero when
// the normal is that axis.
Tangents tangents_across(const Vec3<Unit>& n, std::uint8_t axis) {
  const std::int64_t x = n.x.raw, y = n.y.raw, z = n.z.raw;
  const Vec3<Unit> first = axis == 0   ? direction_of(0, z, -y)
                           : axis == 1 ? direction_of(-z, 0, x)
                                       : direction_of(y, -x, 0);
  return {first, rounded<Unit>(cross(n, first))};
}

// The axis of the tick before as long as the normal keeps away from it, so that friction impulses
// keep their meaning; else the one that the normal is farthest from.
std::uint8_t choose_tangent_axis(const Vec3<Unit>& n, const ContactRecord& record) {
  constexpr Unit k_too_near = Unit::from_ratio(7, 8);
  if (record.count > 0 && abs(n[record.tangent_axis]) < k_too_near) return record.tangent_axis;
  const Unit x = abs(n.x), y = abs(n.y), z = abs(n.z);
  if (x <= y && x <= z) return 0;
  return y <= z ? 1 : 2;
}

// The impulses that a point of the same features ended with a tick ago.
void start_from(const ContactRecord& record, std::uint32_t feature, ContactPoint& point) {
  for (std::size_t i = 0; i < record.count; ++i) {
    const ContactPointRecord& old = record.points[i];
    if (old.feature != feature) continue;
    point.normal.impulse = old.normal_impulse.raw;
    point.tangent[0].impulse = old.tangent_impulse_1.raw;
    point.tangent[1].impulse = old.tangent_impulse_2.raw;
    return;
  }
}

// Friction impulses in other tangents: the vector stays, its coordinates change.
void change_tangents(const Tangents& from, const Tangents& to, ContactPoint& point) {
  const std::int64_t p1 = point.tangent[0].impulse, p2 = point.tangent[1].impulse;
  const auto coordinate = [&](const Vec3<Unit>& axis) {
    const std::int64_t along_first = raw::round_shift(dot(from.first, axis).raw, 30);
    const std::int64_t along_second = raw::round_shift(dot(from.second, axis).raw, 30);
    return raw::saturate<std::int32_t>(raw::round_shift(p1 * along_first + p2 * along_second, 30));
  };
  point.tangent[0].impulse = coordinate(to.first);
  point.tangent[1].impulse = coordinate(to.second);
}

// The normal row at the mean of the points.
void make_common_row(const Side& a, const Side& b, ContactConstraint& out) {
  Lanes64 sum_a{}, sum_b{};
  for (int i = 0; i < out.count; ++i) {
    const ContactPoint& point = out.points[static_cast<std::size_t>(i)];
    for (std::size_t lane = 0; lane < 3; ++lane) {
      sum_a[lane] += point.lever_a[lane];
      sum_b[lane] += point.lever_b[lane];
    }
  }
  const auto mean = [&](const Lanes64& sum) {
    const auto lane = [&](std::int64_t x) {
      return static_cast<std::int32_t>(raw::round_divide(x, out.count));
    };
    return Lanes32{lane(sum[0]), lane(sum[1]), lane(sum[2])};
  };
  out.common = make_row(mean(sum_a), mean(sum_b), a, b, out.exponent);
  out.common_soft_mass = soft_mass(out.common.mass, out.softness);
}

}  // namespace

ContactSoftness ContactSoftness::of(const TimeStep& step) {
  const std::int64_t rate = step.substep_rate();
  const std::int64_t hertz = contact_hertz(rate);
  return {make_softness(hertz, rate), make_softness(2 * hertz, rate)};
}

int prepare_contact(const ContactInput& in, const ContactSoftness& softness,
                    ContactConstraint& out) {
  int saturations = 0;
  const BlockFloat mass_a = in.body_a.inverse_mass_value();
  const BlockFloat mass_b = in.body_b.inverse_mass_value();
  const Side a{in.solver_a.inverse_inertia, in.body_a.scale_exponent, ratio(mass_a, mass_b).raw};
  const Side b{in.solver_b.inverse_inertia, in.body_b.scale_exponent, ratio(mass_b, mass_a).raw};

  out.tangent_axis = choose_tangent_axis(in.manifold.normal, in.record);
  const Tangents tangents = tangents_across(in.manifold.normal, out.tangent_axis);
  out.exponent = std::max(a.inertia.exponent, b.inertia.exponent);
  out.count = in.manifold.count;
  out.friction = mixed_friction(in.surfaces).raw;
  out.restitution = mixed_restitution(in.surfaces).raw;
  const bool immovable = a.share == 0 || b.share == 0;
  out.softness = immovable ? softness.against_immovable : softness.between_moving;
  out.normal = make_axis(in.manifold.normal, a, b);
  out.tangent[0] = make_axis(tangents.first, a, b);
  out.tangent[1] = make_axis(tangents.second, a, b);

  for (int i = 0; i < out.count; ++i) {
    const ManifoldPoint& from = in.manifold.points[static_cast<std::size_t>(i)];
    ContactPoint& point = out.points[static_cast<std::size_t>(i)];
    point = {};
    const Lanes32 arm_a = normalized_arm(from.anchor_a, a.scale_exponent, saturations);
    const Lanes32 arm_b = normalized_arm(from.anchor_b, b.scale_exponent, saturations);
    point.lever_a = lever(arm_a, out.normal.unit);
    point.lever_b = lever(arm_b, out.normal.unit);
    point.normal = make_row(point.lever_a, point.lever_b, a, b, out.exponent);
    for (int t = 0; t < 2; ++t) {
      const Lanes32& u = out.tangent[t].unit;
      point.tangent[t] = make_row(lever(arm_a, u), lever(arm_b, u), a, b, out.exponent);
    }
    point.soft_mass = soft_mass(point.normal.mass, out.softness);
    point.separation = std::clamp(from.separation.raw, -(1 << 30), 1 << 30);
    point.approach =
        relative_velocity(out.normal, point.normal, out.exponent, in.solver_a, in.solver_b);
    start_from(in.record, from.feature, point);
    if (out.tangent_axis != in.record.tangent_axis) {
      change_tangents(tangents_across(in.manifold.normal, in.record.tangent_axis), tangents, point);
    }
  }
  make_common_row(a, b, out);
  return saturations;
}

}  // namespace lockstone
