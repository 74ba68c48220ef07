// The rows of an island's proximal problem, in the units in which they are solved.
//
// A body's unknowns are u = √(m/m₀)·(v, Cᵀ·spin), where C·Cᵀ is its normalised inverse inertia, so
// that its kinetic energy is m₀·|u|²/2; m₀ is the island's greatest mass of a pair. A row's
// Jacobian is scaled to length 1, but for friction's: both tangents share the scale of the longer
// one. Between one phase and the next a row's impulse is the velocity jump of its pair, λ·(1/mA +
// 1/mB), as everywhere else in the solver.
#pragma once

#include <array>
#include <cstdint>

#include "core/dynamics/body_factor.h"
#include "core/dynamics/joint_rows.h"
#include "core/dynamics/row_geometry.h"
#include "core/dynamics/row_scale.h"

namespace lockstone {

/// The lower triangle C of M = C·Cᵀ: c[i][k], k ≤ i; values are raw · 2^(shift − 30).
struct InertiaRoot {
  std::array<std::array<std::int64_t, 3>, 3> c{};
  int shift = 0;
};

[[nodiscard]] InertiaRoot inertia_root(const InverseInertia& inertia);

/// Four points, two tangents and the twist.
inline constexpr std::size_t k_contact_rows = 7;

struct ProximalRow {
  RowSide a{}, b{};           // Q30; what nothing moves has 0
  std::int32_t give = 0;      // γ, Q30
  std::int32_t own_part = 0;  // 1 / (1 + γ), Q30
  std::int32_t weight = 0;    // 2^-14 / γ, Q30
  bool is_active = false;
  // In units of the phase.
  std::int64_t speed = 0;  // with its bias, as the phase began
  std::int64_t impulse = 0;
  std::int64_t start = 0;      // impulse as the phase began
  std::int64_t centre = 0;     // what the impulse is pulled towards
  std::int64_t residual = 0;   // as of the direct step at hand, with more bits
  std::int64_t next = 0;       // impulse that the direct step proposes
  std::int64_t tolerance = 0;  // a lesser change is none
  // Fixed for a tick.
  RowScale to_speed, to_impulse;
  std::int64_t least_change = 0;  // of speed, in the row's units, as below
  std::int64_t weight_leak = 0;   // most that a normal's centre leaks, alike
  // Between phases, in the row's units with `k_row_unit_bits` bits after the point.
  std::int64_t held = 0;  // impulse
  std::int64_t held_centre = 0;
  std::int64_t moving = 0;  // speed
  std::int64_t moved = 0;   // speed as the substep began
  std::int64_t bias = 0;
  std::int64_t total = 0;  // impulse as the pair's velocity jump, m/s, Q32
};

inline constexpr int k_row_unit_bits = 44;

/// Fraction bits of friction's limits and of the twist's ratio.
inline constexpr int k_limit_bits = 20;

/// A contact of an island.
struct ProximalContact : ContactPair {
  std::uint32_t row_a = 0, row_b = 0;      // where their velocities stand
  std::uint32_t local_a = 0, local_b = 0;  // in the island; its number of bodies: what none moves
  std::uint32_t points = 0;
  std::uint32_t rows = 0;  // points and 2 or 3 of friction
  std::array<ProximalRow, k_contact_rows> all{};
  std::array<std::int32_t, lanes::k_block_points> limits{};  // friction's, of a normal's, Q20
  std::int32_t twist_ratio = 0;  // of the twist's unit in a tangent's, Q20
  std::int64_t radius = 0;       // of the twist, ρ/ℓ, Q30
  RawVec3 normal{}, tangent{}, binormal{};
  std::array<std::int64_t, lanes::k_block_points> x{}, y{};  // offsets, Q30
  // Words of the block that make its iterations idle, as they were.
  std::array<std::int64_t, 8> words{};

  [[nodiscard]] bool has_friction() const { return limits[0] != 0; }
};

/// Quantities of a contact's rows that only preparation reads.
struct PreparedRows {
  std::array<RawVec3, k_contact_rows> response_a{}, response_b{};  // Q30
  std::array<std::int64_t, k_contact_rows> own{};                  // response to itself, Q30
  std::array<RowScale, k_contact_rows> from_impulse{};
};

/// Reads a contact's rows and their scales from its block. `root_a` and `root_b` are those of its
/// bodies, `unit` the island's 1/m₀.
void find_proximal_rows(const ContactRun& run, const InertiaRoot& root_a, const InertiaRoot& root_b,
                        BlockFloat unit, ProximalContact& contact, PreparedRows& prepared);

/// A lock or motor of a joint, as its island's problem has it.
struct ProximalLock {
  RowSide a{}, b{};               // Q30; 0 of what nothing pushes
  RowScale to_speed, to_impulse;  // as ProximalRow's
  bool is_void = false;           // nothing moves along it
  std::int64_t own = 0;           // response to itself, Q30
  std::int64_t impulse = 0;       // the pair's velocity jump, m/s, Q50
};

/// What the rows of a joint have in common.
struct ProximalJoint {
  const InertiaRoot &root_a, &root_b;
  std::int64_t share_a = 0, share_b = 0;  // of the pair's inverse mass, Q30; 0: nothing pushes it
  RowScale mass;                          // √(mass of the pair / m₀)
};

/// √(mass of the pair / m₀), from both inverse masses.
[[nodiscard]] RowScale mass_scale(BlockFloat unit, BlockFloat inverse);

/// Reads a joint's row and its scales.
void find_proximal_lock(const JointRow& row, const ProximalJoint& joint, ProximalLock& lock);

/// How soft the rows are: overloaded contacts, by more than 400 times `weight` (a body's impulse in
/// a substep, m/s, Q32), give less.
void set_gives(std::int64_t weight, const PreparedRows& prepared, ProximalContact& contact);

}  // namespace lockstone
