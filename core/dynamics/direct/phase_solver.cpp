#include "core/dynamics/direct/phase_solver.h"

#include <algorithm>
#include <bit>

#include <lockstone/assert.h>

#include "core/dynamics/problem/proximal_words.h"
#include "core/kernels/proximal/proximal_friction.h"

namespace lockstone {
namespace {

using namespace proximal;
using Problem = lanes::ProximalBlock;

// Units are such that all magnitudes at the beginning of a phase are below 2^27 of them; words hold
// 2^31. If a phase overflows, it is solved again with coarser units.
constexpr int k_start_bits = 27;
constexpr int k_most_bits = k_row_unit_bits - 1, k_least_bits = 2;
constexpr int k_coarser_bits = 5;

// Residuals are exact. A direct step takes as many of their bits as fit in 27, and fewer where the
// solution does not fit.
constexpr int k_residual_bits = 27, k_more_drop = 4, k_most_drop = 42;

// A direct step solves again where its first solve changes one row in this many contacts at most.
constexpr std::size_t k_changing_part = 20;

// Passes before the first direct step, and after each; direct steps at most; solves at most of each
// of the first k_long_steps direct steps of an island that is not stirred, others have one.
struct Effort {
  int first_passes, passes, direct_steps, solves;
};
constexpr Effort k_of_contacts{2, 4, 4, 6}, k_with_joints{4, 4, 1, 1};
constexpr int k_long_steps = 2;

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
  LKS_ASSERT(magnitude(down) < static_cast<std::uint64_t>(k_fits) && total < k_fits);
  if (down <= 0 || total <= 0) return 0;
  if (down >= total) return k_whole;
  const int width = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(total)));
  const int drop = std::max(0, width - 31);
  return std::min((down >> drop) * k_whole / std::max<std::int64_t>(total >> drop, 1), k_whole);
}

// How many bits of residuals a direct step leaves out; `bits`: of all magnitudes that it reads.
int drop_of(std::uint64_t bits) {
  return static_cast<int>(std::bit_width(bits)) - k_residual_bits;
}

}  // namespace

bool PhaseSolver::set_units() {
  const std::uint64_t most =
      lanes::proximal_kernels().magnitudes(island_.problems.data(), island_.problems.size());
  if (most == 0) return false;
  const int finest = k_row_unit_bits + k_start_bits - static_cast<int>(std::bit_width(most));
  island_.state.bits = std::clamp(finest, k_least_bits, k_most_bits);
  return true;
}

void PhaseSolver::solve(bool scales) {
  int& bits = island_.state.bits;
  LKS_ASSERT(bits >= k_least_bits && bits <= k_most_bits);
  while (!converge(scales) && bits >= k_least_bits + k_coarser_bits)
    bits -= k_coarser_bits;
}

// Scales the last impulses to the least of D, from 0 in a tick's first phase and down from all of
// them in others: kinetic energy after the warm start is at most that of the free motion. Biases
// that push overlap out are left out of D here.
void PhaseSolver::scale_warm_start() {
  const int down = k_row_unit_bits - island_.state.bits;
  ProductSum slope;
  for (Problem& problem : island_.problems) {
    LKS_ASSERT(problem.points <= problem.rows);
    if (problem.has_locks) problem.next = problem.impulse;
    for (std::size_t i = 0; i < problem.rows && !problem.has_locks; ++i) {
      const bool pushes_out = i < problem.points && problem.bias[i] < 0;
      const std::int64_t out = pushes_out ? raw::round_shift(problem.bias[i], down) : 0;
      problem.next[i] =
          island_.state.warms ? within_units(raw::round_shift(problem.warm[i], down)) : 0;
      slope.add(problem.next[i] - problem.impulse[i], problem.speed[i] - out);
    }
  }
  go_to_least_energy(slope, 1);
}

// Scales all impulses down to the least kinetic energy, once a phase that pushes no overlap out is
// over: at most that of free motion, converged or not. Where it is converged nothing changes, since
// no row that pushes moves.
void PhaseSolver::scale_down() {
  const std::span<Problem> problems = island_.problems;
  lanes::proximal_kernels().find_residuals(problems.data(), problems.size(),
                                           island_.velocities.data());
  ProductSum slope;
  for (Problem& problem : problems) {
    LKS_ASSERT(problem.points <= problem.rows && !problem.has_locks);
    problem.next = {};
    for (std::size_t i = 0; i < problem.rows; ++i) {
      const std::int64_t impulse = problem.impulse[i];
      const std::int64_t pulled = problem.give[i] * (impulse - problem.centre[i]);
      slope.add(-impulse, problem.residual[i] - pulled);
    }
  }
  go_to_least_energy(slope, std::int64_t{1} << lanes::k_residual_point);
}

// Goes along the step at hand as far as kinetic energy falls; `slope`: its slope, in units `scale`
// times as fine.
void PhaseSolver::go_to_least_energy(const ProductSum& slope, std::int64_t scale) {
  if (slope.rounded(1) >= 0) return;
  sum_changes();
  ProductSum curve;
  add_curve(scale, curve);
  const std::int64_t part = dual_part(slope, curve);
  if (part != 0) go(part);
}

// Adds the curve of kinetic energy along the step at hand, whose changes are summed.
void PhaseSolver::add_curve(std::int64_t scale, ProductSum& curve) const {
  LKS_ASSERT(scale > 0);
  for (const BodyVector& sum : island_.changes.first(body_count()))
    for (const std::int64_t x : sum)
      curve.add(x * scale, x);
}

bool PhaseSolver::pass() {
  const std::span<Problem> problems = island_.problems;
  const lanes::PassResult result =
      lanes::proximal_kernels().pass(problems.data(), problems.size(), island_.velocities.data());
  fits_ = fits_ && result.fits;
  return result.done;
}

// Rows that push, and friction that does not slide. Where these are others than stand in the
// factor, it is of no use any more.
void PhaseSolver::mark_active() {
  bool changed = false;
  const auto mark = [&](std::int64_t& word, bool is_active) {
    const std::int64_t next = is_active ? -1 : 0;
    changed = changed || word != next;
    word = next;
  };
  for (Problem& problem : island_.problems) {
    LKS_ASSERT(problem.points <= problem.rows);
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
  island_.state.is_factored = island_.state.is_factored && !changed;
}

void PhaseSolver::factor() {
  LKS_ASSERT(island_.blocks.size() == island_.problems.size());
  factor_.reset(island_.plan);
  const lanes::ProximalKernels& kernels = lanes::proximal_kernels();
  const auto block = [this](std::uint32_t index) {
    return index == MatrixBlocks::k_none ? nullptr : &factor_.block(index);
  };
  for (std::size_t i = 0; i < island_.problems.size(); ++i) {
    const MatrixBlocks& blocks = island_.blocks[i];
    kernels.add_to_matrix(island_.problems[i], {block(blocks.a), block(blocks.b),
                                                block(blocks.both.block), blocks.both.a_is_row});
  }
  factor_.factor(island_.plan);
  island_.state.is_factored = island_.state.was_factored = true;
}

// Of all rows, exact. How many of their bits a direct step drops.
void PhaseSolver::find_residuals() {
  LKS_ASSERT(island_.velocities.size() == body_count() + 1);
  const std::span<Problem> problems = island_.problems;
  const std::uint64_t most = lanes::proximal_kernels().find_residuals(
      problems.data(), problems.size(), island_.velocities.data());
  drop_ = std::max(1, drop_of(most));
}

// Solves for velocities, with the right-hand side −Σ Jᵀ·r/γ of the active rows, times 2^-14.
// Returns whether all fits.
bool PhaseSolver::solve_for_changes() {
  LKS_ASSERT(island_.state.is_factored && drop_ >= 1 && drop_ <= k_most_drop + k_more_drop);
  const std::span<BodyVector> sums = island_.changes;
  std::ranges::fill(sums, BodyVector{});
  const std::span<const Problem> problems = island_.problems;
  lanes::proximal_kernels().add_right_sides(problems.data(), problems.size(), drop_, sums.data());
  const bool fits = clamp_all(sums) && factor_.solve(island_.plan, sums.first(body_count()));
  sums[body_count()] = {};
  return fits;
}

// Sums the changes of the bodies' velocities by the step to the next impulses.
void PhaseSolver::sum_changes() {
  LKS_ASSERT(island_.changes.size() == body_count() + 1);
  const std::span<BodyVector> sums = island_.changes;
  std::ranges::fill(sums, BodyVector{});
  const std::span<const Problem> problems = island_.problems;
  const bool fits =
      lanes::proximal_kernels().add_changes(problems.data(), problems.size(), sums.data());
  fits_ = clamp_all(sums.first(body_count())) && fits && fits_;
}

// How D changes along the step at hand, at first.
PhaseSolver::Slope PhaseSolver::slope() const {
  Slope result;
  for (const Problem& problem : island_.problems) {
    LKS_ASSERT(problem.points <= problem.rows && problem.rows <= lanes::k_most_rows);
    for (std::size_t i = 0; i < problem.rows; ++i) {
      const std::int64_t change = problem.next[i] - problem.impulse[i];
      result.changes += magnitude(change);
      result.sum.add(within_units(change), problem.residual[i]);
    }
  }
  return result;
}

// The part of the step at which D is least.
std::int64_t PhaseSolver::search(const ProductSum& slope) const {
  ProductSum curve;
  LKS_ASSERT(!is_solved_);
  for (const Problem& problem : island_.problems) {
    for (std::size_t i = 0; i < problem.rows; ++i) {
      const std::int64_t change = within_units(problem.next[i] - problem.impulse[i]);
      LKS_ASSERT(problem.give[i] >= 0);
      curve.add(problem.give[i] * change, change);
    }
  }
  add_curve(std::int64_t{1} << lanes::k_residual_point, curve);
  return dual_part(slope, curve);
}

// Goes a part of the step at hand, Q30. Lanes without a row have no impulses.
void PhaseSolver::go(std::int64_t part) {
  LKS_ASSERT(part > 0 && part <= k_whole);
  const auto of_part = [part](std::int64_t x) { return raw::round_shift(x * part, 30); };
  const std::span<BodyVector> velocities = island_.velocities.first(body_count());
  if (part == k_whole) {
    for (Problem& problem : island_.problems)
      problem.impulse = problem.next;
    for (std::size_t k = 0; k < velocities.size(); ++k)
      for (std::size_t i = 0; i < lanes::k_body_words; ++i)
        velocities[k][i] += island_.changes[k][i];
  } else {
    for (Problem& problem : island_.problems)
      for (std::size_t i = 0; i < problem.rows; ++i)
        problem.impulse[i] += of_part(problem.next[i] - problem.impulse[i]);
    for (std::size_t k = 0; k < velocities.size(); ++k)
      for (std::size_t i = 0; i < lanes::k_body_words; ++i)
        velocities[k][i] += of_part(island_.changes[k][i]);
  }
  fits_ = clamp_all(velocities) && fits_;
}

// Solves for the active rows, and again for those that the solution leaves active, as long as fewer
// and fewer change. Returns how many solves this took; 0 where there are no impulses to go to.
int PhaseSolver::propose(int most_solves) {
  find_residuals();
  const std::span<Problem> problems = island_.problems;
  std::size_t most_changed = 1 + problems.size() / k_changing_part;
  for (int solves = 1;; ++solves) {
    if (!island_.state.is_factored) factor();
    while (!solve_for_changes()) {
      drop_ += k_more_drop;
      if (drop_ > k_most_drop) return 0;
    }
    // Islands with joints solve once, and keep the friction that their passes found.
    const bool follows = island_.joints.empty();
    const lanes::Proposal proposal = lanes::proximal_kernels().propose(
        problems.data(), problems.size(), drop_, follows, island_.changes.data());
    is_solved_ = proposal.is_solved;
    fits_ = fits_ && proposal.fits;
    if (is_solved_ || !fits_ || solves >= most_solves || proposal.changed > most_changed)
      return solves;
    if (proposal.changed != 0) {
      for (Problem& problem : problems)
        problem.active = problem.next_active;
      island_.state.is_factored = false;
    }
    most_changed = proposal.changed / 2;
    drop_ = std::max(drop_, drop_of(proposal.bits));
    LKS_ASSERT(drop_ <= k_most_drop);
  }
}

// Goes towards the solution of the phase, as far as it is known and D falls. Returns whether it
// goes anywhere.
bool PhaseSolver::direct_step(int most_solves) {
  const int solves = propose(most_solves);
  if (solves == 0) return false;
  if (is_solved_) {
    sum_changes();
    go(k_whole);
    // The first of several solves read great residuals, and so the last one is rounded coarsely.
    return solves == 1 || direct_step(1);
  }
  const Slope along = slope();
  if (along.rises()) return false;
  sum_changes();
  const std::int64_t part = search(along.sum);
  if (part == 0) return false;
  go(part);
  return true;
}

// In the units at hand. Returns false where they are too fine.
bool PhaseSolver::converge(bool scales) {
  fits_ = true;
  const std::span<Problem> problems = island_.problems;
  LKS_ASSERT(!problems.empty());
  lanes::proximal_kernels().begin_phase(problems.data(), problems.size(),
                                        k_row_unit_bits - island_.state.bits, island_.state.loose);
  std::ranges::fill(island_.velocities, BodyVector{});
  if (scales) scale_warm_start();
  iterate();
  const int centres = island_.joints.empty() ? k_most_centres : 0;
  for (int i = 0; i < centres && fits_ && move_centres(); ++i)
    iterate();
  if (!scales && !is_solved_ && island_.joints.empty()) scale_down();
  return fits_;
}

// Where rows give by more than a centimetre a second, for a load that nobody knew, the last
// impulses become their centres. Returns whether any did.
bool PhaseSolver::move_centres() {
  constexpr std::int64_t k_most_give = 100;  // tolerances
  bool moves = false;
  for (Problem& problem : island_.problems) {
    for (std::size_t i = 0; i < problem.points && !moves; ++i) {
      LKS_ASSERT(problem.give[i] >= 0 && problem.tolerance[i] >= 0);
      const std::int64_t give = problem.give[i] * (problem.impulse[i] - problem.centre[i]);
      moves =
          raw::round_shift(give, 30) > k_most_give * (problem.tolerance[i] >> island_.state.loose);
    }
  }
  LKS_ASSERT(!moves || island_.joints.empty());
  if (moves)
    for (Problem& problem : island_.problems)
      problem.centre = problem.impulse;
  return moves;
}

// Until no row changes, or the steps are used up. After one that goes nowhere the next would hardly
// go farther.
void PhaseSolver::iterate() {
  LKS_ASSERT(!island_.state.is_factored || island_.state.was_factored);
  // Resting bodies are solved by the factor at hand: passes alone would leave them creeping.
  mark_active();
  is_solved_ = false;
  const Effort& effort = island_.joints.empty() ? k_of_contacts : k_with_joints;
  const int long_solves = island_.state.stir == 0 ? effort.solves : 1;
  if (island_.state.is_factored || !island_.state.was_factored) (void)direct_step(long_solves);
  is_done_ = is_solved_;
  bool is_last = false;
  for (int step = 0; !is_done_ && fits_; ++step) {
    for (int i = 0; i < (step == 0 ? effort.first_passes : effort.passes) && !is_done_; ++i)
      is_done_ = pass();
    if (is_last || is_done_) break;
    mark_active();
    const int most_solves = step + 1 < k_long_steps ? long_solves : 1;
    is_last = !direct_step(most_solves) || step + 1 == effort.direct_steps;
    is_done_ = is_solved_;
  }
}

}  // namespace lockstone
