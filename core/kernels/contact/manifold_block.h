// Contact constraints laid out for vectors: eight manifolds in a block, a word a lane.
//
// A manifold is solved at its centre c, in its own axes: normal n and tangents t, b = n × t. Six
// numbers give the relative motion of its two bodies,
//   u = vB − vA + ωB × rB − ωA × rA  along n, t, b,   Ω = ℓ·(ωB − ωA)  along n, t, b,
// with ℓ = 2^k m a length of the size of the smaller body, and the impulses of its points add up to
// six components. Point i at the offset ℓ·(x t + y b) from the centre moves apart at
//   vᵢ = u_n + y·Ω_t − x·Ω_b,
// and an impulse P there is P along n, with torques P·y about t and −P·x about b.
//
// Bodies are written in normalised quantities (core/dynamics/state/body_record.h): w = M·L is the
// surface speed ω·s, r̄ = r/s a lever arm, s = 2^exponent m. Impulses are the pair's velocity jump,
// so B gains αB·J and A loses J − αB·J of velocity; both gain α·r̄ × J of spin.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "core/kernels/contact/contact_rows.h"

namespace lockstone::lanes {

inline constexpr std::size_t k_block_points = 4;

/// Fraction bits of the velocities that impulses leave: the words of a BodyVelocity are multiples
/// of 2^-32 m/s, so that bodies of equal mass gain and lose exactly the same.
inline constexpr int k_grid_bits = 32;

/// The greatest impulse of a point: 2^30 − 1 in Q20, 1024 m/s. Two of them make an operand.
inline constexpr std::int32_t k_most_impulse = 0x3fffffff;

/// A flag above the shift, set in a lane that is not plain. A manifold is plain if both bodies turn
/// alike about all axes (M = m·1), the surfaces neither move nor resist rolling, and no lock of an
/// axis takes a push. Most are plain, and an iteration reads and computes less for them.
inline constexpr std::int32_t k_special_lane = 1 << 8;

/// A flag above the number of clamped arms, set where surfaces meet at the tick's beginning.
inline constexpr std::int32_t k_touching_lane = 1 << 8;

/// Eight manifolds that share no body, save one that nothing moves (zero gains). `pack(low, high)`
/// holds two operands. `shift` is 16 … 28, and Q(shift) is the format of quantities that grow with
/// the inverse inertia. In a lane without a manifold `used` is 0, and the rest is meaningless. Of
/// points beyond a manifold's count the impulse and the mass are 0, and the rest is meaningless.
struct alignas(64) ManifoldBlock {
  std::array<std::uint32_t, k_block_lanes> body_a{};  // body_velocity_offset of its index
  std::array<std::uint32_t, k_block_lanes> body_b{};

  // Read by every iteration, in this order: the processor prefetches words read in memory order.
  BlockWord axes[5]{};  // (n.x, n.y) (n.z, t.x) (t.y, t.z) (b.x, b.y), Q30; (b.z, shift | kind)
  BlockWord moment{};   // low: M_xx of A, high: of B; Q(shift)
  BlockWord arm[3]{};   // low: r̄A, high: r̄B of the centre, Q30
  BlockWord scale{};    // low: ℓ/sA, high: ℓ/sB, at most 1, Q30
  struct Point {
    BlockWord offset{};      // low: x, high: y; Q30
    BlockWord impulse{};     // low: P ≥ 0, high: the greatest P so far; m/s, Q20
    BlockWord separation{};  // low: at the tick's beginning, high: now; m, Q24

    friend bool operator==(const Point&, const Point&) = default;
  };
  Point points[k_block_points];
  // Read by iterations without friction.
  BlockWord soft{};  // low: bias rate, 1/s, Q20; high: share κ of P that a soft row keeps, Q30
  BlockWord mean_part{};  // (1 − κ)·mean impulse, which a soft row adds; m/s, Q50

  BlockWord mass_01{}, mass_23{};  // 1 / (the response of each point to itself), Q30; 0: no point
  BlockWord used{};                // a bit for each point; 0 in a lane without a manifold
  // Responses: the speed at one point that a unit impulse at another gives, Q(shift).
  BlockWord response_01_23{}, response_02_13{}, response_03_12{};
  BlockWord gain_arm[3]{};  // the arms times α
  BlockWord gain_turn{};    // the scales times α
  BlockWord share{};        // low: αB, Q30, high: coefficient of friction, Q30

  // Read by iterations with friction. Rows t, b and the twist about n at the radius ρ.
  // Low: of t, high: of b, to impulses (1, x, y), Q(shift); those to x and y of one point are
  // meaningless.
  BlockWord coupling[3]{};
  BlockWord tangent_mass[2]{};  // (tt, bb), (tb, 0) of the inverse of the tangents' response, Q30
  BlockWord twist_row[2]{};     // of the twist: to (1, x), Q(shift); to y, and its mass, Q24
  BlockWord twist_response{};   // low: of t, high: of b, to a twist impulse, Q(shift)
  BlockWord friction{};         // low: impulse along t, high: along b; m/s, Q20
  BlockWord twist{};            // low: twist impulse, m/s, Q20; high: ρ/ℓ, Q30

  // From here on: neither written nor read where all of a vector's lanes are plain.
  BlockWord inertia[5]{};  // the rest of M: yy, zz, xy, xz, yz
  BlockWord drive{};       // speed of moving surfaces: low: along t, high: b; m/s, Q20
  BlockWord turn{};        // low: the same about n, as ℓ·ω; high: rolling limit / ΣP, Q28
  // Read where the rolling limit is not 0: torques about t and b, divided by ℓ.
  BlockWord rolling{};          // low: impulse about t, high: about b; m/s, Q20
  BlockWord rolling_mass[2]{};  // (tt, bb), (tb, 0) of the inverse of their response, Q24

  [[nodiscard]] int shift(std::size_t lane) const {
    return static_cast<int>(axes[4][lane] >> 32 & (k_special_lane - 1));
  }
  [[nodiscard]] bool is_plain(std::size_t lane) const {
    return (axes[4][lane] >> 32 & k_special_lane) == 0;
  }

  friend bool operator==(const ManifoldBlock&, const ManifoldBlock&) = default;
};

/// A manifold as geometry keeps it (core/geometry/distance/manifold.h), read where it is: the
/// normal, Q30, and a word that is not read; of each point the anchors on A and on B, m, Q20, its
/// separation, m, Q24, and a word that is not read. Points beyond the count are not read either.
using ManifoldGeometry = std::array<std::int32_t, 4 + 8 * k_block_points>;

/// The other inputs of a manifold's preparation, in groups of 16 bytes.
struct alignas(16) PrepareInput {
  std::array<std::int32_t, 3> friction{};  // impulse of the tick before in world axes, m/s, Q20
  std::int32_t twist = 0;                  // m/s, Q20
  // Of points the impulse of the tick before, 0 … k_most_impulse, m/s, Q20; zero beyond the count.
  std::array<std::int32_t, k_block_points> impulses{};
  std::int32_t share_b = 1 << 30;         // αB, Q30
  std::int32_t coefficient = 0;           // of friction, Q30
  std::int32_t scale_a = 0, scale_b = 0;  // ℓ/s, Q30
  std::int32_t bias_rate = 0;             // as in ManifoldBlock::soft
  std::int32_t keep = 1 << 30;
  std::int32_t mean_impulse = 0;              // m/s, Q20
  std::int32_t count = 0;                     // of points
  std::int32_t inertia_a = 1, inertia_b = 1;  // 2^(12 − pair's exponent + body's), 1 … 2^12
  std::int32_t inverse_scale_a = 0, inverse_scale_b = 0;  // 2^11/s, 1 … 2^18; 0: cannot turn
  std::int32_t offset_shift = 20;                         // 20 + k: 13 … 31
  std::int32_t shift = 28;
  std::int32_t one_over_count = 0;        // Q30; 0 without a manifold
  std::int32_t kind = 0;                  // k_special_lane unless plain
  std::array<std::int32_t, 3> rolling{};  // of the tick before in world axes, m/s, Q20
  std::int32_t rolling_limit = 0;         // as in ManifoldBlock::turn; without one `rolling` is 0
  std::array<std::int32_t, 3> drive{};    // as in ManifoldBlock, in world axes
  std::int32_t twist_drive = 0;
  std::array<std::int32_t, 3> locked{};  // by world axis: how much of a push axis locks take, Q30
  std::int32_t is_elastic = 0;           // 1 with restitution
};
static_assert(sizeof(PrepareInput) == 144);

/// The inertia of a body for preparation: M = entry · 2^-30 · 2^exponent. The pair gives the
/// exponent.
struct alignas(32) BodyInertia {
  std::array<std::int32_t, 6> inertia{};  // xx, yy, zz, xy, xz, yz
  std::array<std::int32_t, 2> unused{};
};

/// The manifolds of a block.
struct PrepareInputs {
  std::array<std::uint32_t, k_block_lanes> body_a{}, body_b{};  // body_velocity_offset of the index
  std::array<const std::int32_t*, k_block_lanes> geometry{};    // first words of ManifoldGeometry
  std::array<PrepareInput, k_block_lanes> lanes{};
};

/// How a manifold's points come in: relative normal velocities before the solver, m/s, Q20.
struct alignas(64) ManifoldApproach {
  // low: the greatest speed of a point that comes in, or 0; high: lever arms that were clamped, and
  // k_touching_lane where a point touches.
  BlockWord summary{};
  // Of each point, positive when it leaves. Not written where all of a vector's lanes are without
  // restitution.
  BlockWord speed[k_block_points]{};

  [[nodiscard]] std::int32_t fastest(std::size_t lane) const {
    return static_cast<std::int32_t>(summary[lane]);
  }
  [[nodiscard]] std::uint32_t clamped(std::size_t lane) const {
    return static_cast<std::uint32_t>(summary[lane] >> 32 & (k_touching_lane - 1));
  }
  [[nodiscard]] bool touches(std::size_t lane) const {
    return (summary[lane] >> 32 & k_touching_lane) != 0;
  }

  friend bool operator==(const ManifoldApproach&, const ManifoldApproach&) = default;
};

/// The travel of a body since the tick began, as the sum of its `BodyVelocity` at the end of each
/// substep: velocity and surface velocity, m/s, Q32.
struct alignas(64) DeltaPose {
  std::array<std::int64_t, 3> velocity{};
  std::array<std::int64_t, 3> surface{};
  std::array<std::int64_t, 2> unused{};

  friend bool operator==(const DeltaPose&, const DeltaPose&) = default;
};

/// Constants of an iteration.
struct SolverParams {
  std::int32_t substep_rate = 240;  // 1/s
  std::int32_t push_out = 0;        // overlap goes at most this fast, m/s, Q20
  std::int32_t contact_slop = 0;    // nearer points count as touching, m, Q24
  std::int32_t overlap = 0;         // where touching points come to rest, m, Q24
  std::int32_t step_mantissa = 0;   // substep = mantissa · 2^-(24 − 17 + step_shift)
  std::int32_t step_shift = 32;     // 1 … 32
  // Added before rounding to nearest, Q30, −½ … ½: to the limit of friction, and to the components
  // of an impulse that is shortened to it.
  std::int32_t limit_dither = 0;
  std::int32_t part_dither = 0;
};

/// The iterations over manifolds, as one target computes them. No body may occur twice in a block,
/// nor in two blocks of a call to `solve`, `relax` or `bounce`. The scalar twin goes lane by lane,
/// and allows both.
struct ManifoldKernels {
  /// Fills a block. The impulses to start from are added to `warm`, by body; `bodies` tells the
  /// approach.
  void (*prepare)(const PrepareInputs& sources, const BodyInertia* inertias,
                  const BodyVelocity* bodies, BodyVelocity* warm, ManifoldBlock& block,
                  ManifoldApproach& approach);

  /// An iteration that pushes overlap out, by soft rows: normals only, at the separations that the
  /// last `relax` saw.
  void (*solve)(BodyVelocity* bodies, ManifoldBlock* blocks, std::size_t count,
                const SolverParams& rules);

  /// An iteration without bias, with friction. Separations are brought up to date first.
  void (*relax)(BodyVelocity* bodies, const DeltaPose* travel, ManifoldBlock* blocks,
                std::size_t count, const SolverParams& rules);

  /// Points that came in faster than `threshold` (m/s, Q20) and were pushed leave at restitution
  /// (Q30, by lane) times that.
  void (*bounce)(BodyVelocity* bodies, ManifoldBlock& block, const ManifoldApproach& approach,
                 const BlockWord& restitution, std::int32_t threshold);
};

/// Those of the target in force, or of narrower vectors that hold this many manifolds at once:
/// where there are few, these take less time.
[[nodiscard]] const ManifoldKernels& manifold_kernels(std::size_t manifolds);

/// The scalar twins, which define the results.
extern const ManifoldKernels k_scalar_manifolds;

/// Brings the separations of one manifold up to date, as `relax` does first.
void move_separations(const DeltaPose* travel, ManifoldBlock& block, std::size_t lane,
                      const SolverParams& rules);

}  // namespace lockstone::lanes
