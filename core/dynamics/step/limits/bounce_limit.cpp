#include "core/dynamics/step/limits/bounce_limit.h"

#include <lockstone/assert.h>

#include "core/base/reserved.h"
#include "core/dynamics/body/energy.h"
#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/body/motion.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

InverseInertia inertia_now(const BodyRecord& body) {
  return inverse_inertia(body, to_matrix(body.orientation));
}

// Twice the kinetic energy for each mass, where the body is.
std::int64_t energy_now(const BodyRecord& body) {
  return twice_energy(body.velocity, body.spin, inertia_now(body));
}

}  // namespace

BounceLimit::BounceLimit(const TimeStep& step, std::size_t body_capacity,
                         std::size_t number_capacity, SolverBodies& bodies,
                         const IslandBuilder& islands)
    : step_(step), bodies_(bodies), islands_(islands) {
  gained_.reserve(number_capacity);
  gains_.reserve(body_capacity + 1);
}

void BounceLimit::reserve() {
  LKS_ASSERT(is_reserved(gained_, bodies_.count()));
  if (gained_.size() < bodies_.count()) gained_.resize(bodies_.count());
}

void BounceLimit::keep_speeds(std::size_t first, std::size_t end) {
  LKS_ASSERT(end <= gained_.size());
  for (std::size_t i = first; i < end; ++i) {
    bodies_.before()[i] = bodies_.rows()[i];
    gained_[i] = 0;
  }
}

void BounceLimit::note_gain(std::uint32_t number, const BodyRecord& body, const BodyRecord& start) {
  const SolverBody& constants = bodies_.constants()[number];
  ProductSum work;  // twice of each mass, by half a substep's rate
  for (int i = 0; i < 3; ++i)
    work.add(constants.gain[static_cast<std::size_t>(i)],
             (body.position[i].raw - start.position[i].raw) * step_.substep_rate());
  // The inertia among the constants turns with bodies that have joints.
  gained_[number] = energy_now(body) - energy_now(start) - work.rounded(31);
}

BounceLimit::Bounce BounceLimit::bounce_of(std::uint32_t number, const BodyRecord& body) const {
  LKS_ASSERT(number > 0 && number < bodies_.count());
  const lanes::BodyVelocity& before = bodies_.before()[number];
  const Vec3<Velocity> velocity = velocity_of_row(before.velocity),
                       spin = velocity_of_row(before.spin);
  return {velocity, spin, body.velocity - velocity, body.spin - spin};
}

// Masses count as parts of that of the island's first body.
void BounceLimit::add(std::uint32_t number, const IslandGain& gain, std::int64_t each,
                      std::int64_t& sum) const {
  add_energy(sum, each, quotient(gain.unit, bodies_.constants()[number].inverse_mass));
}

template <class Visit>
void BounceLimit::for_gaining(const Visit& visit) {
  for (std::uint32_t i = 1; i < bodies_.count(); ++i) {
    const std::uint32_t island = islands_.all().of(i);
    if (island != 0 && gains_[island].gained > 0) visit(i, gains_[island]);
  }
}

void BounceLimit::sum_gains() {
  gains_.assign(islands_.count(), {});
  for (std::uint32_t i = 1; i < bodies_.count(); ++i) {
    const std::uint32_t island = islands_.all().of(i);
    LKS_ASSERT(island < gains_.size());
    const IslandTally& tally = islands_.tally(island);
    const SolverBody& constants = bodies_.constants()[i];
    if (!tally.may_bounce || tally.is_fed || !constants.is_pushed()) continue;
    IslandGain& gain = gains_[island];
    if (gain.unit == BlockFloat{}) gain.unit = constants.inverse_mass;
    add(i, gain, gained_[i], gain.gained);
  }
}

// The greatest share s of its bounces with which an island gains nothing; their own gain of energy
// is s²·square + s·linear.
void BounceLimit::sum_bounces(std::span<const BodyRecord> bodies) {
  for_gaining([&](std::uint32_t i, IslandGain& gain) {
    const BodyRecord& body = bodies[bodies_.side(i).body()];
    const Bounce bounce = bounce_of(i, body);
    const Vec3<Velocity> gained = surface_velocity(inertia_now(body), bounce.spin_gain);
    add(i, gain,
        energy_product(bounce.velocity_gain, bounce.velocity_gain, bounce.spin_gain, gained),
        gain.square);
    add(i, gain, 2 * energy_product(bounce.velocity, bounce.velocity_gain, bounce.spin, gained),
        gain.linear);
  });
  for (IslandGain& gain : gains_) {
    if (gain.gained <= 0) continue;
    const std::int64_t allowed =
        raw::saturating_add(raw::saturating_add(gain.square, gain.linear), -gain.gained);
    gain.share = greatest_share(gain.square, gain.linear, allowed);
    LKS_ASSERT(gain.share >= 0 && gain.share <= 1 << k_share_bits);
  }
}

void BounceLimit::scale(std::span<BodyRecord> bodies, Velocity speed_limit) {
  for_gaining([&](std::uint32_t i, const IslandGain& gain) {
    BodyRecord& body = bodies[bodies_.side(i).body()];
    LKS_ASSERT(gain.share >= 0 && gain.share <= 1 << Unit::frac_bits);
    const Bounce bounce = bounce_of(i, body);
    for (int axis = 0; axis < 3; ++axis) {
      const auto part = [&](Velocity v) { return times(v, Unit::from_raw(gain.share)); };
      body.velocity[axis] = bounce.velocity[axis] + part(bounce.velocity_gain[axis]);
      body.spin[axis] = bounce.spin[axis] + part(bounce.spin_gain[axis]);
    }
    apply_axis_locks(body);
    (void)limit_speed(body, inertia_now(body), speed_limit);
  });
}

void BounceLimit::limit(std::span<BodyRecord> bodies, Velocity speed_limit) {
  sum_gains();
  sum_bounces(bodies);
  scale(bodies, speed_limit);
}

}  // namespace lockstone
