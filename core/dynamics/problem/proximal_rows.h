// The rows of an island's proximal problem, in the units in which they are solved.
//
// A body's unknowns are u = √(m/m₀)·(v, Cᵀ·spin), where C·Cᵀ is its normalised inverse inertia, so
// that its kinetic energy is m₀·|u|²/2; m₀ is the mass of the island's heaviest body. A row's
// Jacobian is scaled to length 1, but for friction's: both tangents share the scale of the longer
// one. Between one phase and the next a row's impulse is the velocity jump of its pair, λ·(1/mA +
// 1/mB), as everywhere else in the solver.
#pragma once

#include <array>
#include <cstdint>

#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/contact/row_scale.h"
#include "core/dynamics/joint/joint_rows.h"
#include "core/dynamics/problem/body_factor.h"
#include "core/kernels/proximal/proximal_block.h"

namespace lockstone {

/// The lower triangle C of M = C·Cᵀ: c[i][k], k ≤ i; values are raw · 2^(shift − 30).
struct InertiaRoot {
  std::array<std::array<std::int64_t, 3>, 3> c{};
  int shift = 0;
};

[[nodiscard]] InertiaRoot inertia_root(const InverseInertia& inertia);

/// Four points, two tangents and the twist.
inline constexpr std::size_t k_contact_rows = lanes::k_most_rows;

/// The data of a row for a tick, beside its lane in the problem.
struct ProximalRow {
  RowScale to_speed, to_impulse;
  std::int64_t weight_leak = 0;  // most that a normal's centre leaks, in units of the row
  std::int64_t leak = 0;         // leak of the centre in this substep
  std::int64_t total = 0;        // impulse as the pair's velocity jump, m/s, Q32
  std::int64_t carried = 0;      // of its speed: by kinematic bodies; only with joints
  std::int64_t give = 0;         // γ of a normal that does not overlap deeply, Q30
};

/// Fraction bits of kept quantities in units of their rows.
inline constexpr int k_row_unit_bits = 44;

/// A contact of an island; its rows are the lanes of a `ProximalBlock`.
struct ProximalContact : ContactPair {
  ContactId id;
  std::uint32_t row_a = 0, row_b = 0;  // where their velocities stand
  std::uint32_t points = 0;
  std::uint32_t rows = 0;  // points and 2 or 3 of friction
  bool is_whole = false;   // of an island that is solved whole
  std::array<ProximalRow, k_contact_rows> all{};
  std::int64_t radius = 0;  // of the twist, ρ/ℓ, Q30
  RawVec3 arc{};            // gain of the surfaces' drive from substep to substep, m/s, Q20
  std::array<std::int64_t, 2> bias_gain{};  // the same of the tangents' biases
  RawVec3 normal{}, tangent{}, binormal{};
  std::array<std::int64_t, lanes::k_block_points> x{}, y{};  // offsets, Q30
  // Words of the block that make its iterations idle, as they were.
  std::array<std::int64_t, 7> words{};
};

/// Quantities of a contact's rows that only preparation reads.
struct PreparedRows {
  std::array<RawVec3, k_contact_rows> response_a{}, response_b{};  // Q30
  std::array<std::int64_t, k_contact_rows> own{};                  // response to itself, Q30
  std::array<RowScale, k_contact_rows> from_impulse{};
};

/// Reads a contact's rows and their scales from its manifold. `root_a` and `root_b` are those of
/// its bodies, `unit` the island's 1/m₀.
void find_proximal_rows(const ContactRun& run, const InertiaRoot& root_a, const InertiaRoot& root_b,
                        BlockFloat unit, ProximalContact& contact, lanes::ProximalBlock& problem,
                        PreparedRows& prepared);

/// A lock or motor of a joint, as its island's problem has it.
struct ProximalLock {
  lanes::BlockWord row{};         // low: of A, high: of B, Q30; 0 of a body that nothing pushes
  RowScale to_speed, to_impulse;  // as ProximalRow's
};

/// Data that all rows of a joint share.
struct ProximalJoint {
  const InertiaRoot &root_a, &root_b;
  std::int64_t part_a = 0, part_b = 0;  // `part_of` the shares
  RowScale mass;                        // √(mass of the pair / m₀)
};

/// The root of a body's share of a pair's inverse mass, Q30; 0 where nothing pushes it.
[[nodiscard]] std::int64_t part_of(std::int64_t share);

/// √(mass of the pair / m₀), from both inverse masses.
[[nodiscard]] RowScale mass_scale(BlockFloat unit, BlockFloat inverse);

/// Reads a joint's row and its scales. Returns false where nothing moves along it.
[[nodiscard]] bool find_proximal_lock(const JointRow& row, const ProximalJoint& joint,
                                      ProximalLock& lock);

/// How soft the rows are: overloaded contacts, by more than 400 times `weight` (a body's impulse in
/// a substep, m/s, Q32), give less.
void set_gives(std::int64_t weight, const PreparedRows& prepared, ProximalContact& contact,
               lanes::ProximalBlock& problem);

/// Sets γ of a row, Q30: 2^-14 … 1.
void set_give(std::int64_t give, std::size_t row, lanes::ProximalBlock& problem);

}  // namespace lockstone
