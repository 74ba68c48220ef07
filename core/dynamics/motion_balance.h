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
  /// What a change, in whatever format, is within.
  static constexpr std::int64_t k_most_change = std::int64_t{1} << 31;

  /// A row: what a unit impulse along it changes, within ±2, Q26. At most 256 of them.
  void add(const Motion6& column);

  /// Once all are added. What no row changes, or hardly any (by less than 2^-8), is left out.
  void factor();

  /// (A·Aᵀ)⁻¹·c, to about 2^-14 of it. False where it, or what leads there, is beyond
  /// 4 · k_most_change: rows are too much alike.
  [[nodiscard]] bool solve(const Motion6& change, Motion6& solution) const;

  /// What a row has to push, of what `solve` answered.
  [[nodiscard]] static std::int64_t impulse(const Motion6& column, const Motion6& solution);

 private:
  std::array<Motion6, 6> sums_{};       // A·Aᵀ, at and below the diagonal, Q52
  std::array<Motion6, 6> lower_{};      // L·D·Lᵀ = A·Aᵀ: L below the diagonal, Q20
  std::array<std::int64_t, 6> over_{};  // 1/D, Q20; 0: left out
};

}  // namespace lockstone
