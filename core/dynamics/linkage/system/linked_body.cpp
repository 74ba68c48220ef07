#include "core/dynamics/linkage/system/linked_body.h"

#include <algorithm>
#include <array>
#include <bit>

#include <lockstone/assert.h>

#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/joint/joint_numbers.h"
#include "core/math/product_sum.h"
#include "core/math/trig.h"

namespace lockstone {
namespace {

// The moments of a body, none of them below `least`.
Vec3<Unit> moments_of(const BodyRecord& record, std::int64_t least) {
  const Unit bound = Unit::from_raw(static_cast<std::int32_t>(std::min(least, k_one)));
  const auto& [x, y, z] = record.inertia;
  return {max(x, bound), max(y, bound), max(z, bound)};
}

BodyRecord with_inertia(const BodyRecord& record, std::int64_t least) {
  BodyRecord heavier = record;
  heavier.inertia = moments_of(record, least);
  return heavier;
}

[[maybe_unused]] bool is_power_of_two_or_zero(std::int64_t x) {
  return x == 0 || (x > 0 && std::has_single_bit(static_cast<std::uint64_t>(x)));
}

// A body that turns about all axes, with unequal moments, has a tensor that turns with it.
void set_principal(LinkedBody& body) {
  const BodyRecord& record = *body.record;
  const Vec3<Unit> moments = moments_of(record, body.least_inertia);
  body.has_principal = record.is_dynamic() && record.rotates() &&
                       (record.locks & k_lock_turning) == 0 &&
                       !(moments.x == moments.y && moments.y == moments.z);
  if (body.has_principal) body.principal = principal_inverse(moments);
}

InverseInertia inverse_inertia_of(const LinkedBody& body, const Mat3& rotation) {
  const std::int64_t least = body.least_inertia;
  LKS_ASSERT(is_power_of_two_or_zero(least));
  if (least == 0 && !body.has_principal) return inverse_inertia(*body.record, rotation);
  InverseInertia m = body.has_principal
                         ? inverse_inertia(body.principal, rotation)
                         : inverse_inertia(with_inertia(*body.record, least), rotation);
  if (least <= k_one) return m;
  const int shift = std::countr_zero(static_cast<std::uint64_t>(least)) - 30;
  for (std::int32_t* entry : {&m.xx, &m.yy, &m.zz, &m.xy, &m.xz, &m.yz})
    *entry = static_cast<std::int32_t>(raw::round_shift(*entry, shift));
  return m;
}

// Velocities that move poses are at most 1000 m/s, Q50.
std::int64_t moving_speed(std::int64_t x) {
  return bounded(x, std::int64_t{1000} << 50);
}

using Spin = std::array<std::int64_t, 3>;

Spin moving_spin(const lanes::BodyVelocity& row) {
  return {moving_speed(row.spin[0]), moving_speed(row.spin[1]), moving_speed(row.spin[2])};
}

bool turns(const LinkedBody& body, const lanes::BodyVelocity& row) {
  return (row.spin[0] | row.spin[1] | row.spin[2]) != 0 && body.rotates;
}

// How far it moves along an axis.
Position step_of(const LinkedBody& body, std::int64_t velocity) {
  return Position::from_raw(raw::round_shift(body.rate.quotient(velocity), 18));
}

Quat orientation_after(const LinkedBody& body, const Spin& spin, const InverseInertia& inertia,
                       const RoundDivisor& rate) {
  const std::array<std::int64_t, 3> w = surface_velocity(inertia, spin);
  const auto angle = [&](std::int64_t x) {
    return RotationComponent::from_raw(raw::scale_binary(rate.quotient(x), -body.scale));
  };
  return integrate(body.pose.orientation, {angle(w[0]), angle(w[1]), angle(w[2])});
}

InverseInertia half_on(const LinkedBody& body, const Spin& spin) {
  const Quat half = orientation_after(body, spin, body.inverse_inertia, body.rate.doubled());
  return inverse_inertia_of(body, to_matrix(half));
}

// After it moved: its inertia as the solver and kernels read it.
void place_inertia(const JointRun& run, LinkedBody& body) {
  body.inverse_inertia = inverse_inertia_of(body, body.pose.rotation);
  run.bodies[body.solver].inverse_inertia = body.inverse_inertia;
  run.inertias[body.solver] = body_inertia(body.inverse_inertia);
}

// As `move_body`, of a body that only coloured balls hold: nobody has looked where it will be.
void move_by_balls(const JointRun& run, LinkedBody& body) {
  LKS_ASSERT(body.pushed && body.in_balls && !body.has_looked && !body.centred);
  const lanes::BodyVelocity& row = run.rows[body.solver];
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    body.pose.position[i] += step_of(body, moving_speed(row.velocity[axis]));
  }
  if (turns(body, row)) {
    const Spin spin = moving_spin(row);
    body.pose.orientation = orientation_after(
        body, spin, body.is_spherical ? body.inverse_inertia : half_on(body, spin), body.rate);
    body.pose.rotation = to_matrix(body.pose.orientation);
  }
  run.places[body.solver] = body_place(body.pose.position, body.pose.rotation);
  if (!body.is_spherical) place_inertia(run, body);
}

}  // namespace

void set_body(const BodyRecord& record, const Mat3& rotation, std::uint32_t solver,
              LinkedBody& body) {
  body.record = &record;
  body.pose = {record.position, record.orientation, rotation};
  set_principal(body);
  body.solver = solver;
  body.scale = record.scale_exponent;
  body.rotates = record.rotates();
  body.is_spherical = record.has_spherical_inertia();
  body.pushed = solver != 0 && record.is_dynamic();
  if (!body.pushed) body.inverse_inertia = inverse_inertia_of(body, rotation);
  LKS_ASSERT(!body.pushed || record.inverse_mass > 0);
}

void set_least_inertia(const JointRun& run, LinkedBody& body, std::int64_t least) {
  LKS_ASSERT(is_power_of_two_or_zero(least));
  if (least == body.least_inertia) return;
  LKS_ASSERT(body.pushed && body.solver < run.rows.size());
  lanes::BodyVelocity& row = run.rows[body.solver];
  const lanes::BodyVelocity old = row;
  const auto velocity = [](std::int64_t x) { return Velocity::from_raw(raw::round_shift(x, 18)); };
  const Vec3<Velocity> w = surface_velocity(
      body.inverse_inertia, {velocity(row.spin[0]), velocity(row.spin[1]), velocity(row.spin[2])});
  body.least_inertia = least;
  set_principal(body);
  Vec3<Velocity> spin = spin_of(with_inertia(*body.record, least), body.pose.rotation, w);
  if (least > k_one) {
    for (int i = 0; i < 3; ++i)
      spin[i].raw = product_rounded(w[i].raw, least, 30);
  }
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    row.spin[axis] = bounded(spin[i].raw, k_row_bound >> 18) * (1 << 18);
    if (run.before.empty()) continue;
    std::int64_t& before = run.before[body.solver].spin[axis];
    const std::int64_t gain = row.spin[axis] - bounded(old.spin[axis], k_row_bound);
    before = bounded(bounded(before, k_row_bound) + gain, k_row_bound);
  }
  body.inverse_inertia = inverse_inertia_of(body, body.pose.rotation);
  run.bodies[body.solver].inverse_inertia = body.inverse_inertia;
  run.bodies[body.solver].is_heavier = least != 0;
}

// Without contacts gravity acts half before and half after, unless the move itself lies half
// before and half after. The body turns by its inertia half a substep on, as it was first seen
// there in this substep.
JointPose pose_after(const JointRun& run, LinkedBody& body) {
  if (!body.has_looked) body.inertia_ahead = body.inverse_inertia;
  JointPose after = body.pose;
  if (body.solver == 0) return after;
  LKS_ASSERT(body.solver < run.rows.size());
  const lanes::BodyVelocity& row = run.rows[body.solver];
  const SolverBody& solver = run.bodies[body.solver];
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    std::int64_t velocity = moving_speed(row.velocity[axis]);
    if (body.centred && !body.moves_first) velocity -= solver.gain[axis] * (1 << 17);
    after.position[i] += step_of(body, velocity);
  }
  if (!turns(body, row)) return after;
  const Spin spin = moving_spin(row);
  if (body.pushed && !body.is_spherical) {
    if (!body.has_looked) body.inertia_ahead = half_on(body, spin);
    after.orientation = orientation_after(body, spin, body.inertia_ahead, body.rate);
  } else {
    after.orientation = orientation_after(body, spin, body.inverse_inertia, body.rate);
  }
  after.rotation = to_matrix(after.orientation);
  return after;
}

void look_ahead(const JointRun& run, LinkedBody& body) {
  const lanes::BodyVelocity& row = run.rows[body.solver];
  if (body.has_looked && is_alike(row, body.looked)) return;
  body.after = pose_after(run, body);
  body.looked = row;
  body.has_looked = body.solver != 0;
}

void move_body(const JointRun& run, LinkedBody& body) {
  LKS_ASSERT(body.solver != 0);
  if (body.only_balls) return move_by_balls(run, body);
  const lanes::BodyVelocity& row = run.rows[body.solver];
  const bool is_known = body.has_looked && is_alike(row, body.looked);
  body.pose = is_known ? body.after : pose_after(run, body);
  body.has_looked = false;
  if (body.in_balls) {
    run.places[body.solver] = body_place(body.pose.position, body.pose.rotation);
  }
  if (body.record->is_dynamic() && !body.is_spherical) place_inertia(run, body);
}

}  // namespace lockstone
