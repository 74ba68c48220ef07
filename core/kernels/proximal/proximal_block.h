// The proximal problem of an island, laid out for vectors, and the kernels of its phases.
//
// A contact's rows lie side by side: lane r of a word is row r. There are up to four normal rows,
// then two of friction, then the twist; lanes without a row are 0. A body's six unknowns lie in
// lanes 0 … 5 of a word, and so do the rows of a 6 × 6 block of the matrix. Quantities of a phase
// are integers in its own units, within ±k_most_unit, so that a row's sums of products fit in 64
// bits. The method: core/dynamics/direct/phase_solver.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/kernels/contact/contact_rows.h"

namespace lockstone::lanes {

inline constexpr std::size_t k_most_rows = 7, k_body_words = 6;

/// Quantities of a phase lie within ±this.
inline constexpr std::int64_t k_most_unit = (std::int64_t{1} << 30) - 1;

/// Residuals have this many bits after the units' point: they are exact.
inline constexpr int k_residual_point = 30;

/// A matrix weight is 2^-k_weight_point / γ.
inline constexpr int k_weight_point = 14;

/// Fraction bits of friction's limits and of the twist's ratio.
inline constexpr int k_friction_point = 20;

/// A contact of the problem, or a joint: normal rows for its limits, then its locks. Words that end
/// a sentence with Qn have n fraction bits; those of the phase are in its units; kept ones are in
/// units of their rows, Q44.
struct alignas(64) ProximalBlock {
  BlockWord sides[k_body_words]{};    // by component; low: of A, high: of B, Q30
  BlockWord by_row[k_most_rows]{};    // the same by row, components in lanes
  BlockWord coupling[k_most_rows]{};  // by row r: J_r·J_i, and 1 + γ at itself, Q30
  BlockWord give{};                   // γ, Q30
  BlockWord own_part{};               // 1 / (1 + γ), Q30
  BlockWord weight{};                 // 2^-14 / γ, Q30
  BlockWord normal{};                 // all bits in lanes of normal rows
  BlockWord active{};                 // all bits in lanes that the matrix has

  BlockWord speed{};        // of the phase: with the bias, as it began
  BlockWord impulse{};      // of the phase
  BlockWord start{};        // impulse as the phase began
  BlockWord centre{};       // of the phase: the impulse that the compliance pulls towards
  BlockWord tolerance{};    // of the phase: a lesser change is none
  BlockWord residual{};     // as the direct step at hand began, k_residual_point bits more
  BlockWord next{};         // impulse that the direct step proposes
  BlockWord next_active{};  // all bits in lanes that are active at these impulses

  BlockWord warm{};          // kept: impulse as the tick before ended; 0 after the first phase
  BlockWord held{};          // kept: impulse
  BlockWord held_centre{};   // kept: centre
  BlockWord moving{};        // kept: speed
  BlockWord moved{};         // kept: speed as the substep began
  BlockWord bias{};          // kept
  BlockWord least_change{};  // kept: of speed

  std::array<std::int32_t, 4> limits{};  // friction's, of a normal's, Q20
  std::int32_t twist_ratio = 0;          // of the twist's unit in a tangent's, Q20
  std::uint32_t points = 0;              // normal rows
  std::uint32_t rows = 0;                // all of them
  std::uint32_t a = 0, b = 0;            // bodies in the island
  bool slides = false;                   // friction's last pass wanted more than its limit
  bool has_locks = false;                // a joint: its other rows may pull, without a limit

  [[nodiscard]] bool has_friction() const { return limits[0] != 0; }

  friend bool operator==(const ProximalBlock&, const ProximalBlock&) = default;
};

/// A 6 × 6 block G. While sums are gathered word k holds column k. Once factored its lane i holds
/// pack(G[i][k], G[k][i]), Q30.
struct alignas(64) BodyBlock {
  BlockWord words[k_body_words]{};

  friend bool operator==(const BodyBlock&, const BodyBlock&) = default;
};

/// A block under the diagonal of a column: its row, and where it stands.
struct BelowDiagonal {
  std::uint32_t row = 0;
  std::uint32_t block = 0;
};

/// A column of the factor: the reciprocals of its pivots are mantissa · 2^-shift.
struct FactorColumn {
  std::uint32_t body = 0;
  int scale = 0;                       // bits that its body's rows are scaled by
  std::uint32_t first = 0, count = 0;  // of the blocks below
  std::array<std::int32_t, k_body_words> mantissas{};
  std::array<std::int32_t, k_body_words> shifts{};
};

/// The result of a pass.
struct PassResult {
  bool done = false;  // no change as great as the tolerance
  bool fits = true;   // nothing had to be clamped

  friend bool operator==(const PassResult&, const PassResult&) = default;
};

/// The result of one solve of a direct step.
struct Proposal {
  bool is_solved = false;     // the proposed impulses are the solution of the phase
  bool fits = true;           // nothing had to be clamped
  std::uint32_t changed = 0;  // normal rows, and frictions of contacts, that became active or idle
  std::uint64_t bits = 0;     // of all magnitudes that another solve reads besides

  friend bool operator==(const Proposal&, const Proposal&) = default;
};

/// Where the blocks of a contact's bodies are in the matrix; null for bodies that nothing moves.
struct MatrixPlaces {
  BodyBlock* a = nullptr;
  BodyBlock* b = nullptr;
  BodyBlock* both = nullptr;
  bool a_is_row = false;
};

struct ProximalKernels {
  /// The bits of all magnitudes that a phase begins with, kept.
  std::uint64_t (*magnitudes)(const ProximalBlock* blocks, std::size_t count);
  /// Sets the phase's words from the kept ones, `down` ≥ 1 bits coarser; a change is none below
  /// 2^loose of its least.
  void (*begin_phase)(ProximalBlock* blocks, std::size_t count, int down, int loose);
  /// One pass of projected Gauss-Seidel; bodies are the changes of velocity in the phase.
  PassResult (*pass)(ProximalBlock* blocks, std::size_t count, BlockWord* bodies);
  /// Residuals of all rows; the impulses are the proposed ones. Returns the bits of all magnitudes
  /// that a direct step reads.
  std::uint64_t (*find_residuals)(ProximalBlock* blocks, std::size_t count,
                                  const BlockWord* bodies);
  /// Adds Jᵀ·x: −r·weight of the active rows, residuals without their last `drop` bits, and of the
  /// idle ones their next changes of impulse, next − impulse, in the same unit; |x| ≤ 2^30.
  void (*add_right_sides)(const ProximalBlock* blocks, std::size_t count, int drop,
                          BlockWord* sums);
  /// Sets the next impulses to those at the solution, as far as they are allowed, and which rows
  /// are active next. A row that would pull becomes idle, without impulse, and one that closes
  /// becomes active. Friction of a contact becomes idle beyond its limit. While it is idle it
  /// slides: if it `follows`, it goes a step of a pass, to its limit at most, and becomes active
  /// within it; otherwise nothing is solved.
  Proposal (*propose)(ProximalBlock* blocks, std::size_t count, int drop, bool follows,
                      const BlockWord* changes);
  /// Adds Jᵀ·(next − impulse). Returns whether these fit.
  bool (*add_changes)(const ProximalBlock* blocks, std::size_t count, BlockWord* sums);
  /// Adds J·u · 2^-shift to kept speeds; −16 ≤ shift ≤ 62.
  void (*update_residuals)(ProximalBlock* blocks, std::size_t count, const BlockWord* bodies,
                           int shift);
  /// Sets the coupling of the rows.
  void (*couple)(ProximalBlock& block);
  /// Adds Σ weight·Jᵀ·J of the active rows to sums, Q50.
  void (*add_to_matrix)(const ProximalBlock& block, const MatrixPlaces& places);
  /// Adds Σ Jᵀ·J of rows to sums, Q50. `rows` has a word each, components in lanes; low: of A,
  /// high: of B, Q30; lanes 6 and 7 are not read. A bit of `used` stands for each row that counts.
  void (*add_rows)(const BlockWord* rows, std::uint32_t used, const MatrixPlaces& places);
  /// Subtracts Jᵀ·x of such rows from both bodies, rounded once; |x| ≤ 2^28.
  void (*subtract_rows)(const BlockWord* rows, std::uint32_t used, const std::int64_t* x,
                        BlockWord& a, BlockWord& b);
  /// J·u of such rows, Q30, by row; others are left alone.
  void (*row_products)(const BlockWord* rows, std::uint32_t used, const BlockWord& a,
                       const BlockWord& b, std::int64_t* products);
  /// Computes the blocks under a factored diagonal, and takes their products from the blocks to
  /// their right.
  void (*eliminate)(BodyBlock* blocks, const FactorColumn& column, const BodyBlock& diagonal,
                    const BelowDiagonal* below, const std::uint32_t* targets);
  /// Takes the products of a column's blocks and x from the rows below. Returns whether they fit.
  bool (*solve_down)(const BodyBlock* blocks, const FactorColumn& column,
                     const BelowDiagonal* below, const BlockWord& x, BlockWord* rows);
  /// Adds the products of the transposed blocks and the rows below.
  void (*solve_up)(const BodyBlock* blocks, const FactorColumn& column, const BelowDiagonal* below,
                   const BlockWord* rows, BlockWord& sums);
};

extern const ProximalKernels k_scalar_proximal;

/// The kernels of the target in force.
[[nodiscard]] const ProximalKernels& proximal_kernels();

}  // namespace lockstone::lanes
