// The bodies of joints: how heavy they are to turn, and where they go.

#include <algorithm>
#include <bit>

#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/body/mass_share.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/joint_solver.h"
#include "core/math/product_sum.h"
#include "core/math/roots.h"
#include "core/math/trig.h"

namespace lockstone {
namespace {

// Links are taken to be at most so heavy to turn, m·s².
constexpr std::int64_t k_most_inertia = k_one << 8;

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

}  // namespace

// `jump`: change of the body's velocity by joints at the lever (m, Q20), m/s, Q30.
void JointSolver::add_pull(std::uint32_t body, std::int64_t jump, std::int64_t lever) {
  std::int64_t& sum = pulls_[body];
  sum = bounded(sum + product_rounded(jump, lever, 20 + 2 * bodies_[body].scale), k_row_bound);
}

// Adds half of a substep's impulses: the other half is that of `relaxed`, or goes before it.
void JointSolver::add_pulls(std::span<const Joint> joints, bool free) {
  for (const Joint& joint : joints) {
    const auto total = [&](std::size_t i) {
      return free ? (joint.locks[i] + joint.carried[i]) / 2 : joint.locks[i] + joint.relaxed[i];
    };
    const auto pull =
        static_cast<std::int64_t>(norm(total(0) >> 20, total(1) >> 20, total(2) >> 20));  // Q30
    const auto add = [&](std::uint32_t body, const Share& share, std::int64_t lever) {
      if (share.mantissa == 0) return;
      add_pull(body, product_rounded(pull, share.mantissa, share.shift), lever);
    };
    add(joint.a, joint.share_a, joint.lever_a);
    add(joint.b, joint.share_b, joint.lever_b);
  }
}

// As the last tick ended.
void JointSolver::add_pulls(const Link& link) {
  const Body &a = bodies_[link.a], &b = bodies_[link.b];
  const std::int32_t share_b =
      share_of_b(a.record->inverse_mass_value(), b.record->inverse_mass_value());
  const auto part = [&](std::size_t i) {
    return std::int64_t{link.record->axes[i].impulse.raw} * (1 << 10);
  };
  const auto pull = static_cast<std::int64_t>(norm(part(0), part(1), part(2)));  // Q30
  if (a.pushed)
    add_pull(link.a, product_rounded(pull, k_one - share_b, 30), size_of(link.record->anchor_a));
  if (b.pushed)
    add_pull(link.b, product_rounded(pull, share_b, 30), size_of(link.record->anchor_b));
}

// The inertia, besides its own, that a body has when its joints swing against each other: m·d²,
// with d from the centre of mass to the middle of its two anchors, or to its one anchor; with one
// anchor in the measure in which the other body stands still.
std::int64_t JointSolver::lever_inertia(std::uint32_t index) const {
  const Body& body = bodies_[index];
  if (!body.pushed || body.joint_count < 1 || body.joint_count > 2) return 0;
  std::array<std::int64_t, 3> sum{};
  for (const std::uint32_t i : joints_at(body)) {
    const Link& link = links_[i];
    if (!has_world_axes(*link.record)) return 0;
    const Vec3<Length>& anchor = link.a == index ? link.record->anchor_a : link.record->anchor_b;
    for (int axis = 0; axis < 3; ++axis)
      sum[static_cast<std::size_t>(axis)] += anchor[axis].raw;
  }
  const auto square = [](std::int64_t x) {  // of at most 1024 m
    const std::int64_t within = bounded(x, std::int64_t{1} << 30);
    return within * within;
  };
  const std::int64_t whole = square(sum[0]) + square(sum[1]) + square(sum[2]);  // m², Q40
  const int shift = Length::frac_bits * 2 - 30 + 2 * body.record->scale_exponent;
  const auto scaled = [&](std::int64_t x, int by) {
    return by >= 0 ? raw::round_shift(x, by) : std::min(x, k_product_bound >> -by) << -by;
  };
  if (body.joint_count == 2) return scaled(whole, shift + 2);
  const Link& link = links_[joints_at(body)[0]];
  const bool is_a = link.a == index;
  const Body& other = bodies_[is_a ? link.b : link.a];
  if (!other.pushed) return scaled(whole, shift);
  if ((is_a ? link.record->anchor_b : link.record->anchor_a) != Vec3<Length>{}) return 0;
  const std::int32_t own =
      share_of_b(other.record->inverse_mass_value(), body.record->inverse_mass_value());
  return product_rounded(scaled(whole, shift), own, 30);
}

std::int64_t JointSolver::swung_inertia(const Body& body) {
  const auto& own = body.record->inertia;
  return min(own.x, min(own.y, own.z)).raw + body.lever_inertia;
}

// A link that is pulled at both ends by T swings at ω² = ΣT·r / I, which the step does not resolve
// where h·ω is large: there links are taken to be heavier to turn. A diagonal form of the geometric
// stiffness: S. Andrews, M. Teichmann, J. Kövecses, "Geometric Stiffness for Real-time Constrained
// Multibody Dynamics", 2017.
void JointSolver::resist_pull(const JointRun& run, std::uint32_t index) {
  Body& body = bodies_[index];
  if (!body.pushed || !body.record->rotates()) return;
  // Some of it grows with the number of links that swing against each other.
  const std::int64_t least = 2 * raw::round_divide(pulls_[index], step_.substep_rate());
  const std::uint64_t rounded = std::bit_ceil(static_cast<std::uint64_t>(least));
  const std::int64_t swung = swung_inertia(body);
  body.pulled = least > swung / 8;
  set_inertia(run, body,
              least <= swung
                  ? 0
                  : std::min<std::int64_t>(static_cast<std::int64_t>(rounded), k_most_inertia));
}

// A body that turns about all axes, with unequal moments, has a tensor that turns with it.
void JointSolver::set_principal(Body& body) {
  const BodyRecord& record = *body.record;
  const Vec3<Unit> moments = moments_of(record, body.least_inertia);
  body.has_principal = record.is_dynamic() && record.rotates() &&
                       (record.locks & k_lock_turning) == 0 &&
                       !(moments.x == moments.y && moments.y == moments.z);
  if (body.has_principal) body.principal = principal_inverse(moments);
}

InverseInertia JointSolver::inverse_inertia_of(const Body& body, const Mat3& rotation) {
  const std::int64_t least = body.least_inertia;
  if (least == 0 && !body.has_principal) return inverse_inertia(*body.record, rotation);
  InverseInertia m = body.has_principal
                         ? inverse_inertia(body.principal, rotation)
                         : inverse_inertia(with_inertia(*body.record, least), rotation);
  if (least <= k_one) return m;
  const int shift = std::countr_zero(static_cast<std::uint64_t>(least)) - 30;  // a power of two
  for (std::int32_t* entry : {&m.xx, &m.yy, &m.zz, &m.xy, &m.xz, &m.yz})
    *entry = static_cast<std::int32_t>(raw::round_shift(*entry, shift));
  return m;
}

// Keeps the angular velocity.
void JointSolver::set_inertia(const JointRun& run, Body& body, std::int64_t least) {
  if (least == body.least_inertia) return;
  lanes::RowBody& row = run.rows[body.solver];
  const lanes::RowBody old = row;
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
}

void JointSolver::end(const JointRun& run) {
  for (Body& body : bodies_) {
    if (body.pushed) set_inertia(run, body, 0);
  }
}

// Where the body will be after the substep, with the velocity that it has now. Without contacts
// gravity acts half before and half after, unless the drift itself lies half before and half after.
// It turns by its inertia half a substep on, as it was first seen there in this substep.
JointPose JointSolver::pose_after(const JointRun& run, Body& body) const {
  if (!body.has_looked) body.inertia_ahead = body.inverse_inertia;
  JointPose after = body.pose;
  if (body.solver == 0) return after;
  const lanes::RowBody& row = run.rows[body.solver];
  const SolverBody& solver = run.bodies[body.solver];
  const auto read = [](std::int64_t x) { return bounded(x, std::int64_t{1000} << 50); };
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    std::int64_t velocity = read(row.velocity[axis]);
    if (body.centred && !body.free) velocity -= solver.gain[axis] * (1 << 17);
    after.position[i].raw += raw::round_shift(body.rate.quotient(velocity), 18);
  }
  if (row.spin == std::array<std::int64_t, 3>{} || !body.record->rotates()) return after;
  const std::array<std::int64_t, 3> spin = {read(row.spin[0]), read(row.spin[1]),
                                            read(row.spin[2])};
  const int scale = body.record->scale_exponent;
  const auto turned = [&](const InverseInertia& inertia, const RoundDivisor& rate) {
    const std::array<std::int64_t, 3> w = surface_velocity(inertia, spin);
    const auto angle = [&](std::int64_t x) {
      return RotationComponent::from_raw(raw::scale_binary(rate.quotient(x), -scale));
    };
    return integrate(body.pose.orientation, {angle(w[0]), angle(w[1]), angle(w[2])});
  };
  if (body.pushed && !body.record->has_spherical_inertia()) {
    if (!body.has_looked) {
      const Quat half = turned(body.inverse_inertia, body.rate.doubled());
      body.inertia_ahead = inverse_inertia_of(body, to_matrix(half));
    }
    after.orientation = turned(body.inertia_ahead, body.rate);
  } else {
    after.orientation = turned(body.inverse_inertia, body.rate);
  }
  after.rotation = to_matrix(after.orientation);
  return after;
}

void JointSolver::place(const JointRun& run, std::size_t first, std::size_t end) const {
  for (std::size_t i = first; i < end; ++i) {
    const Body& body = bodies_[i];
    if (body.solver == 0 || !body.in_net) continue;
    run.places[body.solver] = body_place(body.pose.position, body.pose.rotation);
  }
}

void JointSolver::move(const JointRun& run, std::size_t first, std::size_t end) {
  for (std::size_t i = first; i < end; ++i) {
    if (bodies_[i].solver == 0) continue;
    move(run, static_cast<std::uint32_t>(i));
    if (!bodies_[i].pushed) after_[i] = pose_after(run, bodies_[i]);
  }
}

// To where it was last seen, if nothing has pushed it since.
void JointSolver::move(const JointRun& run, std::uint32_t index) {
  Body& body = bodies_[index];
  const lanes::RowBody& row = run.rows[body.solver];
  const bool is_known = body.has_looked && is_alike(row, body.looked);
  body.pose = is_known ? after_[index] : pose_after(run, body);
  body.has_looked = false;
  if (body.in_net) {
    run.places[body.solver] = body_place(body.pose.position, body.pose.rotation);
  }
  if (!body.record->is_dynamic() || body.record->has_spherical_inertia()) return;
  body.inverse_inertia = inverse_inertia_of(body, body.pose.rotation);
  run.bodies[body.solver].inverse_inertia = body.inverse_inertia;
  run.inertias[body.solver] = source_body(body.inverse_inertia);
}

}  // namespace lockstone
