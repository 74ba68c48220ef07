// Random contacts of an island's proximal problem.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include "core/kernels/proximal/proximal_block.h"
#include "core/math/wide/scalar_lanes.h"
#include "tests/kernels/values.h"

namespace lockstone::lanes::test {

inline constexpr std::int64_t k_whole_row = std::int64_t{1} << 30;

/// One side of a row, Q30.
[[nodiscard]] inline std::int64_t side_entry(const ProximalBlock& block, std::size_t row,
                                             std::size_t entry) {
  const std::int64_t both = block.by_row[row][entry % k_body_words];
  return entry < k_body_words ? scalar::low(both) : scalar::high(both);
}

/// Makes contacts of 1 … 4 points, with friction of two or three rows or without any. Wild: words
/// are any that their formats allow. Else words agree with each other as preparation leaves them:
/// rows have length 1, those of friction 0.7, so that the three respond to a push of all of them
/// less than twice as much as one row of length 1.
struct ProblemMaker {
  lockstone::test::Random& random;
  bool wild = false;
  int unit_bits = 30;  // of the words that a phase begins with
  bool rubs = true;    // some contacts have friction

  [[nodiscard]] std::int64_t unit() const {
    const std::int64_t most = std::min(k_most_unit, (std::int64_t{1} << unit_bits) - 1);
    switch (random.next() % 8) {
      case 0:
        return random.next() % 2 == 0 ? most : -most;
      case 1:
        return 0;
      case 2:
        return std::clamp(beside_power(random), -most, most);
      default:
        return random.between(-most, most) >> random.between(0, 12);
    }
  }
  [[nodiscard]] std::int64_t any_word(std::int64_t tame) const {
    return wild ? word(random) : tame;
  }

  // Bodies are the last of `bodies`, which nothing moves, or others.
  void fill(ProximalBlock& block, std::size_t bodies) const {
    block.points = static_cast<std::uint32_t>(random.between(1, 4));
    block.rows = block.points + static_cast<std::uint32_t>(rubs ? random.next() % 3 : 0);
    if (block.rows > block.points) ++block.rows;
    block.a = static_cast<std::uint32_t>(random.below(bodies));
    block.b = static_cast<std::uint32_t>(random.below(bodies));
    if (block.a == block.b) block.b = (block.a + 1) % static_cast<std::uint32_t>(bodies);
    for (std::size_t r = 0; r < block.rows; ++r) {
      fill_sides(block, r, block.a + 1 < bodies, block.b + 1 < bodies);
      fill_row(block, r);
    }
    if (block.rows > block.points) fill_friction(block);
    if (wild) fill_kept(block);
  }

  void fill_body(BlockWord& body) const {
    for (std::size_t i = 0; i < k_body_words; ++i)
      body[i] = wild && random.next() % 4 == 0 ? word(random) : unit();
  }

 private:
  void fill_sides(ProximalBlock& block, std::size_t r, bool has_a, bool has_b) const {
    double sides[2 * k_body_words], square = 0;
    for (std::size_t i = 0; i < std::size(sides); ++i) {
      const bool moves = i < k_body_words ? has_a : has_b;
      sides[i] = moves ? static_cast<double>(random.between(-1000, 1000)) : 0;
      square += sides[i] * sides[i];
    }
    const double length = r < block.points ? 1 : 0.7;
    const double scale = std::ldexp(length / std::sqrt(std::max(square, 1.0)), 30);
    for (std::size_t i = 0; i < k_body_words; ++i) {
      const auto a = static_cast<std::int64_t>(sides[i] * scale);
      const auto b = static_cast<std::int64_t>(sides[i + k_body_words] * scale);
      block.sides[i][r] = any_word(scalar::pack(a, b));
      block.by_row[r][i] = any_word(scalar::pack(a, b));
    }
  }

  void fill_row(ProximalBlock& block, std::size_t r) const {
    const bool is_normal = r < block.points;
    const std::int64_t give = std::int64_t{1} << random.between(16, 30);
    block.give[r] = wild ? random.between(1, k_whole_row) : give;
    block.own_part[r] = (k_whole_row << 30) / (k_whole_row + block.give[r]);
    block.weight[r] = any_word((std::int64_t{1} << (60 - k_weight_point)) / give);
    block.normal[r] = is_normal ? -1 : 0;
    block.active[r] = random.next() % 3 == 0 ? 0 : -1;
    block.speed[r] = unit();
    block.impulse[r] = is_normal ? std::max<std::int64_t>(unit(), 0) : unit();
    block.start[r] = block.impulse[r];
    block.centre[r] = unit();
    block.tolerance[r] = random.between(1, 1000);
    block.residual[r] = any_word(unit() * random.between(-8, 7) * (std::int64_t{1} << 29));
    block.next[r] = unit();
    const std::int64_t kept[] = {unit(), unit(), unit(), unit()};
    const int bits = static_cast<int>(random.between(0, 27));
    block.held[r] = is_normal ? std::abs(kept[0]) << bits : kept[0] * (std::int64_t{1} << bits);
    block.held_centre[r] = kept[1] * (std::int64_t{1} << bits);
    block.moving[r] = kept[2] * (std::int64_t{1} << bits);
    block.bias[r] = kept[3] * (std::int64_t{1} << bits);
    block.least_change[r] = random.between(0, std::int64_t{1} << 32);
    if (!wild) return;
    for (BlockWord& coupling : block.coupling)
      coupling[r] = word(random);
  }

  void fill_friction(ProximalBlock& block) const {
    const bool is_wide = wild || random.next() % 4 == 0;
    for (std::size_t i = 0; i < block.points; ++i)
      block.limits[i] =
          static_cast<std::int32_t>(is_wide ? random.between(1, INT32_MAX) >> random.between(0, 30)
                                            : random.between(1, 2 << k_friction_point));
    block.limits[0] = std::max(block.limits[0], 1);
    block.twist_ratio = static_cast<std::int32_t>(is_wide ? random.between(0, INT32_MAX)
                                                          : random.between(1 << 18, 1 << 24));
    const std::int64_t active = block.active[block.points];
    std::fill_n(block.active.begin() + block.points, block.rows - block.points, active);
  }

  // Kept words may be any: a phase clamps those it takes.
  void fill_kept(ProximalBlock& block) const {
    for (BlockWord* kept : {&block.held, &block.held_centre, &block.moving, &block.bias,
                            &block.least_change, &block.warm, &block.moved})
      for (std::size_t r = 0; r < block.rows; ++r)
        (*kept)[r] = word(random);
  }
};

}  // namespace lockstone::lanes::test
