// A body as the contact solver sees it during one tick, besides the data of the kernels.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>

#include "core/dynamics/body/inertia.h"
#include "core/math/block_float.h"

namespace lockstone {

/// Constants of a body in the solver.
struct alignas(64) SolverBody {
  // The preparation of contacts reads only the first 64 bytes.
  InverseInertia inverse_inertia{};
  BlockFloat inverse_mass{};
  std::int32_t scale_exponent = 0;
  std::uint8_t locked = 0;    // bit i: axis i of moving is locked
  bool is_plain = true;       // nothing is locked, and it turns alike about all axes
  bool is_alone = false;      // touches one body that no impulse moves, and nothing else
  bool rests = false;         // of a pile, and hardly moves when the tick begins
  bool is_heavier = false;    // its joints take it to be heavier to turn than it is
  bool is_whole = false;      // `WholeIslands` moves it
  bool is_spherical = false;  // its principal moments are equal
  alignas(64) std::array<std::int64_t, 3> gain{};  // of velocity in a substep, by gravity and
                                                   // forces; Q32
  std::array<std::int64_t, 3> spin_gain{};         // of spin, by torques

  /// Whether impulses change it.
  [[nodiscard]] bool is_pushed() const { return inverse_mass.mantissa != 0; }
  /// The greatest component of the gain, whichever way it points.
  [[nodiscard]] std::int64_t greatest_gain() const {
    std::int64_t most = 0;
    for (const std::int64_t part : gain)
      most = std::max({most, part, -part});
    return most;
  }
  [[nodiscard]] bool is_locked(int axis) const { return (locked >> axis & 1) != 0; }
  /// Whether it can turn at all.
  [[nodiscard]] bool turns() const {
    return inverse_inertia.xx != 0 || inverse_inertia.yy != 0 || inverse_inertia.zz != 0;
  }
};

}  // namespace lockstone
