// Ball joints laid out for vectors: eight in a block, a word a lane.
//
// A ball joint holds a point of B to a point of A. With the lever arms r̄ = r/s, w = M·L and the
// other quantities of manifold_block.h:
//   u = vB − vA + wB × r̄B − wA × r̄A                         rounded once
//   P' = P − K⁻¹·u, K = 1 + αA·r̄A×·M·r̄A×ᵀ + αB·r̄B×·M·r̄B×ᵀ
//   vB += αB·(P' − P), vA −= αA·(P' − P), LB += αB·r̄B × (P' − P), LA −= αA·r̄A × (P' − P)
// Impulses are the pair's velocity jump along the axes of the world.
//
// Before positions move, `lift` closes a part of the openings by impulses Q' = Q − K⁻¹·(u + bias),
// which are taken back afterwards: they are not to be given again in every later substep. Of P an
// eighth is forgotten each substep, about as much as by Box3D's soft joints; a net whose joints
// keep all of it shakes itself to pieces.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "core/math/wide/manifold_block.h"

namespace lockstone::lanes {

/// Where a body is, as ball joints read it: its position (m, Q32), then the nine entries of its
/// rotation, column by column, two in a word: `pack(low, high)`, Q30.
struct alignas(64) BodyPlace {
  std::array<std::int64_t, 8> words{};

  friend bool operator==(const BodyPlace&, const BodyPlace&) = default;
};

/// Anchors are within this of where bodies are, m; positions of two bodies count as no farther
/// apart than 4096 m along an axis, so that all sums of them fit Q50.
inline constexpr int k_most_anchor_m = 1024;

/// Openings are closed no faster than this, m/s, Q20.
inline constexpr std::int64_t k_most_closing = std::int64_t{4} << 20;

/// Eight ball joints that share no body, save one that nothing moves (share and inertia zero). A
/// lane without a joint is zero but for `share`.
struct alignas(64) BallBlock {
  std::array<std::uint32_t, k_block_lanes> body_a{};  // row_body_offset of its index
  std::array<std::uint32_t, k_block_lanes> body_b{};

  // What it is.
  BlockWord
      anchor[3]{};     // low: of A, high: of B, in its own axes; m, Q20, at most s for what turns
  BlockWord scale{};   // low: 20 + exponent of A's scale, high: of B's; 1 … 32
  BlockWord factor{};  // 2^(12 − pair's exponent + body's), 1 … 2^12; low: of A, high: of B
  BlockWord share{};   // low: αB, Q30, high: shift, 16 … 28

  // Where it is.
  BlockWord inertia[6]{};   // low: M of A, high: of B; xx, yy, zz, xy, xz, yz, Q(shift)
  BlockWord arm[3]{};       // low: r̄A, high: r̄B, Q30
  BlockWord gain_arm[3]{};  // the same times α
  BlockWord mass[3]{};      // K⁻¹: (xx, yy) (zz, xy) (xz, yz), Q30
  BlockWord bias[2]{};      // what closes a quarter of the opening in a substep: (x, y) (z, 0), Q20

  BlockWord impulse[2]{};  // P: (x, y) (z, 0), within ±k_most_impulse; m/s, Q20
  BlockWord lift[2]{};     // Q, alike

  friend bool operator==(const BallBlock&, const BallBlock&) = default;
};

/// The kernels, as one target computes them. Blocks are to name bodies as those of
/// `ManifoldKernels` do.
struct BallKernels {
  /// Where the joints are now. What their impulses do to bodies from there is added to `warm`.
  void (*begin)(BallBlock* blocks, std::size_t count, const BodyPlace* places,
                const SourceBody* inertias, RowBody* warm, std::int32_t substep_rate);

  /// A sweep that closes openings.
  void (*lift)(RowBody* bodies, BallBlock* blocks, std::size_t count);

  /// Where they have moved. The lift is taken back; impulses are those that the next substep starts
  /// with, from there. What is forgotten of them, and what they do differently, is added to
  /// `before`: a substep starts with twice the velocities less those. Then as `relax`.
  void (*follow)(RowBody* bodies, RowBody* before, BallBlock* blocks, std::size_t count,
                 const BodyPlace* places, const SourceBody* inertias, std::int32_t substep_rate);

  /// A sweep that keeps openings as they are.
  void (*relax)(RowBody* bodies, BallBlock* blocks, std::size_t count);
};

/// Those of the target in force, or of narrower vectors that hold so many balls at once.
[[nodiscard]] const BallKernels& ball_kernels(std::size_t balls);

/// What they mean.
extern const BallKernels k_scalar_balls;

}  // namespace lockstone::lanes
