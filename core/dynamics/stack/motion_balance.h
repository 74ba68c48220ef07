// Which impulses change a body's motion by so much: the least, in the sum of their squares.
//
// Rows that push with impulses p change its motion by A·p, six numbers. Of all p with A·p = c the
// least is Aᵀ·(A·Aᵀ)⁻¹·c.
#pragma once

#include <array>
#include <cstdint>

namespace lockstone {

/// Velocity, then spin.
using Motion6 = std::array<std::int64_t, 6>;

class MotionBalance {
 public:
  /// The greatest magnitude of a component of a change, in any format.
  static constexpr std::int64_t k_most_change = std::int64_t{1} << 31;

  /// Adds a row: the change by a unit impulse along it, within ±2, Q26. At most 256 rows.
  void add(const Motion6& column);

  /// To be called after the last `add`. Directions of motion that all rows together change by less
  /// than 2^-8 are left out.
  void factor();

  /// (A·Aᵀ)⁻¹·c, to a relative error of about 2^-14. Returns false if the solution or an
  /// intermediate result exceeds 4 · k_most_change: the rows are too much alike.
  [[nodiscard]] bool solve(const Motion6& change, Motion6& solution) const;

  /// The impulse of a row, from the solution of `solve`.
  [[nodiscard]] static std::int64_t impulse(const Motion6& column, const Motion6& solution);

 private:
  std::array<Motion6, 6> sums_{};       // A·Aᵀ, at and below the diagonal, Q52
  std::array<Motion6, 6> lower_{};      // L·D·Lᵀ = A·Aᵀ: L below the diagonal, Q20
  std::array<std::int64_t, 6> over_{};  // 1/D, Q20; 0: left out
};

}  // namespace lockstone
