// A body as the contact solver sees it during one tick, besides what the lanes read and write.
#pragma once

#include <array>
#include <cstdint>

#include "core/dynamics/inertia.h"
#include "core/math/block_float.h"

namespace lockstone {

/// Constants of a body in the solver.
struct SolverBody {
  InverseInertia inverse_inertia{};
  std::array<std::int64_t, 3> gravity_step{};  // velocity gained in a substep, m/s, Q32
  BlockFloat inverse_mass{};
  std::int32_t scale_exponent = 0;

  /// Whether impulses change it.
  [[nodiscard]] bool is_pushed() const { return inverse_mass.mantissa != 0; }
  /// Whether it can turn at all.
  [[nodiscard]] bool turns() const { return inverse_inertia.xx != 0; }
};

}  // namespace lockstone
