// The rows of a contact: how its points and its friction move two bodies, one row at a time.
//
// Read from the block that the iterations use, with the responses of both bodies. A row's speed is
// linear·(vB − vA) + response_b·spinB − response_a·spinA; an impulse along it gives B its share of
// linear and angular_b, and takes the rest of linear and angular_a from A.
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/dynamics/body/raw_vec3.h"
#include "core/dynamics/body/solver_body.h"
#include "core/dynamics/contact/contact_index.h"
#include "core/kernels/contact/manifold_block.h"

namespace lockstone {

/// Within a tick impulses have twelve bits more than blocks and records hold, and a greater range:
/// up to 65,536 m/s, Q32.
inline constexpr int k_row_impulse_bits = 32;
inline constexpr int k_row_more_bits = k_row_impulse_bits - 20;

/// From the Q32 of gains and impulses to the Q50 of rows.
inline constexpr int k_row_shift = lanes::k_velocity_bits - k_row_impulse_bits;
inline constexpr std::int64_t k_to_row = std::int64_t{1} << k_row_shift;

/// The contact solver's data, lent to other solvers.
struct ContactRun {
  std::span<lanes::BodyVelocity> rows;
  std::span<const lanes::BodyVelocity> before;  // as the substep began
  std::span<const SolverBody> bodies;
  std::span<lanes::ManifoldBlock> blocks;
  const lanes::SolverParams& params;
};

/// A contact as the solver numbers it.
struct ContactPair {
  ContactLane place;           // of its words
  std::uint32_t a = 0, b = 0;  // numbers of its bodies; 0: no impulse moves it

  [[nodiscard]] std::size_t block() const { return place.block(); }
  [[nodiscard]] std::size_t lane() const { return place.lane(); }
};

/// B feels `linear`, angular_b of its impulse, A the opposite of `linear`, angular_a; responses are
/// the angular parts through the bodies' inertia. Q30.
struct ContactRow {
  RawVec3 linear{};
  RawVec3 angular_a{}, angular_b{};
  RawVec3 response_a{}, response_b{};
  std::int64_t impulse = 0;  // m/s, Q32
};

/// A point along the normal.
struct PointRow : ContactRow {
  std::int64_t x = 0, y = 0;  // offset from the centre, Q30
};

struct ContactRows : ContactPair {
  std::array<PointRow, lanes::k_block_points> points{};
  std::uint32_t count = 0;
  RawVec3 normal{}, tangent{}, binormal{};
  BlockFloat inverse_mass{};  // of the pair
};

/// The points and axes of a contact whose place and bodies are set. Impulses are those of the
/// block.
void find_rows(const ContactRun& run, ContactRows& contact);

/// Responses of a row from its other parts.
void find_responses(const ContactRun& run, const ContactPair& pair, ContactRow& row);

}  // namespace lockstone
