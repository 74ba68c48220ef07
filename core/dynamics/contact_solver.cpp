#include "core/dynamics/contact_solver.h"

#include <algorithm>

#include "core/math/roots.h"

namespace lockstone {
namespace {

// Overlap is pushed out at most this fast, m/s, Q20.
constexpr std::int64_t k_push_out_speed = std::int64_t{3} << 20;

// Approaches slower than this do not bounce, m/s, Q20.
constexpr std::int32_t k_restitution_threshold = 1 << 20;

// gain (Q30) · impulse (Q20) = Q50, brought to the Q32 of velocities.
void accumulate(Lanes64& velocity, const Lanes32& gain, std::int64_t impulse) {
  for (std::size_t i = 0; i < 3; ++i) {
    velocity[i] += raw::round_shift(gain[i] * impulse, 18);
  }
}

}  // namespace

std::int32_t relative_velocity(const ContactAxis& axis, const ContactRow& row, int exponent,
                               const SolverBody& a, const SolverBody& b) {
  const Lanes32 va = read_velocities(a.velocity);
  const Lanes32 vb = read_velocities(b.velocity);
  const Lanes32 along = {vb[0] - va[0], vb[1] - va[1], vb[2] - va[2]};
  const std::int64_t sum = raw::round_shift(dot(axis.unit, along), exponent) +
                           dot(row.read_b, read_velocities(b.spin)) -
                           dot(row.read_a, read_velocities(a.spin));
  return raw::saturate<std::int32_t>(raw::round_shift(sum, 30 - exponent));
}

void ContactSolver::apply(const ContactConstraint& contact, const ContactAxis& axis,
                          const ContactRow& row, std::int64_t impulse) {
  if (impulse == 0) return;
  if (contact.body_a != 0) {
    SolverBody& a = bodies_[contact.body_a];
    accumulate(a.velocity, axis.gain_a, -impulse);
    accumulate(a.spin, row.gain_a, -impulse);
  }
  if (contact.body_b != 0) {
    SolverBody& b = bodies_[contact.body_b];
    accumulate(b.velocity, axis.gain_b, impulse);
    accumulate(b.spin, row.gain_b, impulse);
  }
}

void ContactSolver::warm_start() {
  for (ContactConstraint& contact : contacts_) {
    for (int i = 0; i < contact.count; ++i) {
      const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
      apply(contact, contact.normal, point.normal, point.normal.impulse);
      apply(contact, contact.tangent[0], point.tangent[0], point.tangent[0].impulse);
      apply(contact, contact.tangent[1], point.tangent[1], point.tangent[1].impulse);
    }
  }
}

void ContactSolver::solve(bool use_bias) {
  for (ContactConstraint& contact : contacts_) {
    for (int i = 0; i < contact.count; ++i) {
      solve_point_friction(contact, contact.points[static_cast<std::size_t>(i)]);
    }
    solve_common_normal(contact, use_bias);
    for (int i = 0; i < contact.count; ++i) {  // last, since it matters most
      solve_point_normal(contact, contact.points[static_cast<std::size_t>(i)], use_bias);
    }
  }
}

// The separation now: the Jacobian of velocities also maps displacements, to first order. m, Q24.
std::int64_t ContactSolver::separation(const ContactConstraint& contact,
                                       const ContactPoint& point) const {
  const SolverBody& a = bodies_[contact.body_a];
  const SolverBody& b = bodies_[contact.body_b];
  const Lanes32 da = read_displacements(a.displacement);
  const Lanes32 db = read_displacements(b.displacement);
  const Lanes32 apart = {db[0] - da[0], db[1] - da[1], db[2] - da[2]};
  const std::int64_t change = dot(contact.normal.unit, apart) +
                              dot(point.lever_b, read_displacements(b.turn)) -
                              dot(point.lever_a, read_displacements(a.turn));
  return point.separation + raw::round_shift(change, 30);
}

ContactSolver::NormalTarget ContactSolver::target(const ContactConstraint& contact,
                                                  const ContactPoint& point, bool use_bias) const {
  const std::int64_t s = separation(contact, point);
  if (s > 0) return {raw::round_shift(s * substep_rate_, 4), false};  // may close the gap, no more
  if (!use_bias) return {0, false};
  const std::int64_t rate = contact.softness.bias_rate;
  return {std::max(raw::round_shift(s * rate, 24), -k_push_out_speed), true};
}

// P ← max(0, P − m̄·(v + bias)·mass scale − P·impulse scale)
void ContactSolver::solve_point_normal(ContactConstraint& contact, ContactPoint& point,
                                       bool use_bias) {
  const NormalTarget goal = target(contact, point, use_bias);
  const std::int64_t mass = goal.soft ? point.soft_mass : point.normal.mass;
  const std::int64_t impulse_scale = goal.soft ? contact.softness.impulse_scale : 0;
  const std::int64_t v = relative_velocity(contact.normal, point.normal, contact.exponent,
                                           bodies_[contact.body_a], bodies_[contact.body_b]);
  const std::int64_t error = std::clamp<std::int64_t>(v + goal.bias, -(1LL << 31), 1LL << 31);
  const std::int64_t old = point.normal.impulse;
  const std::int64_t total = old - raw::round_shift(mass * error + impulse_scale * old, 30);
  apply_normal(contact, point, total);
}

// All points at once, each by the same share: what is symmetric stays symmetric, which points in
// turn cannot promise.
void ContactSolver::solve_common_normal(ContactConstraint& contact, bool use_bias) {
  if (contact.count < 2) return;
  std::int64_t bias = 0, impulse = 0;
  bool soft = true;
  for (int i = 0; i < contact.count; ++i) {
    const ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
    const NormalTarget goal = target(contact, point, use_bias);
    bias += goal.bias;
    impulse += point.normal.impulse;
    soft = soft && goal.soft;
  }
  const std::int64_t v = relative_velocity(contact.normal, contact.common, contact.exponent,
                                           bodies_[contact.body_a], bodies_[contact.body_b]);
  const std::int64_t error =
      std::clamp<std::int64_t>(v + raw::round_divide(bias, contact.count), -(1LL << 31), 1LL << 31);
  const std::int64_t mass = soft ? contact.common_soft_mass : contact.common.mass;
  std::int64_t change = raw::round_shift(mass * error, 30);
  if (soft) change += raw::round_shift(contact.softness.impulse_scale * impulse, 30);
  const std::int64_t share = raw::round_divide(change, contact.count);
  for (int i = 0; i < contact.count; ++i) {
    ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
    apply_normal(contact, point, point.normal.impulse - share);
  }
}

void ContactSolver::apply_normal(ContactConstraint& contact, ContactPoint& point,
                                 std::int64_t total) {
  const std::int64_t old = point.normal.impulse;
  const std::int32_t clamped = raw::saturate<std::int32_t>(std::max<std::int64_t>(total, 0));
  saturations_ += total > clamped ? 1 : 0;
  point.normal.impulse = clamped;
  point.largest_impulse = std::max(point.largest_impulse, clamped);
  apply(contact, contact.normal, point.normal, clamped - old);
}

// Coulomb's cone as a circle: both tangents are solved together, then brought back onto the circle.
void ContactSolver::solve_point_friction(ContactConstraint& contact, ContactPoint& point) {
  const SolverBody& a = bodies_[contact.body_a];
  const SolverBody& b = bodies_[contact.body_b];
  std::int64_t total[2];
  for (int t = 0; t < 2; ++t) {
    const ContactRow& row = point.tangent[t];
    const std::int64_t v = relative_velocity(contact.tangent[t], row, contact.exponent, a, b);
    total[t] = row.impulse - raw::round_shift(row.mass * v, 30);
    total[t] = raw::saturate<std::int32_t>(total[t]);
  }
  const std::int64_t limit = raw::saturate<std::int32_t>(
      raw::round_shift(std::int64_t{contact.friction} * point.normal.impulse, 30));
  const auto squared = static_cast<std::uint64_t>(total[0] * total[0]) +
                       static_cast<std::uint64_t>(total[1] * total[1]);
  if (squared > static_cast<std::uint64_t>(limit * limit)) {
    const std::int64_t length = isqrt(squared);  // ≥ 1, and ≥ limit − 1
    for (std::int64_t& p : total)
      p = raw::round_divide(p * limit, length);
  }
  for (int t = 0; t < 2; ++t) {
    ContactRow& row = point.tangent[t];
    const std::int64_t change = total[t] - row.impulse;
    row.impulse = raw::saturate<std::int32_t>(total[t]);
    apply(contact, contact.tangent[t], row, change);
  }
}

void ContactSolver::apply_restitution() {
  for (ContactConstraint& contact : contacts_) {
    if (contact.restitution == 0) continue;
    for (int i = 0; i < contact.count; ++i) {
      ContactPoint& point = contact.points[static_cast<std::size_t>(i)];
      if (point.approach > -k_restitution_threshold || point.largest_impulse == 0) continue;
      const std::int64_t v = relative_velocity(contact.normal, point.normal, contact.exponent,
                                               bodies_[contact.body_a], bodies_[contact.body_b]);
      const std::int64_t wanted =
          raw::round_shift(std::int64_t{contact.restitution} * point.approach, 30);
      const std::int64_t change =
          raw::round_shift(std::int64_t{point.normal.mass} * (v + wanted), 30);
      apply_normal(contact, point, point.normal.impulse - change);
    }
  }
}

}  // namespace lockstone
