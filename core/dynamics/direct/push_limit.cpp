#include "core/dynamics/direct/push_limit.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/body/energy.h"
#include "core/dynamics/contact/block_words.h"
#include "core/dynamics/problem/proximal_words.h"

namespace lockstone {
namespace {

// Bits of squared units that sums of energies leave out.
constexpr int k_energy_shift = 16;

// The energy that bodies have at this many times the speed of the fastest push is theirs to gain.
constexpr std::int64_t k_free_speeds = 4;

// Slower pushes are not looked at: 1 mm/s, Q24.
constexpr std::int64_t k_slow_push = (std::int64_t{1} << 24) / 1000;

// Of all points that push overlap out, m/s, Q24.
std::int64_t fastest_push(const IslandView& island) {
  std::int64_t fastest = 0;
  for (std::size_t c = 0; c < island.contacts.size(); ++c) {
    const lanes::ProximalBlock& problem = island.problems[c];
    for (std::size_t i = 0; i < problem.points; ++i) {
      if (problem.bias[i] >= 0) continue;
      const RowScale from_row = island.contacts[c].all[i].to_speed.reciprocal();
      fastest = std::max(fastest, -from_row.times(problem.bias[i], k_row_unit_bits - 24));
    }
  }
  return fastest;
}

// Twice the energy that the phase gave, by m₀, in its squared units.
std::int64_t twice_gain(const IslandView& island) {
  const int down = k_row_unit_bits - island.state.bits;
  ProductSum twice;
  for (const lanes::ProximalBlock& problem : island.problems) {
    for (std::size_t i = 0; i < problem.rows; ++i) {
      const std::int64_t change = 2 * (problem.impulse[i] - problem.start[i]);
      twice.add(change, raw::round_shift(problem.moving[i], down));
    }
  }
  for (const BodyVector& velocity : island.velocities)
    for (const std::int64_t x : velocity)
      twice.add(x, x);
  return twice.rounded(k_energy_shift);
}

// Twice the energy by m₀ of all bodies at a speed, m/s, Q24, likewise.
std::int64_t twice_energy_at(const ContactRun& run, const IslandView& island, std::int64_t speed) {
  const int down = k_row_unit_bits - island.state.bits;
  ProductSum twice;
  for (const std::uint32_t body : island.bodies) {
    const RowScale mass = mass_scale(island.state.unit, run.bodies[body].inverse_mass);
    const std::int64_t u = raw::round_shift(mass.times(speed, 24 - k_row_unit_bits), down);
    twice.add(u, u);
  }
  return twice.rounded(k_energy_shift);
}

}  // namespace

bool limits_pushes(const ContactRun& run, const IslandView& island) {
  LKS_ASSERT(island.joints.empty());
  const std::int64_t fastest = fastest_push(island);
  if (fastest <= k_slow_push) return false;
  const std::int64_t gained = twice_gain(island);
  const std::int64_t allowed = twice_energy_at(run, island, k_free_speeds * fastest);
  if (gained <= allowed) return false;
  const std::int32_t share = root_of_share(allowed, gained);
  LKS_ASSERT(share >= 0 && share < 1 << k_share_bits);
  for (lanes::ProximalBlock& problem : island.problems)
    for (std::size_t i = 0; i < problem.points; ++i)
      if (problem.bias[i] < 0)
        problem.bias[i] = product_rounded(problem.bias[i], share, k_share_bits);
  return true;
}

}  // namespace lockstone
