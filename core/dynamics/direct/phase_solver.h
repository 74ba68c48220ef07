// Finds the impulses of one phase of an island: the warm start, passes over its rows, and direct
// steps by its factor.
//
// A phase finds impulses λ and velocities v = v* + M⁻¹Jᵀλ such that J·v + b + γ(λ − c) = 0 for
// every row that is neither separating nor sliding, with λ ≥ 0 along normals and friction within
// its limit: the least of D(λ) = |M⁻¹Jᵀλ|²/2 + λ·(J·v* + b) + Σ γ(λ − c)²/2 over those λ. Passes of
// projected Gauss-Seidel find which rows those are, the active ones; direct steps solve for them by
// a factor of 1 + JᵀJ/γ. Where the solution makes a row pull, close, stick or slide, other rows are
// active, and the first two steps of a phase solve again, as long as fewer and fewer rows change.
// A step goes towards the last solution only as far as D falls. The compliance γ is small, and the
// centre c, the last substep's impulse less a bounded leak, carries the load: the solution is that
// of rigid contacts but for a damping of the order of γ.
//
// Sources: J. Carpentier, R. Budhiraja, N. Mansard, "Proximal and sparse resolution of constrained
// dynamic equations", 2021 (the proximal problem); M. Hintermüller, K. Ito, K. Kunisch, "The
// primal-dual active set strategy as a semismooth Newton method", 2002 (solving again);
// docs/notes/solver-choice.md (the leak, and the comparison of solvers). Kinetic energy after the
// warm start, and after a phase that pushes no overlap out, is at most that of the free motion,
// since impulses are scaled to the least of it.
#pragma once

#include <cstdint>

#include "core/dynamics/direct/island_pool.h"
#include "core/dynamics/problem/body_factor.h"
#include "core/math/product_sum.h"

namespace lockstone {

class PhaseSolver {
 public:
  /// For one phase, whose kept quantities are set.
  PhaseSolver(const IslandView& island, BodyFactor& factor) : island_(island), factor_(factor) {}

  /// Chooses the phase's units. Returns false where nothing moves or pushes.
  [[nodiscard]] bool set_units();

  /// Finds the impulses; `scales`: the phase begins with the last ones, scaled. Units that turn out
  /// too fine become coarser.
  void solve(bool scales);

  /// Whether it did: direct steps or passes came to an end before they were used up.
  [[nodiscard]] bool is_done() const { return is_done_; }

 private:
  struct Slope {
    ProductSum sum;
    std::uint64_t changes = 0;  // the sum of their magnitudes

    /// Whether the step goes nowhere, because D does not fall. Changes of velocities need not be
    /// summed then: they fit, since no entry of a row is above 1.
    [[nodiscard]] bool rises() const {
      return changes < lanes::k_most_unit / 2 && sum.rounded(1) >= 0;
    }
  };

  [[nodiscard]] bool converge(bool scales);
  void scale_warm_start();
  void iterate();
  [[nodiscard]] bool move_centres();
  void scale_down();
  void go_to_least_energy(const ProductSum& slope, std::int64_t scale);
  void add_curve(std::int64_t scale, ProductSum& curve) const;
  [[nodiscard]] bool pass();
  void mark_active();
  void factor();
  [[nodiscard]] bool direct_step(int most_solves);
  [[nodiscard]] int propose(int most_solves);
  void find_residuals();
  [[nodiscard]] bool solve_for_changes();
  void sum_changes();
  [[nodiscard]] Slope slope() const;
  [[nodiscard]] std::int64_t search(const ProductSum& slope) const;
  void go(std::int64_t part);

  [[nodiscard]] std::size_t body_count() const { return island_.bodies.size(); }

  const IslandView& island_;
  BodyFactor& factor_;
  int drop_ = 0;            // bits of residuals that the direct step at hand leaves out
  bool fits_ = true;        // so far nothing had to be clamped in these units
  bool is_solved_ = false;  // by the last direct step
  bool is_done_ = false;
};

}  // namespace lockstone
