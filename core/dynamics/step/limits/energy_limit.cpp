#include "core/dynamics/step/limits/energy_limit.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/base/reserved.h"
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

// Twice the kinetic energy for each mass, of a body with its present velocity.
std::int64_t row_energy(const EnergyLimit::Bodies& all, std::uint32_t i,
                        const Vec3<Velocity>& velocity) {
  const Vec3<Velocity> spin = velocity_of_row(all.bodies.rows()[i].spin);
  const Vec3<Velocity> surface = surface_velocity(all.bodies.constants()[i].inverse_inertia, spin);
  if (!all.bodies.constants()[i].is_heavier)
    return energy_product(velocity, velocity, spin, surface);
  return energy_product(velocity, velocity,
                        all.joints.own_spin(all.bodies.side(i).body(), spin, surface), surface);
}

}  // namespace

void EnergyLimit::reserve(std::size_t body_capacity) {
  islands_.reserve(body_capacity);
  numbers_.reserve(body_capacity + 1);
  bodies_.reserve(body_capacity);
}

void EnergyLimit::begin(const Bodies& all) {
  islands_.clear();
  count_ = 0;
  if (all.joints.empty()) return;
  find_islands(all);
  list_bodies(all);
}

void EnergyLimit::find_islands(const Bodies& all) {
  LKS_ASSERT(is_reserved(numbers_, all.islands.count()));
  numbers_.assign(all.islands.count(), k_unwatched);
  for (std::uint32_t i = 1; i < all.bodies.count(); ++i) {
    const std::uint32_t index = all.islands.of(i);
    const IslandTally& tally = all.islands.tally(index);
    if (index == 0 || !tally.has_joints || tally.contacts == 0 || tally.is_fed) continue;
    const BlockFloat inverse = all.bodies.constants()[i].inverse_mass;
    LKS_ASSERT(inverse.mantissa >= 0);
    if (inverse.mantissa == 0) continue;
    if (numbers_[index] == k_unwatched) {
      numbers_[index] = watched();
      islands_.emplace_back().island = index;
    }
    Island& island = islands_[numbers_[index]];
    const bool is_heavier = ratio(inverse, island.unit) < Unit::from_raw(1 << 29);
    if (island.unit == BlockFloat{} || is_heavier) island.unit = inverse;
    ++island.count;
  }
}

void EnergyLimit::list_bodies(const Bodies& all) {
  std::uint32_t next = 0;
  for (Island& island : islands_) {
    island.first = next;
    next += island.count;
    island.count = 0;
  }
  LKS_ASSERT(is_reserved(bodies_, next));
  bodies_.resize(next);
  for (std::uint32_t i = 1; i < all.bodies.count(); ++i) {
    const std::uint32_t number = numbers_[all.islands.of(i)];
    if (number == k_unwatched || !all.bodies.constants()[i].is_pushed()) continue;
    Island& island = islands_[number];
    WatchedBody& body = bodies_[island.first + island.count++];
    body.number = i;
    body.mass = quotient(island.unit, all.bodies.constants()[i].inverse_mass);
    add_energy(island.moving_gain, k_moving_gain, body.mass);
  }
}

void EnergyLimit::note(const Bodies& all, std::uint32_t watched) {
  Island& island = islands_[watched];
  LKS_ASSERT(island.count > 0);
  island.start = island.knows_now ? island.now : 0;
  for (WatchedBody& body : bodies_of(island)) {
    body.start = velocity_of_row(all.bodies.rows()[body.number].velocity);
    if (!island.knows_now)
      add_energy(island.start, row_energy(all, body.number, body.start), body.mass);
  }
}

// As it is now, and its change in the substep besides the work of gravity and forces.
void EnergyLimit::sum(const Bodies& all, Island& island) {
  island.now = 0;
  island.change = -island.start;
  for (const WatchedBody& body : bodies_of(island)) {
    ProductSum work;  // twice
    const Vec3<Velocity> end = velocity_of_row(all.bodies.rows()[body.number].velocity);
    for (int axis = 0; axis < 3; ++axis)
      work.add(all.bodies.constants()[body.number].gain[static_cast<std::size_t>(axis)],
               body.start[axis].raw + end[axis].raw);
    const std::int64_t own = row_energy(all, body.number, end);
    const std::int64_t change = raw::saturating_add(own, -work.rounded(32));
    add_energy(island.now, own, body.mass);
    add_energy(island.change, change, body.mass);
  }
}

// Takes an excess of energy away from all bodies of an island alike.
void EnergyLimit::take(const Bodies& all, const Island& island, std::int64_t excess) {
  const std::int32_t share = root_of_share(raw::saturating_add(island.now, -excess), island.now);
  LKS_ASSERT(share >= 0 && share <= 1 << k_share_bits);
  count_.fetch_add(1, std::memory_order_relaxed);
  if (share == 1 << k_share_bits) return;
  const auto shrink = [&](std::int64_t& now, std::int64_t& before) {
    const std::int64_t change =
        product_rounded(bounded_row(now), share, k_share_bits) - bounded_row(now);
    now = bounded_row(now) + change;
    before = bounded_row(before) + change;
  };
  for (const WatchedBody& body : bodies_of(island)) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
      shrink(all.bodies.rows()[body.number].velocity[axis],
             all.bodies.before()[body.number].velocity[axis]);
      shrink(all.bodies.rows()[body.number].spin[axis],
             all.bodies.before()[body.number].spin[axis]);
    }
  }
}

void EnergyLimit::limit_moves(const Bodies& all, std::uint32_t watched) {
  Island& island = islands_[watched];
  sum(all, island);
  const std::int64_t allowed =
      raw::saturating_add(island.start >> k_moving_gain_shift, island.moving_gain);
  if (island.change > allowed) take(all, island, island.change);
}

// The next substep begins as this one ends.
void EnergyLimit::limit_gains(const Bodies& all, std::uint32_t watched) {
  Island& island = islands_[watched];
  sum(all, island);
  island.gained = raw::saturating_add(island.gained, island.change);
  island.knows_now = island.gained <= (island.now >> k_free_gain_shift) + k_least_gain;
  if (island.knows_now) return;
  take(all, island, island.gained);
  island.gained = 0;
}

}  // namespace lockstone
