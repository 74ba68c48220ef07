// Impacts of balls with restitution that the solver keeps, because of joints or of other contacts.
// They follow one after the other within the substep, so that a push passes along a row of balls.
// The normal of a ball's impact does not depend on how the ball turns.

#include "core/dynamics/impact/impact_response.h"
#include "core/dynamics/step/contact_solver.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

using lanes::k_block_lanes;
using lanes::RowBody;

// A push passes so far in a substep.
constexpr int k_sweeps = 32;

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

// Contacts of balls, in the order of the records, of islands in which anything comes in fast.
void ContactSolver::find_impacts(const ContactScene& scene) {
  impacts_.clear();
  if (!bounces_) return;
  scene_ = scene;
  const auto approach = [this](std::size_t i) {
    const std::size_t slot = slot_of(i);
    return std::int64_t{approaches_[slot / k_block_lanes].fastest(slot % k_block_lanes)} *
           (std::int64_t{1} << (50 - SolverVelocity::frac_bits));
  };
  for (std::size_t i = 0; i < entries_.size(); ++i)
    if (approach(i) > k_least_impact) island_of(i).is_struck = true;
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const ContactRecord& record = scene.records[entries_[i].record];
    const BodyRecord &a = scene.bodies[record.body_a], &b = scene.bodies[record.body_b];
    const bool are_balls = (a.is_ball() || !a.is_dynamic()) && (b.is_ball() || !b.is_dynamic());
    if (are_balls && scene.surfaces[entries_[i].slot].restitution > Coefficient{} &&
        scene.manifolds[entries_[i].slot].count == 1 && island_of(i).is_struck)
      impacts_.push_back(static_cast<std::uint32_t>(i));
  }
}

// Whether they come together fast, within a substep.
bool ContactSolver::meets(const Entry& entry) const {
  const Manifold& manifold = scene_.manifolds[entry.slot];
  const std::size_t a = row_of(entry.body_a), b = row_of(entry.body_b);
  const std::int64_t speed = along(rows_[a].velocity, rows_[b].velocity, manifold.normal);
  if (speed > -k_least_impact) return false;
  const std::int64_t parted =
      along(travel_[a].velocity, travel_[b].velocity, manifold.normal);  // m/s of substeps, Q32
  const std::int64_t separation = std::int64_t{manifold.points[0].separation.raw}
                                  << (32 - Displacement::frac_bits);
  const std::int64_t closing = step_.substep.times(parted + (speed >> k_row_bits_more));
  return separation + closing < 0;
}

void ContactSolver::push_by_impact(std::uint32_t index, const BodyRecord& before,
                                   const BodyRecord& after) {
  if ((index & k_immovable) != 0 || !bodies_[index].is_pushed()) return;
  const auto add = [](std::int64_t& row, Velocity by) {
    const std::int64_t change = std::clamp(by.raw, -k_most_change, k_most_change);
    row = std::clamp(row, -k_most_row, k_most_row) + (change << k_row_bits_more);
  };
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    for (RowBody* row : {&rows_[index], &before_[index]}) {
      add(row->velocity[axis], after.velocity[i] - before.velocity[i]);
      add(row->spin[axis], after.spin[i] - before.spin[i]);
    }
  }
  hold(index);
}

void ContactSolver::answer(std::uint32_t index) {
  const Entry& entry = entries_[index];
  const ContactRecord& record = scene_.records[entry.record];
  const ContactSurface& surface = scene_.surfaces[entry.slot];
  const auto body_of = [&](std::uint32_t number, std::uint32_t body) {
    BodyRecord copy = scene_.bodies[body];
    if ((number & k_immovable) != 0 || !bodies_[number].is_pushed()) return copy;
    for (int i = 0; i < 3; ++i) {
      const auto axis = static_cast<std::size_t>(i);
      copy.velocity[i].raw = rows_[number].velocity[axis] >> k_row_bits_more;
      copy.spin[i].raw = rows_[number].spin[axis] >> k_row_bits_more;
    }
    return copy;
  };
  const BodyRecord a = body_of(entry.body_a, record.body_a);
  const BodyRecord b = body_of(entry.body_b, record.body_b);
  BodyRecord after_a = a, after_b = b;
  const auto inertia_of = [&](const BodyRecord& body, std::uint32_t index_of_body) {
    return inverse_inertia(body, scene_.rotations[index_of_body]);
  };
  const InverseInertia inertia_a = inertia_of(a, record.body_a);
  const InverseInertia inertia_b = inertia_of(b, record.body_b);
  answer_impact({after_a, inertia_a}, {after_b, inertia_b},
                {scene_.manifolds[entry.slot], surface.friction, surface.restitution, Velocity{}});
  push_by_impact(entry.body_a, a, after_a);
  push_by_impact(entry.body_b, b, after_b);
  const std::size_t slot = slot_of(index);
  restitution_[slot / k_block_lanes][slot % k_block_lanes] = 0;  // it has bounced in this tick
}

void ContactSolver::run_impacts() {
  bool any = true;
  for (int i = 0; i < k_sweeps && any; ++i) {
    any = false;
    for (const std::uint32_t index : impacts_) {
      if (!meets(entries_[index])) continue;
      answer(index);
      any = true;
    }
  }
}

}  // namespace lockstone
