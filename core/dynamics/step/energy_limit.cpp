// Contacts and joints of an island may work against each other: joints that hold bodies where they
// overlap, or links that turn faster than the substep resolves while something presses them. So the
// energy of such an island is checked in each substep. Its gain in a tick, besides the work of
// gravity and forces and beyond a small part, is taken away from all of its bodies alike; and
// positions do not move with velocities of much more energy than those before them.

#include <algorithm>

#include "core/dynamics/body/energy.h"
#include "core/dynamics/linkage/joint_solver.h"
#include "core/dynamics/step/contact_solver.h"

namespace lockstone {
namespace {

// In a tick an island may gain this part of its kinetic energy: 2^-6.
constexpr int k_free_gain_shift = 6;

// And so much besides, twice by the heaviest body's mass: (5 cm/s)², Q32.
constexpr std::int64_t k_least_gain = (std::int64_t{1} << 32) / 400;

// Positions may move with velocities of so much more energy than the substep began with: 2^-4 of
// it, and, twice for each mass, (0.5 m/s)², Q32, to close joints and overlap.
constexpr int k_moving_gain_shift = 4;
constexpr std::int64_t k_moving_gain = std::int64_t{1} << 30;

Vec3<Velocity> read(const std::array<std::int64_t, 3>& v) {
  const auto part = [](std::int64_t x) {
    return Velocity::from_raw(x >> (lanes::k_velocity_bits - lanes::k_grid_bits));
  };
  return {part(v[0]), part(v[1]), part(v[2])};
}

// Velocities of a substep stay within 2048 m/s.
std::int64_t bounded_row(std::int64_t x) {
  constexpr std::int64_t k_bound = std::int64_t{1} << 61;
  return std::clamp(x, -k_bound, k_bound);
}

}  // namespace

// At the beginning of a tick.
void ContactSolver::watch_energies() {
  watches_energy_ = false;
  energy_limits_ = 0;
  if (!joints_->has_own()) return;
  starts_.resize(members_.size());
  energies_.assign(islands_.count(), {});
  for (std::uint32_t i = 1; i < members_.size(); ++i) {
    const IslandLoad& load = islands_.load(islands_.of(i));
    if (islands_.of(i) == 0 || !load.has_joints || load.contacts == 0 || load.is_fed) continue;
    IslandEnergy& energy = energies_[islands_.of(i)];
    const BlockFloat inverse = bodies_[i].inverse_mass;
    if (inverse.mantissa == 0) continue;
    const bool is_heavier = ratio(inverse, energy.unit) < Unit::from_raw(1 << 29);
    if (energy.unit == BlockFloat{} || is_heavier) energy.unit = inverse;
    watches_energy_ = true;
  }
}

std::uint32_t ContactSolver::energy_limits() const {
  return energy_limits_ + joints_->energy_limits();
}

// Twice the kinetic energy for each mass.
std::int64_t ContactSolver::row_energy(std::uint32_t i) const {
  const Vec3<Velocity> velocity = read(rows_[i].velocity), spin = read(rows_[i].spin);
  const Vec3<Velocity> surface = surface_velocity(bodies_[i].inverse_inertia, spin);
  return energy_product(velocity, velocity, joints_->own_spin(members_[i], spin, surface), surface);
}

template <class Visit>
void ContactSolver::for_watched(const Visit& visit) {
  for (std::uint32_t i = 1; i < members_.size(); ++i) {
    IslandEnergy& energy = energies_[islands_.of(i)];
    if (energy.unit != BlockFloat{} && bodies_[i].is_pushed())
      visit(i, energy, quotient(energy.unit, bodies_[i].inverse_mass));
  }
}

// At the beginning of a substep.
void ContactSolver::note_energies() {
  for (IslandEnergy& energy : energies_)
    energy.first = 0;
  for_watched([&](std::uint32_t i, IslandEnergy& energy, BlockFloat mass) {
    starts_[i] = read(rows_[i].velocity);
    energy.first = raw::saturating_add(energy.first, scale_saturating(row_energy(i), mass, 0));
  });
}

// As it is now, and its change in the substep besides the work of gravity and forces.
void ContactSolver::sum_energies() {
  for (IslandEnergy& energy : energies_) {
    energy.now = 0;
    energy.change = -energy.first;
    energy.moving_gain = energy.first >> k_moving_gain_shift;
  }
  for_watched([&](std::uint32_t i, IslandEnergy& energy, BlockFloat mass) {
    ProductSum work;  // twice
    const Vec3<Velocity> end = read(rows_[i].velocity);
    for (int axis = 0; axis < 3; ++axis)
      work.add(bodies_[i].gain[static_cast<std::size_t>(axis)],
               starts_[i][axis].raw + end[axis].raw);
    const std::int64_t own = row_energy(i);
    const std::int64_t change = raw::saturating_add(own, -work.rounded(32));
    energy.now = raw::saturating_add(energy.now, scale_saturating(own, mass, 0));
    energy.change = raw::saturating_add(energy.change, scale_saturating(change, mass, 0));
    energy.moving_gain =
        raw::saturating_add(energy.moving_gain, scale_saturating(k_moving_gain, mass, 0));
  });
}

// Takes an excess of energy away from all bodies of an island alike.
void ContactSolver::take_energy(IslandEnergy& energy, std::int64_t excess) {
  energy.share = root_of_share(raw::saturating_add(energy.now, -excess), energy.now);
  ++energy_limits_;
}

void ContactSolver::scale_islands() {
  for_watched([&](std::uint32_t i, const IslandEnergy& energy, BlockFloat) {
    if (energy.share == 1 << k_share_bits) return;
    const auto scale = [&](std::int64_t& now, std::int64_t& before) {
      const std::int64_t change =
          product_rounded(bounded_row(now), energy.share, k_share_bits) - bounded_row(now);
      now = bounded_row(now) + change;
      before = bounded_row(before) + change;
    };
    for (std::size_t axis = 0; axis < 3; ++axis) {
      scale(rows_[i].velocity[axis], before_[i].velocity[axis]);
      scale(rows_[i].spin[axis], before_[i].spin[axis]);
    }
  });
}

// Before positions move: a body that goes too far in a substep may be lifted, or leave its joints.
void ContactSolver::limit_moves() {
  sum_energies();
  for (IslandEnergy& energy : energies_) {
    energy.share = 1 << k_share_bits;
    if (energy.change > energy.moving_gain) take_energy(energy, energy.change);
  }
  scale_islands();
}

// At the end of a substep.
void ContactSolver::limit_energies() {
  sum_energies();
  for (IslandEnergy& energy : energies_) {
    energy.gained = raw::saturating_add(energy.gained, energy.change);
    energy.share = 1 << k_share_bits;
    if (energy.gained <= (energy.now >> k_free_gain_shift) + k_least_gain) continue;
    take_energy(energy, energy.gained);
    energy.gained = 0;
  }
  scale_islands();
}

}  // namespace lockstone
