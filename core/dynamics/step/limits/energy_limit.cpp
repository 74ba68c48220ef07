#include "core/dynamics/step/limits/energy_limit.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/body/energy.h"
#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/linkage/joint_solver.h"

namespace lockstone {
namespace {

// In a tick an island may gain this part of its kinetic energy: 2^-8.
constexpr int k_free_gain_shift = 8;

// And so much besides, twice by the heaviest body's mass: (1.25 cm/s)², Q32.
constexpr std::int64_t k_least_gain = (std::int64_t{1} << 32) / 6400;

// Positions may move with velocities of so much more energy than the substep began with: 2^-4 of
// it, and, twice for each mass, (0.5 m/s)², Q32, to close joints and overlap.
constexpr int k_moving_gain_shift = 4;
constexpr std::int64_t k_moving_gain = std::int64_t{1} << 30;

// Velocities of a substep stay within 2048 m/s.
std::int64_t bounded_row(std::int64_t x) {
  constexpr std::int64_t k_bound = std::int64_t{1} << 61;
  return std::clamp(x, -k_bound, k_bound);
}

// Twice the kinetic energy for each mass.
std::int64_t row_energy(const EnergyLimit::Bodies& all, std::uint32_t i) {
  const Vec3<Velocity> velocity = velocity_of_row(all.rows[i].velocity),
                       spin = velocity_of_row(all.rows[i].spin);
  const Vec3<Velocity> surface = surface_velocity(all.bodies[i].inverse_inertia, spin);
  if (!all.bodies[i].is_heavier) return energy_product(velocity, velocity, spin, surface);
  return energy_product(velocity, velocity,
                        all.joints.own_spin(all.numbers.side(i).body(), spin, surface), surface);
}

}  // namespace

void EnergyLimit::reserve(std::size_t body_capacity) {
  islands_.reserve(body_capacity + 1);
  starts_.reserve(body_capacity + 1);
}

void EnergyLimit::begin(const Bodies& all) {
  watches_ = knows_now_ = false;
  count_ = 0;
  if (!all.joints.has_own()) return;
  starts_.resize(all.numbers.count());
  islands_.assign(all.islands.count(), {});
  for (std::uint32_t i = 1; i < all.numbers.count(); ++i) {
    LKS_ASSERT(all.islands.of(i) < islands_.size());
    const IslandTally& tally = all.islands.tally(all.islands.of(i));
    if (all.islands.of(i) == 0 || !tally.has_joints || tally.contacts == 0 || tally.is_fed)
      continue;
    Island& island = islands_[all.islands.of(i)];
    const BlockFloat inverse = all.bodies[i].inverse_mass;
    LKS_ASSERT(inverse.mantissa >= 0);
    if (inverse.mantissa == 0) continue;
    const bool is_heavier = ratio(inverse, island.unit) < Unit::from_raw(1 << 29);
    if (island.unit == BlockFloat{} || is_heavier) island.unit = inverse;
    watches_ = true;
  }
}

template <class Visit>
void EnergyLimit::for_watched(const Bodies& all, const Visit& visit) {
  for (std::uint32_t i = 1; i < all.numbers.count(); ++i) {
    Island& island = islands_[all.islands.of(i)];
    if (island.unit != BlockFloat{} && all.bodies[i].is_pushed())
      visit(i, island, quotient(island.unit, all.bodies[i].inverse_mass));
  }
}

void EnergyLimit::note(const Bodies& all) {
  LKS_ASSERT(watches_);
  for (Island& island : islands_)
    island.first = knows_now_ ? island.now : 0;
  for_watched(all, [&](std::uint32_t i, Island& island, BlockFloat mass) {
    starts_[i] = velocity_of_row(all.rows[i].velocity);
    if (knows_now_) return;
    add_energy(island.first, row_energy(all, i), mass);
  });
}

// As it is now, and its change in the substep besides the work of gravity and forces.
void EnergyLimit::sum(const Bodies& all) {
  for (Island& island : islands_) {
    island.now = 0;
    island.change = -island.first;
    island.moving_gain = island.first >> k_moving_gain_shift;
  }
  for_watched(all, [&](std::uint32_t i, Island& island, BlockFloat mass) {
    ProductSum work;  // twice
    const Vec3<Velocity> end = velocity_of_row(all.rows[i].velocity);
    for (int axis = 0; axis < 3; ++axis)
      work.add(all.bodies[i].gain[static_cast<std::size_t>(axis)],
               starts_[i][axis].raw + end[axis].raw);
    const std::int64_t own = row_energy(all, i);
    const std::int64_t change = raw::saturating_add(own, -work.rounded(32));
    add_energy(island.now, own, mass);
    add_energy(island.change, change, mass);
    add_energy(island.moving_gain, k_moving_gain, mass);
  });
}

// Takes an excess of energy away from all bodies of an island alike.
void EnergyLimit::take(Island& island, std::int64_t excess) {
  island.share = root_of_share(raw::saturating_add(island.now, -excess), island.now);
  LKS_ASSERT(island.share >= 0 && island.share <= 1 << k_share_bits);
  ++count_;
}

void EnergyLimit::scale(const Bodies& all) {
  for_watched(all, [&](std::uint32_t i, const Island& island, BlockFloat) {
    LKS_ASSERT(island.share >= 0 && island.share <= 1 << k_share_bits);
    if (island.share == 1 << k_share_bits) return;
    const auto shrink = [&](std::int64_t& now, std::int64_t& before) {
      const std::int64_t change =
          product_rounded(bounded_row(now), island.share, k_share_bits) - bounded_row(now);
      now = bounded_row(now) + change;
      before = bounded_row(before) + change;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      shrink(all.rows[i].velocity[axis], all.before[i].velocity[axis]);
      shrink(all.rows[i].spin[axis], all.before[i].spin[axis]);
    }
  });
}

void EnergyLimit::limit_moves(const Bodies& all) {
  sum(all);
  for (Island& island : islands_) {
    island.share = 1 << k_share_bits;
    if (island.change > island.moving_gain) take(island, island.change);
  }
  scale(all);
}

// The next substep begins as this one ends.
void EnergyLimit::limit_gains(const Bodies& all) {
  LKS_ASSERT(watches_);
  const std::uint32_t before = count_;
  sum(all);
  for (Island& island : islands_) {
    island.gained = raw::saturating_add(island.gained, island.change);
    island.share = 1 << k_share_bits;
    if (island.gained <= (island.now >> k_free_gain_shift) + k_least_gain) continue;
    take(island, island.gained);
    island.gained = 0;
  }
  knows_now_ = count_ == before;
  if (!knows_now_) scale(all);
}

}  // namespace lockstone
