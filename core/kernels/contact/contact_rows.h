// Normal rows of four-point contacts, laid out for vectors: the kernel in which an iteration over
// one colour of the constraint graph spends most of its time.
//
// For each point, with the spin L, the tensor M that turns spin into surface speed,
// jA = M·(r̄A × n) and α = (1/m) / (1/mA + 1/mB):
//   v  = n·(vB − vA) + jB·LB − jA·LA                      rounded once
//   P' = max(0, keep·P − m̄·(v + bias))                    rounded once
//   vB += αB·n·(P' − P), LB += αB·(r̄B × n)·(P' − P), and the opposite for A: exact, not rounded.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace lockstone::lanes {

/// Contacts in a block; every target's number of lanes divides it.
inline constexpr std::size_t k_block_lanes = 8;

/// Fraction bits of the velocities in a BodyVelocity: those of a gain (30) plus those of an impulse
/// (20), so that an impulse's effect is added as it is.
inline constexpr int k_velocity_bits = 50;

/// A body's motion as rows read and write it: m/s, Q50. Components wrap when read unless they are
/// within ±2048 m/s.
struct alignas(64) BodyVelocity {
  std::array<std::int64_t, 3> velocity{};
  std::array<std::int64_t, 3> spin{};
  std::array<std::int64_t, 2> unused{};

  friend bool operator==(const BodyVelocity&, const BodyVelocity&) = default;
};

/// One word for each contact of a block, often of two operands: pack(low, high).
using BlockWord = std::array<std::int64_t, k_block_lanes>;

/// One point of each contact.
struct RowPoint {
  BlockWord a[3]{};          // low: jA, Q(shift); high: αA·(r̄A × n), Q30
  BlockWord b[3]{};          // the same of B
  BlockWord mass_keep{};     // low: m̄, high: the share of P that stays; both Q30, in [0, 1]
  BlockWord impulse_bias{};  // low: P ≥ 0, high: the velocity asked for; both m/s, Q20

  friend bool operator==(const RowPoint&, const RowPoint&) = default;
};

/// Eight contacts that share no body, save one that nothing moves (zero gains). A lane without a
/// contact is zero but for `shift` and `half`.
struct alignas(64) ContactBlock {
  std::array<std::uint32_t, k_block_lanes> body_a{};  // body_velocity_offset of its index
  std::array<std::uint32_t, k_block_lanes> body_b{};
  BlockWord shift{};      // fraction bits of the factors of velocities, 1 … 30
  BlockWord half{};       // 2^(shift − 1)
  BlockWord normal[3]{};  // n, Q(shift)
  BlockWord gain_a[3]{};  // αA·n, Q30
  BlockWord gain_b[3]{};  // αB·n, Q30
  RowPoint points[4];

  friend bool operator==(const ContactBlock&, const ContactBlock&) = default;
};

/// Offset of a body in an array of `BodyVelocity`, in words, so that no shift is needed to address
/// it.
[[nodiscard]] constexpr std::uint32_t body_velocity_offset(std::uint32_t index) {
  return index * static_cast<std::uint32_t>(sizeof(BodyVelocity) / sizeof(std::int64_t));
}

/// Solves each row once, on the target in force. The blocks are those of one colour: no body that
/// moves is named twice, so the order of contacts cannot matter.
void solve_contact_rows(std::span<BodyVelocity> bodies, std::span<ContactBlock> blocks);

/// The scalar twin, one contact at a time. It defines the result.
void solve_contact_rows_scalar(BodyVelocity* bodies, ContactBlock* blocks, std::size_t count);

}  // namespace lockstone::lanes
