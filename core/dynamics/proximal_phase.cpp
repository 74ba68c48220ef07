// A phase of an island: the warm start, passes over its rows, and direct steps by its factor.

#include <algorithm>
#include <bit>

#include "core/dynamics/proximal_solver.h"
#include "core/dynamics/proximal_words.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

using namespace proximal;

// Residuals are exact, with so many bits more. A direct step takes as many as fit in 27; fewer
// where what it solves for does not fit.
constexpr int k_exact_bits = 27, k_residual_bits = 27, k_fewer_bits = 4, k_most_drop = 42;

// Passes before the first direct step, and after each; direct steps.
constexpr int k_first_passes = 2, k_passes = 4, k_direct_steps = 3;

// The limit of friction in units of the tangents, μ·Σλ of the points.
std::int64_t friction_limit(const ProximalContact& contact, std::int64_t ProximalRow::*impulse) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < contact.points; ++i)
    sum += raw::round_shift(contact.all[i].*impulse * contact.limits[i], k_limit_bits);
  return std::min(sum, k_most_value);
}

// The size of friction, squared.
std::uint64_t friction_size(const ProximalContact& contact, std::int64_t ProximalRow::*impulse) {
  std::uint64_t square = 0;
  for (std::size_t i = contact.points; i < contact.rows; ++i) {
    std::int64_t x = contact.all[i].*impulse;
    if (i == contact.points + 2)
      x = within_units(raw::round_shift(x * contact.twist_ratio, k_limit_bits));
    square += static_cast<std::uint64_t>(x * x);
  }
  return square;
}

// Shortens friction to its limit. Returns whether it had to.
bool project(ProximalContact& contact, std::int64_t ProximalRow::*impulse) {
  const std::int64_t limit = friction_limit(contact, impulse);
  const std::uint64_t square = friction_size(contact, impulse);
  if (square <= static_cast<std::uint64_t>(limit * limit)) return false;
  const auto size = static_cast<std::int64_t>(isqrt_rounded(square));
  const std::int64_t part = (limit << 31) / std::max<std::int64_t>(size, 1);
  for (std::size_t i = contact.points; i < contact.rows; ++i)
    contact.all[i].*impulse = raw::round_shift(contact.all[i].*impulse * part, 31);
  return true;
}

// θ = −slope / curve within 0 … 1, Q30.
std::int64_t dual_part(const ProductSum& slope, const ProductSum& curve) {
  constexpr std::int64_t k_fits = std::int64_t{1} << 60;
  int shift = 1;
  while (shift < 120 &&
         (magnitude(slope.rounded(shift)) >= k_fits || curve.rounded(shift) >= k_fits))
    shift += 4;
  const std::int64_t down = -slope.rounded(shift), total = curve.rounded(shift);
  if (down <= 0 || total <= 0) return 0;
  if (down >= total) return k_whole;
  const int width = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(total)));
  const int drop = std::max(0, width - 31);
  return std::min((down >> drop) * k_whole / std::max<std::int64_t>(total >> drop, 1), k_whole);
}

}  // namespace

// To the least of D along the last impulses: kinetic energy after the warm start is at most that of
// the free motion. What overlaps is not yet pushed out.
void ProximalSolver::scale_warm_start(Island& island) {
  const int down = k_row_unit_bits - island.bits;
  ProductSum slope, curve;
  for (const ProximalContact& contact : contacts_of(island)) {
    for (std::size_t i = 0; i < contact.rows; ++i) {
      const ProximalRow& row = contact.all[i];
      const bool pushes_out = i < contact.points && row.bias < 0;
      slope.subtract(row.impulse, row.speed - (pushes_out ? raw::round_shift(row.bias, down) : 0));
    }
  }
  if (slope.rounded(1) >= 0) return;
  const std::span<BodyVector> sums = of(changes_, island);
  for (BodyVector& sum : sums)
    sum = {};
  for (const ProximalContact& contact : contacts_of(island))
    for (std::size_t i = 0; i < contact.rows; ++i)
      add_sum(contact.all[i], contact.all[i].impulse, sums[contact.local_a], sums[contact.local_b]);
  (void)clamp_all(sums);
  for (std::size_t k = 0; k < island.bodies; ++k)
    for (const std::int64_t x : sums[k])
      curve.add(x, x);
  const std::int64_t part = dual_part(slope, curve);
  if (part == 0) return;
  for (ProximalContact& contact : contacts_of(island)) {
    for (std::size_t i = 0; i < contact.rows; ++i) {
      ProximalRow& row = contact.all[i];
      row.impulse -= raw::round_shift(row.impulse * part, 30);
    }
  }
  const std::span<BodyVector> velocities = of(velocities_, island);
  for (std::size_t k = 0; k < island.bodies; ++k)
    for (std::size_t i = 0; i < 6; ++i)
      velocities[k][i] = within_units(velocities[k][i] - raw::round_shift(sums[k][i] * part, 30));
}

// Returns whether no speed changed by as much as the tolerance.
bool ProximalSolver::pass_contact(ProximalContact& contact, BodyVector& a, BodyVector& b,
                                  bool& fits) {
  bool done = true;
  Clamp clamp;
  const auto wanted = [&](const ProximalRow& row) {
    const std::int64_t soft = raw::round_shift(row.give * (row.impulse - row.centre), 30);
    const std::int64_t error = clamp(row.speed + row_speed(row, a, b) + soft);
    return clamp(row.impulse - raw::round_shift(error * row.own_part, 30));
  };
  const auto change = [&](ProximalRow& row, std::int64_t next) {
    const std::int64_t moved = next - row.impulse;
    row.impulse = next;
    apply_row(row, moved, a, b, clamp);
    done = done && moved < row.tolerance && moved > -row.tolerance;
  };
  for (std::size_t i = 0; i < contact.points; ++i) {
    ProximalRow& row = contact.all[i];
    change(row, std::max<std::int64_t>(wanted(row), 0));
  }
  fits = fits && !clamp.hit();
  if (!contact.has_friction()) return done;
  for (std::size_t i = contact.points; i < contact.rows; ++i)
    contact.all[i].next = wanted(contact.all[i]);
  for (std::size_t i = 0; i < contact.points; ++i)
    contact.all[i].next = contact.all[i].impulse;
  (void)project(contact, &ProximalRow::next);
  for (std::size_t i = contact.points; i < contact.rows; ++i)
    change(contact.all[i], contact.all[i].next);
  fits = fits && !clamp.hit();
  return done;
}

bool ProximalSolver::pass(Island& island) {
  const std::span<BodyVector> velocities = of(velocities_, island);
  bool done = true;
  for (ProximalContact& contact : contacts_of(island)) {
    BodyVector &a = velocities[contact.local_a], &b = velocities[contact.local_b];
    if (!pass_contact(contact, a, b, island.fits)) done = false;
  }
  return done;
}

// Rows that push, and friction that does not slide. Where these are others than stand in the
// factor, it is of no use any more.
void ProximalSolver::mark_active(Island& island) {
  bool changed = false;
  for (ProximalContact& contact : contacts_of(island)) {
    bool pushes = false;
    const auto mark = [&](ProximalRow& row, bool is_active) {
      changed = changed || row.is_active != is_active;
      row.is_active = is_active;
    };
    for (std::size_t i = 0; i < contact.points; ++i) {
      mark(contact.all[i], contact.all[i].impulse > 0);
      pushes = pushes || contact.all[i].is_active;
    }
    if (!contact.has_friction()) continue;
    const std::int64_t limit = friction_limit(contact, &ProximalRow::impulse);
    const bool sticks = pushes && friction_size(contact, &ProximalRow::impulse) <
                                      static_cast<std::uint64_t>(limit * limit);
    for (std::size_t i = contact.points; i < contact.rows; ++i)
      mark(contact.all[i], sticks);
  }
  island.is_factored = island.is_factored && !changed;
}

void ProximalSolver::factor(Island& island) {
  factor_.reset(island.plan);
  for (std::uint32_t c = island.first_contact; c < island.first_contact + island.contacts; ++c) {
    const ProximalContact& contact = contacts_[c];
    const Blocks& blocks = blocks_[c];
    for (std::size_t i = 0; i < contact.rows; ++i) {
      const ProximalRow& row = contact.all[i];
      if (!row.is_active) continue;
      if (contact.a != 0) factor_.add(blocks.a, row.a, row.a, row.weight);
      if (contact.b != 0) factor_.add(blocks.b, row.b, row.b, row.weight);
      if (contact.a == 0 || contact.b == 0) continue;
      const bool a_is_row = blocks.both.a_is_row;
      factor_.add(blocks.both.block, a_is_row ? row.a : row.b, a_is_row ? row.b : row.a,
                  row.weight);
    }
  }
  factor_.factor(island.plan);
  island.is_factored = island.was_factored = true;
}

// Of all rows, exact. How many of their bits a direct step drops.
void ProximalSolver::find_residuals(Island& island) {
  const std::span<BodyVector> velocities = of(velocities_, island);
  constexpr int k_drop = 30 - k_exact_bits;
  std::uint64_t most = 1;
  for (ProximalContact& contact : contacts_of(island)) {
    for (std::size_t i = 0; i < contact.rows; ++i) {
      ProximalRow& row = contact.all[i];
      const std::int64_t moved =
          row_dot(row.a, velocities[contact.local_a]) + row_dot(row.b, velocities[contact.local_b]);
      const std::int64_t soft = row.give * (row.impulse - row.centre);
      row.residual = row.speed * (std::int64_t{1} << k_exact_bits) +
                     raw::round_shift(moved, k_drop) + raw::round_shift(soft, k_drop);
      if (row.is_active || i >= contact.points) most |= magnitude(row.residual);
    }
  }
  island.drop = std::max(0, static_cast<int>(std::bit_width(most)) - k_residual_bits);
}

// Solves for velocities, with the right-hand side −Σ Jᵀ·r/γ of the active rows, times 2^-14.
// Returns whether all fits.
bool ProximalSolver::solve_for_changes(Island& island) {
  const std::span<BodyVector> sums = of(changes_, island);
  for (BodyVector& sum : sums)
    sum = {};
  for (const ProximalContact& contact : contacts_of(island))
    for (std::size_t i = 0; i < contact.rows; ++i) {
      const ProximalRow& row = contact.all[i];
      if (!row.is_active) continue;
      const std::int64_t residual = raw::round_shift(row.residual, island.drop);
      add_sum(row, -raw::round_shift(residual * row.weight, 30), sums[contact.local_a],
              sums[contact.local_b]);
    }
  return clamp_all(sums) && factor_.solve(island.plan, sums.first(island.bodies));
}

// Impulses at the solution of the active rows' equations, as far as they are allowed. Notes whether
// all are, and whether no other row would close: then this is the solution.
void ProximalSolver::propose(Island& island) {
  const std::span<BodyVector> changes = of(changes_, island);
  changes[island.bodies] = {};
  island.is_solved = true;
  for (ProximalContact& contact : contacts_of(island)) {
    for (std::size_t i = 0; i < contact.rows; ++i) {
      ProximalRow& row = contact.all[i];
      const bool is_normal = i < contact.points;
      const std::int64_t left = raw::round_shift(row.residual, island.drop) +
                                row_speed(row, changes[contact.local_a], changes[contact.local_b]);
      row.next = is_normal ? 0 : row.impulse;
      if (!row.is_active) {
        island.is_solved = island.is_solved && (is_normal ? left >= 0 : row.impulse == 0);
        continue;
      }
      // left / γ = left · weight · 2^14.
      const std::int64_t moved = product_rounded(
          left, row.weight, 30 + k_exact_bits - BodyFactor::k_least_bits - island.drop);
      row.next = within_units(row.impulse - moved);
      island.fits = island.fits && row.next == row.impulse - moved;
      if (!is_normal || row.next >= 0) continue;
      row.next = 0;
      island.is_solved = false;
    }
    if (contact.has_friction() && project(contact, &ProximalRow::next)) island.is_solved = false;
  }
}

// Goes towards what was proposed as far as D falls. Returns whether it goes anywhere.
bool ProximalSolver::search(Island& island) {
  ProductSum slope, curve;
  constexpr std::int64_t k_scale = std::int64_t{1} << k_exact_bits;
  const std::span<BodyVector> sums = of(changes_, island);
  for (BodyVector& sum : sums)
    sum = {};
  for (const ProximalContact& contact : contacts_of(island)) {
    for (std::size_t i = 0; i < contact.rows; ++i) {
      const ProximalRow& row = contact.all[i];
      const std::int64_t change = within_units(row.next - row.impulse);
      if (change == 0) continue;
      slope.add(change, row.residual);
      curve.add(raw::round_shift(row.give * change, 30 - k_exact_bits), change);
      add_sum(row, change, sums[contact.local_a], sums[contact.local_b]);
    }
  }
  island.fits = clamp_all(sums.first(island.bodies)) && island.fits;
  for (std::size_t k = 0; k < island.bodies; ++k)
    for (const std::int64_t x : sums[k])
      curve.add(x * k_scale, x);
  const std::int64_t part = dual_part(slope, curve);
  if (part == 0) return false;
  go(island, part);
  return true;
}

// By a part of what `search` has at hand, Q30.
void ProximalSolver::go(Island& island, std::int64_t part) {
  const auto of_part = [part](std::int64_t x) { return raw::round_shift(x * part, 30); };
  island.is_solved = island.is_solved && part == k_whole;
  for (ProximalContact& contact : contacts_of(island))
    for (std::size_t i = 0; i < contact.rows; ++i) {
      ProximalRow& row = contact.all[i];
      row.impulse = part == k_whole ? row.next : row.impulse + of_part(row.next - row.impulse);
    }
  Clamp clamp;
  const std::span<const BodyVector> sums = of(changes_, island);
  const std::span<BodyVector> velocities = of(velocities_, island);
  for (std::size_t k = 0; k < island.bodies; ++k)
    for (std::size_t i = 0; i < 6; ++i)
      velocities[k][i] =
          clamp(velocities[k][i] + (part == k_whole ? sums[k][i] : of_part(sums[k][i])));
  island.fits = island.fits && !clamp.hit();
}

bool ProximalSolver::direct_step(Island& island) {
  mark_active(island);
  if (!island.is_factored) factor(island);
  find_residuals(island);
  while (!solve_for_changes(island)) {
    island.drop += k_fewer_bits;
    if (island.drop > k_most_drop) return false;
  }
  propose(island);
  return search(island);
}

// In the units at hand. Returns false where they are too fine.
bool ProximalSolver::converge(Island& island, bool scales) {
  island.fits = true;
  for (ProximalContact& contact : contacts_of(island))
    convert(island, contact);
  for (BodyVector& velocity : of(velocities_, island))
    velocity = {};
  if (scales) scale_warm_start(island);
  // Resting bodies are solved by the factor at hand: passes alone would leave them creeping.
  mark_active(island);
  island.is_solved = false;
  if (island.is_factored || !island.was_factored) (void)direct_step(island);
  bool done = island.is_solved;
  for (int step = 0; !done && island.fits; ++step) {
    for (int i = 0; i < (step == 0 ? k_first_passes : k_passes) && !done; ++i)
      done = pass(island);
    if (step == k_direct_steps || done || !direct_step(island)) break;
    done = island.is_solved;
  }
  return island.fits;
}

}  // namespace lockstone
