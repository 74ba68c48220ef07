// Ball joints laid out for vectors: eight in a block, a word a lane.
//
// A ball joint holds a point of B to a point of A. With the lever arms r̄ = r/s, w = M·L and the
// other quantities of manifold_block.h:
//   u = vB − vA + wB × r̄B − wA × r̄A                         rounded once
//   P' = P − K⁻¹·u, K = 1 + αA·r̄A×·M·r̄A×ᵀ + αB·r̄B×·M·r̄B×ᵀ
//   vB += αB·(P' − P), vA −= αA·(P' − P), LB += αB·r̄B × (P' − P), LA −= αA·r̄A × (P' − P)
// Impulses are the pair's velocity jump along the axes of the world.
//
// Before positions move, `solve_positions` closes a part of the openings by impulses Q' = Q −
// K⁻¹·(u + bias), which are taken back afterwards: they are not to be given again in every later
// substep. Of P an eighth is forgotten each substep, about as much as by Box3D's soft joints; a
// loop whose joints keep all of it shakes itself to pieces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/kernels/contact/manifold_block.h"

namespace lockstone::lanes {

/// Where a body is, as ball joints read it: its position (m, Q32), then the nine entries of its
/// rotation, column by column, two in a word: `pack(low, high)`, Q30.
struct alignas(64) BodyPlace {
  std::array<std::int64_t, 8> words{};

  friend bool operator==(const BodyPlace&, const BodyPlace&) = default;
};

/// Openings are closed no faster than this, m/s, Q20.
inline constexpr std::int64_t k_most_closing = std::int64_t{4} << 20;

/// A flag above the exponent of B's scale, set in a lane that is not plain. A joint is plain if its
/// bodies turn alike about all axes, M = m·1 with 0 ≤ m ≤ 1 and m the same for the whole tick.
inline constexpr std::int64_t k_special_balls = INT64_MIN;

/// Eight ball joints that share no body, save one that nothing moves (share and inertia zero). A
/// lane without a joint is zero but for `share`.
struct alignas(64) BallBlock {
  std::array<std::uint32_t, k_block_lanes> body_a{};  // body_velocity_offset of its index
  std::array<std::uint32_t, k_block_lanes> body_b{};

  // Fixed for a tick.
  BlockWord
      anchor[3]{};     // low: of A, high: of B, in body axes; m, Q20, ≤ s of a body that can turn
  BlockWord scale{};   // low: 20 + exponent of A's scale, high: of B's, 1 … 32, | k_special_balls
  BlockWord factor{};  // 2^(12 − pair's exponent + body's), 1 … 2^12; low: of A, high: of B
  BlockWord share{};   // low: αB, Q30, high: shift, 16 … 28

  // Recomputed when the bodies have moved.
  BlockWord inertia[6]{};   // low: M of A, high: of B; xx, yy, zz, xy, xz, yz, Q(shift)
  BlockWord arm[3]{};       // low: r̄A, high: r̄B, Q30
  BlockWord gain_arm[3]{};  // the same times α
  BlockWord mass[3]{};      // K⁻¹: (xx, yy) (zz, xy) (xz, yz), Q30
  BlockWord bias[2]{};      // speed that closes ¼ of the opening in a substep: (x, y) (z, 0), Q20

  BlockWord impulse[2]{};           // P: (x, y) (z, 0), within ±k_most_impulse; m/s, Q20
  BlockWord position_impulse[2]{};  // Q, alike

  friend bool operator==(const BallBlock&, const BallBlock&) = default;
};

/// The kernels, as one target computes them. Blocks are to name bodies as those of
/// `ManifoldKernels` do.
struct BallKernels {
  /// Computes the rows from the joints' present places, and adds the velocities that their impulses
  /// give the bodies to `warm`.
  void (*begin)(BallBlock* blocks, std::size_t count, const BodyPlace* places,
                const BodyInertia* inertias, BodyVelocity* warm, std::int32_t substep_rate);

  /// An iteration that closes openings.
  void (*solve_positions)(BodyVelocity* bodies, BallBlock* blocks, std::size_t count);

  /// Computes the rows again after bodies have moved. Takes the position impulses back, and keeps
  /// seven eighths of the impulses as the warm start of the next substep. `before` gains the
  /// velocities that the old impulses gave along the old arms, less those that the kept ones give
  /// along the new arms: a substep starts with twice the velocities less `before`. Then comes an
  /// iteration that keeps openings as they are.
  void (*update)(BodyVelocity* bodies, BodyVelocity* before, BallBlock* blocks, std::size_t count,
                 const BodyPlace* places, const BodyInertia* inertias, std::int32_t substep_rate);
};

/// Those of the target in force, or of narrower vectors that hold this many balls at once.
[[nodiscard]] const BallKernels& ball_kernels(std::size_t balls);

/// The scalar twins, which define the results.
extern const BallKernels k_scalar_balls;

}  // namespace lockstone::lanes
