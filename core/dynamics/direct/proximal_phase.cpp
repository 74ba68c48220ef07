// A phase of an island: the warm start, passes over its rows, and direct steps by its factor.

#include <algorithm>
#include <bit>

#include "core/dynamics/direct/proximal_solver.h"
#include "core/dynamics/problem/proximal_words.h"
#include "core/kernels/proximal/proximal_friction.h"

namespace lockstone {
namespace {

using namespace proximal;

// Residuals are exact. A direct step takes as many of their bits as fit in 27, and fewer where the
// solution does not fit.
constexpr int k_residual_bits = 27, k_more_drop = 4, k_most_drop = 42;

// Passes before the first direct step, and after each; direct steps.
struct Effort {
  int first_passes, passes, direct_steps;
};
constexpr Effort k_of_contacts{2, 4, 3}, k_with_joints{4, 4, 1};

// Friction that is as near to its limit as 2^-this may slide.
constexpr int k_near_shift = 8;

// How often centres move in a phase.
constexpr int k_most_centres = 3;

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

// Scales the last impulses to the least of D, from 0 in a tick's first phase and down from all of
// them in others: kinetic energy after the warm start is at most that of the free motion. Biases
// that push overlap out are left out of D here.
void ProximalSolver::scale_warm_start(Island& island) {
  const int down = k_row_unit_bits - island.bits;
  ProductSum slope, curve;
  for (Problem& problem : problems_of(island)) {
    if (problem.has_locks) problem.next = problem.impulse;
    for (std::size_t i = 0; i < problem.rows && !problem.has_locks; ++i) {
      const bool pushes_out = i < problem.points && problem.bias[i] < 0;
      const std::int64_t out = pushes_out ? raw::round_shift(problem.bias[i], down) : 0;
      problem.next[i] = island.warms ? within_units(raw::round_shift(problem.warm[i], down)) : 0;
      slope.add(problem.next[i] - problem.impulse[i], problem.speed[i] - out);
    }
  }
  if (slope.rounded(1) >= 0) return;
  sum_changes(island);
  for (const BodyVector& sum : of(changes_, island).first(island.bodies))
    for (const std::int64_t x : sum)
      curve.add(x, x);
  const std::int64_t part = dual_part(slope, curve);
  if (part != 0) go(island, part);
}

bool ProximalSolver::pass(Island& island) {
  const std::span<Problem> problems = problems_of(island);
  const lanes::PhaseResult result = lanes::proximal_kernels().pass(problems.data(), problems.size(),
                                                                   of(velocities_, island).data());
  island.fits = island.fits && result.fits;
  return result.done;
}

// Rows that push, and friction that does not slide. Where these are others than stand in the
// factor, it is of no use any more.
void ProximalSolver::mark_active(Island& island) {
  bool changed = false;
  const auto mark = [&](std::int64_t& word, bool is_active) {
    const std::int64_t next = is_active ? -1 : 0;
    changed = changed || word != next;
    word = next;
  };
  for (Problem& problem : problems_of(island)) {
    bool pushes = false;
    for (std::size_t i = 0; i < problem.points; ++i) {
      mark(problem.active[i], problem.impulse[i] > 0);
      pushes = pushes || problem.impulse[i] > 0;
    }
    for (std::size_t i = problem.points; problem.has_locks && i < problem.rows; ++i)
      mark(problem.active[i], true);
    if (!problem.has_friction()) continue;
    const std::int64_t limit = pushes ? lanes::friction_limit(problem, problem.impulse) : 0;
    const std::int64_t near = limit - (limit >> k_near_shift);
    const bool sticks =
        pushes && !problem.slides &&
        lanes::friction_size(problem, problem.impulse) < static_cast<std::uint64_t>(near * near);
    for (std::size_t i = problem.points; i < problem.rows; ++i)
      mark(problem.active[i], sticks);
  }
  island.is_factored = island.is_factored && !changed;
}

void ProximalSolver::factor(Island& island) {
  factor_.reset(island.plan);
  const lanes::ProximalKernels& kernels = lanes::proximal_kernels();
  const auto block = [this](std::uint32_t index) {
    return index == k_no_block ? nullptr : &factor_.block(index);
  };
  for (std::uint32_t i = island.first_problem; i < island.first_problem + island.problems(); ++i) {
    const Blocks& blocks = blocks_[i];
    kernels.add_to_matrix(problems_[i], {block(blocks.a), block(blocks.b), block(blocks.both.block),
                                         blocks.both.a_is_row});
  }
  factor_.factor(island.plan);
  island.is_factored = island.was_factored = true;
}

// Of all rows, exact. How many of their bits a direct step drops.
void ProximalSolver::find_residuals(Island& island) {
  const std::span<Problem> problems = problems_of(island);
  const std::uint64_t most = lanes::proximal_kernels().find_residuals(
      problems.data(), problems.size(), of(velocities_, island).data());
  island.drop = std::max(1, static_cast<int>(std::bit_width(most)) - k_residual_bits);
}

// Solves for velocities, with the right-hand side −Σ Jᵀ·r/γ of the active rows, times 2^-14.
// Returns whether all fits.
bool ProximalSolver::solve_for_changes(Island& island) {
  const std::span<BodyVector> sums = of(changes_, island);
  std::ranges::fill(sums, BodyVector{});
  const std::span<const Problem> problems = problems_of(island);
  lanes::proximal_kernels().add_right_sides(problems.data(), problems.size(), island.drop,
                                            sums.data());
  const bool fits = clamp_all(sums) && factor_.solve(island.plan, sums.first(island.bodies));
  sums[island.bodies] = {};
  return fits;
}

// Sums the changes of the bodies' velocities by the step to the next impulses.
void ProximalSolver::sum_changes(Island& island) {
  const std::span<BodyVector> sums = of(changes_, island);
  std::ranges::fill(sums, BodyVector{});
  const std::span<const Problem> problems = problems_of(island);
  const bool fits =
      lanes::proximal_kernels().add_changes(problems.data(), problems.size(), sums.data());
  island.fits = clamp_all(sums.first(island.bodies)) && fits && island.fits;
}

// The part of the step at which D is least.
std::int64_t ProximalSolver::search(const Island& island) {
  constexpr std::int64_t k_scale = std::int64_t{1} << lanes::k_residual_point;
  ProductSum slope, curve;
  for (const Problem& problem : problems_of(island)) {
    for (std::size_t i = 0; i < problem.rows; ++i) {
      const std::int64_t change = within_units(problem.next[i] - problem.impulse[i]);
      if (change == 0) continue;
      slope.add(change, problem.residual[i]);
      curve.add(problem.give[i] * change, change);
    }
  }
  for (const BodyVector& sum : of(changes_, island).first(island.bodies))
    for (const std::int64_t x : sum)
      curve.add(x * k_scale, x);
  return dual_part(slope, curve);
}

// By a part of the step at hand, Q30.
void ProximalSolver::go(Island& island, std::int64_t part) {
  const auto of_part = [part](std::int64_t x) {
    return part == k_whole ? x : raw::round_shift(x * part, 30);
  };
  for (Problem& problem : problems_of(island))
    for (std::size_t i = 0; i < problem.rows; ++i)
      problem.impulse[i] += of_part(problem.next[i] - problem.impulse[i]);
  Clamp clamp;
  const std::span<const BodyVector> sums = of(changes_, island);
  const std::span<BodyVector> velocities = of(velocities_, island);
  for (std::size_t k = 0; k < island.bodies; ++k)
    for (std::size_t i = 0; i < lanes::k_body_words; ++i)
      velocities[k][i] = clamp(velocities[k][i] + of_part(sums[k][i]));
  island.fits = island.fits && !clamp.hit();
}

// Goes towards the solution of the active rows' equations, as far as it is allowed and D falls: all
// the way where it is the solution of the phase. Returns whether it goes anywhere.
bool ProximalSolver::direct_step(Island& island) {
  if (!island.is_factored) factor(island);
  find_residuals(island);
  while (!solve_for_changes(island)) {
    island.drop += k_more_drop;
    if (island.drop > k_most_drop) return false;
  }
  const std::span<Problem> problems = problems_of(island);
  const lanes::PhaseResult result = lanes::proximal_kernels().propose(
      problems.data(), problems.size(), island.drop, of(changes_, island).data());
  island.is_solved = result.done;
  island.fits = island.fits && result.fits;
  sum_changes(island);
  const std::int64_t part = island.is_solved ? k_whole : search(island);
  if (part == 0) return false;
  go(island, part);
  return true;
}

// In the units at hand. Returns false where they are too fine.
bool ProximalSolver::converge(Island& island, bool scales) {
  island.fits = true;
  const std::span<Problem> problems = problems_of(island);
  lanes::proximal_kernels().begin_phase(problems.data(), problems.size(),
                                        k_row_unit_bits - island.bits, island.loose);
  std::ranges::fill(of(velocities_, island), BodyVector{});
  if (scales) scale_warm_start(island);
  iterate(island);
  const int centres = island.joints == 0 ? k_most_centres : 0;
  for (int i = 0; i < centres && island.fits && move_centres(island); ++i)
    iterate(island);
  return island.fits;
}

// Where rows give by more than a centimetre a second, for a load that nobody knew, the last
// impulses become their centres. Returns whether any did.
bool ProximalSolver::move_centres(Island& island) {
  constexpr std::int64_t k_most_give = 100;  // tolerances
  bool moves = false;
  for (Problem& problem : problems_of(island)) {
    for (std::size_t i = 0; i < problem.points && !moves; ++i) {
      const std::int64_t give = problem.give[i] * (problem.impulse[i] - problem.centre[i]);
      moves = raw::round_shift(give, 30) > k_most_give * (problem.tolerance[i] >> island.loose);
    }
  }
  if (moves)
    for (Problem& problem : problems_of(island))
      problem.centre = problem.impulse;
  return moves;
}

// Until no row changes, or the steps are used up.
void ProximalSolver::iterate(Island& island) {
  // Resting bodies are solved by the factor at hand: passes alone would leave them creeping.
  mark_active(island);
  island.is_solved = false;
  if (island.is_factored || !island.was_factored) (void)direct_step(island);
  bool done = island.is_solved;
  const Effort& effort = island.joints == 0 ? k_of_contacts : k_with_joints;
  for (int step = 0; !done && island.fits; ++step) {
    for (int i = 0; i < (step == 0 ? effort.first_passes : effort.passes) && !done; ++i)
      done = pass(island);
    if (step == effort.direct_steps || done) break;
    mark_active(island);
    (void)direct_step(island);
    done = island.is_solved;
  }
}

}  // namespace lockstone
