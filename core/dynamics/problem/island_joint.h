// A joint in the problem of its island's contacts (`BlockSolver`).
#pragma once

#include <array>
#include <cstdint>

#include "core/dynamics/problem/proximal_rows.h"

namespace lockstone {

struct IslandJoint {
  std::uint32_t joint = 0;              // as `JointSolver` numbers it
  std::uint32_t a = 0, b = 0;           // numbers of its bodies; 0: no impulse moves it
  std::int64_t part_a = 0, part_b = 0;  // roots of shares of the pair's inverse mass, Q30
  BlockFloat inverse_mass{};            // of the pair
  RowScale mass;                        // its root as a part of the island's unit
  std::array<std::uint8_t, k_contact_rows> rows{};  // of the joint, by lane
  std::array<RowScale, k_contact_rows> to_speed{}, to_impulse{};
  std::size_t row_count = 0;                           // of the joint, as its rows were last read
  std::array<JointDirections, k_contact_rows> read{};  // of those rows, by lane
};

}  // namespace lockstone
