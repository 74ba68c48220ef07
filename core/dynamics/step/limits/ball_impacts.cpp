#include "core/dynamics/step/limits/ball_impacts.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/impact/impact_response.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

using lanes::BodyVelocity;

// A push passes so many contacts in a substep.
constexpr int k_passes = 32;

// Slower ones do not bounce, m/s, Q50: gravity gives no more in a tick at any usual rate.
constexpr std::int64_t k_least_impact = std::int64_t{1} << 48;

constexpr int k_row_bits_more = lanes::k_velocity_bits - lanes::k_grid_bits;

// The bounds of rows, Q50, and of their changes, Q32: 2048 m/s.
constexpr std::int64_t k_most_row = std::int64_t{1} << 61;
constexpr std::int64_t k_most_change = k_most_row >> k_row_bits_more;

// Along a unit vector, in the format of the parts.
std::int64_t along(const std::array<std::int64_t, 3>& a, const std::array<std::int64_t, 3>& b,
                   const Vec3<Unit>& n) {
  ProductSum sum;
  for (int i = 0; i < 3; ++i) {
    sum.add(b[static_cast<std::size_t>(i)], n[i].raw);
    sum.subtract(a[static_cast<std::size_t>(i)], n[i].raw);
  }
  return sum.rounded(Unit::frac_bits);
}

}  // namespace

BallImpacts::BallImpacts(const TimeStep& step, std::size_t contact_capacity, const Parts& parts)
    : step_(step), parts_(parts) {
  impacts_.reserve(contact_capacity);
}

void BallImpacts::find(const ContactScene& scene) {
  impacts_.clear();
  if (!parts_.constraints.has_restitution()) return;
  scene_ = scene;
  const ConstraintLayout& layout = parts_.constraints.layout();
  const auto approach = [&](ContactId id) {
    return std::int64_t{parts_.constraints.approach_of(layout.lane_of(id))} *
           (std::int64_t{1} << (50 - SolverVelocity::frac_bits));
  };
  parts_.contacts.for_each([&](ContactId id, const ContactRef& contact) {
    if (approach(id) > k_least_impact) parts_.islands.tally(contact).is_struck = true;
  });
  parts_.contacts.for_each([&](ContactId id, const ContactRef& contact) {
    const ContactRecord& record = scene.records[contact.record];
    LKS_ASSERT(record.body_a < scene.bodies.size() && record.body_b < scene.bodies.size());
    const BodyRecord &a = scene.bodies[record.body_a], &b = scene.bodies[record.body_b];
    const bool are_balls = (a.is_ball() || !a.is_dynamic()) && (b.is_ball() || !b.is_dynamic());
    if (are_balls && scene.surfaces[contact.manifold].restitution > Coefficient{} &&
        scene.manifolds[contact.manifold].count == 1 && parts_.islands.tally(contact).is_struck) {
      impacts_.push_back(id);
      parts_.islands.tally(contact).has_ball_impacts = true;
    }
  });
}

// Whether they come together fast, within a substep.
bool BallImpacts::meets(const ContactRef& contact) const {
  const Manifold& manifold = scene_.manifolds[contact.manifold];
  LKS_ASSERT(manifold.count == 1);
  const std::span<const lanes::DeltaPose> travel = parts_.bodies.travel();
  const std::size_t a = parts_.bodies.row_of(contact.a), b = parts_.bodies.row_of(contact.b);
  const std::int64_t speed =
      along(velocities_[a].velocity, velocities_[b].velocity, manifold.normal);
  if (speed > -k_least_impact) return false;
  const std::int64_t parted =
      along(travel[a].velocity, travel[b].velocity, manifold.normal);  // m/s of substeps, Q32
  const std::int64_t separation = std::int64_t{manifold.points[0].separation.raw}
                                  << (32 - Displacement::frac_bits);
  const std::int64_t closing = step_.substep.times(parted + (speed >> k_row_bits_more));
  return separation + closing < 0;
}

// Adds the change of a body's motion to its rows.
void BallImpacts::push(BodyRef body, const BodyRecord& before, const BodyRecord& after) {
  const std::uint32_t number = parts_.bodies.pushed_number(body);
  if (number == 0) return;
  LKS_ASSERT(number < parts_.bodies.count());
  const auto add = [](std::int64_t& row, Velocity by) {
    const std::int64_t change = std::clamp(by.raw, -k_most_change, k_most_change);
    row = std::clamp(row, -k_most_row, k_most_row) + (change << k_row_bits_more);
  };
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    for (BodyVelocity* row : {&parts_.bodies.rows()[number], &parts_.bodies.before()[number]}) {
      add(row->velocity[axis], after.velocity[i] - before.velocity[i]);
      add(row->spin[axis], after.spin[i] - before.spin[i]);
    }
  }
  parts_.bodies.apply_axis_locks(number);
}

// A body's record with the motion that it has now.
BodyRecord BallImpacts::body_now(BodyRef ref, std::uint32_t body) const {
  LKS_ASSERT(body < scene_.bodies.size());
  BodyRecord copy = scene_.bodies[body];
  const std::uint32_t number = parts_.bodies.pushed_number(ref);
  if (number == 0) return copy;
  const BodyVelocity& row = velocities_[number];
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    copy.velocity[i].raw = row.velocity[axis] >> k_row_bits_more;
    copy.spin[i].raw = row.spin[axis] >> k_row_bits_more;
  }
  return copy;
}

void BallImpacts::respond(ContactId id) {
  const ContactRef& contact = parts_.contacts[id];
  const ContactRecord& record = scene_.records[contact.record];
  const ContactSurface& surface = scene_.surfaces[contact.manifold];
  LKS_ASSERT(scene_.manifolds[contact.manifold].count == 1);
  const BodyRecord a = body_now(contact.a, record.body_a);
  const BodyRecord b = body_now(contact.b, record.body_b);
  BodyRecord after_a = a, after_b = b;
  const InverseInertia inertia_a = inverse_inertia(a, scene_.rotations[record.body_a]);
  const InverseInertia inertia_b = inverse_inertia(b, scene_.rotations[record.body_b]);
  answer_impact(
      {after_a, inertia_a}, {after_b, inertia_b},
      {scene_.manifolds[contact.manifold], surface.friction, surface.restitution, Velocity{}});
  push(contact.a, a, after_a);
  push(contact.b, b, after_b);
  if (!parts_.totals.empty())
    parts_.totals.add_impact(id, (after_b.velocity - b.velocity) - (after_a.velocity - a.velocity),
                             scene_.manifolds[contact.manifold].normal);
  parts_.constraints.forget_restitution(parts_.constraints.layout().lane_of(id));
}

void BallImpacts::run(std::span<const BodyVelocity> velocities) {
  velocities_ = velocities;
  bool any = true;
  for (int i = 0; i < k_passes && any; ++i) {
    any = false;
    for (const ContactId id : impacts_) {
      if (!meets(parts_.contacts[id])) continue;
      respond(id);
      any = true;
    }
  }
}

}  // namespace lockstone
