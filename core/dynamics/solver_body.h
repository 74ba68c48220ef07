// A body as the contact solver sees it during one tick.
#pragma once

#include <array>
#include <cstdint>

#include <lockstone/units.h>

#include "core/dynamics/inertia.h"

namespace lockstone {

/// Raw lanes: x, y, z.
using Lanes32 = std::array<std::int32_t, 3>;
using Lanes64 = std::array<std::int64_t, 3>;

/// Displacements are those since the tick began; contact geometry is that of the tick's beginning.
struct SolverBody {
  Lanes64 velocity{};      // m/s, Q32
  Lanes64 spin{};          // m/s, Q32: see BodyRecord
  Lanes64 displacement{};  // m, Q32
  Lanes64 turn{};          // rotation vector · 2^scale_exponent, m, Q32
  Lanes64 gravity_step{};  // velocity gained in a substep, m/s, Q32
  InverseInertia inverse_inertia{};
  std::uint32_t body = 0;
};

/// Velocities as rows read them: Q20, clamped to ±1024 m/s so that sums of nine products fit 63
/// bits.
[[nodiscard]] constexpr std::int32_t read_velocity(std::int64_t q32) {
  constexpr std::int64_t k_bound = std::int64_t{1} << 30;
  const std::int64_t q20 = raw::round_shift(q32, 12);
  return static_cast<std::int32_t>(q20 > k_bound ? k_bound : q20 < -k_bound ? -k_bound : q20);
}

/// Displacements as rows read them: Q24, clamped to ±16 m.
[[nodiscard]] constexpr std::int32_t read_displacement(std::int64_t q32) {
  constexpr std::int64_t k_bound = std::int64_t{1} << 28;
  const std::int64_t q24 = raw::round_shift(q32, 8);
  return static_cast<std::int32_t>(q24 > k_bound ? k_bound : q24 < -k_bound ? -k_bound : q24);
}

[[nodiscard]] constexpr Lanes32 read_velocities(const Lanes64& v) {
  return {read_velocity(v[0]), read_velocity(v[1]), read_velocity(v[2])};
}

[[nodiscard]] constexpr Lanes32 read_displacements(const Lanes64& v) {
  return {read_displacement(v[0]), read_displacement(v[1]), read_displacement(v[2])};
}

/// Exact; the caller guarantees |a|·|b| < 2^63.
[[nodiscard]] constexpr std::int64_t dot(const Lanes32& a, const Lanes32& b) {
  return std::int64_t{a[0]} * b[0] + std::int64_t{a[1]} * b[1] + std::int64_t{a[2]} * b[2];
}

}  // namespace lockstone
