// The kernels of small islands against their meaning, in exact numbers or in doubles. The scalar
// twins stand for all targets: check_proximal.cpp holds them together.
#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstdlib>
#include <vector>

#include <gtest/gtest.h>

#include "core/kernels/proximal/proximal_block.h"
#include "tests/kernels/proximal_values.h"

namespace lockstone::lanes::test {
namespace {

using lockstone::test::Random;

__extension__ typedef __int128 Exact;

constexpr const ProximalKernels& k_kernels = k_scalar_proximal;
constexpr std::size_t k_sides = 2 * k_body_words;

struct Island {
  std::vector<ProximalBlock> blocks;
  std::vector<BlockWord> bodies;  // changes of velocity; the last stands for the ground

  Island(std::size_t contacts, const ProblemMaker& maker) : blocks(contacts), bodies(contacts + 1) {
    for (ProximalBlock& block : blocks) {
      maker.fill(block, bodies.size());
      k_kernels.couple(block);
    }
  }
  void move(const ProblemMaker& maker) {
    for (std::size_t i = 0; i + 1 < bodies.size(); ++i)
      maker.fill_body(bodies[i]);
  }
  PassResult pass() { return k_kernels.pass(blocks.data(), blocks.size(), bodies.data()); }
  std::uint64_t find_residuals() {
    return k_kernels.find_residuals(blocks.data(), blocks.size(), bodies.data());
  }
};

std::size_t body_of(const ProximalBlock& block, std::size_t entry) {
  return entry < k_body_words ? block.a : block.b;
}

// J·u of a row, Q30.
Exact dot(const Island& island, const ProximalBlock& block, std::size_t r) {
  Exact sum = 0;
  for (std::size_t i = 0; i < k_sides; ++i)
    sum += Exact{side_entry(block, r, i)} * island.bodies[body_of(block, i)][i % k_body_words];
  return sum;
}

// J·u + speed + γ(λ − c), Q30.
Exact residual(const Island& island, const ProximalBlock& block, std::size_t r) {
  return dot(island, block, r) + Exact{block.speed[r]} * k_whole_row +
         Exact{block.give[r]} * (block.impulse[r] - block.centre[r]);
}

Exact rounded(Exact x, int shift) {
  const Exact half = Exact{1} << (shift - 1);
  return x < 0 ? -((-x + half) >> shift) : (x + half) >> shift;
}

// 2·D, Q60, since the phase began: bodies move by the changes of impulses.
Exact twice_dual(const Island& island) {
  std::vector<Exact> changes(island.bodies.size() * k_body_words);
  Exact sum = 0;
  for (const ProximalBlock& block : island.blocks) {
    for (std::size_t r = 0; r < block.rows; ++r) {
      const Exact gained = block.impulse[r] - block.start[r];
      const Exact apart = block.impulse[r] - block.centre[r];
      for (std::size_t i = 0; i < k_sides; ++i)
        changes[body_of(block, i) * k_body_words + i % k_body_words] +=
            side_entry(block, r, i) * gained;
      sum += (gained * block.speed[r] << 61) + (apart * apart * block.give[r] << 30);
    }
  }
  for (const Exact change : changes)
    sum += change * change;
  return sum;
}

TEST(ProximalKernels, CoupleRowsByTheirProductsToNearest) {
  Random random;
  for (int round = 0; round < 2000; ++round) {
    const Island island(1, {random});
    const ProximalBlock& block = island.blocks[0];
    for (std::size_t r = 0; r < block.rows; ++r) {
      for (std::size_t k = 0; k < k_block_lanes; ++k) {
        Exact sum = 0;
        for (std::size_t i = 0; i < k_sides && k < block.rows; ++i)
          sum += Exact{side_entry(block, r, i)} * side_entry(block, k, i);
        const Exact own = k == r ? block.give[r] : 0;
        const Exact expected = std::min<Exact>(rounded(sum, 30) + own, INT32_MAX);
        ASSERT_EQ(block.coupling[r][k], static_cast<std::int64_t>(expected)) << r << ", " << k;
        if (k >= block.rows) continue;
        ASSERT_EQ(block.coupling[r][k], block.coupling[k][r]);
      }
    }
  }
}

// Units up to the bound that makes the sums fit.
TEST(ProximalKernels, FindResidualsExactly) {
  Random random;
  for (int round = 0; round < 1000; ++round) {
    const ProblemMaker maker{random};
    Island island(static_cast<std::size_t>(random.between(1, 6)), maker);
    island.move(maker);
    const std::uint64_t bits = island.find_residuals();
    std::uint64_t most = 0;
    for (const ProximalBlock& block : island.blocks) {
      for (std::size_t r = 0; r < block.rows; ++r) {
        const std::int64_t x = block.residual[r];
        ASSERT_EQ(x, static_cast<std::int64_t>(residual(island, block, r)));
        if (block.normal[r] != 0 && block.active[r] == 0) continue;
        most = std::max(most, static_cast<std::uint64_t>(x < 0 ? -(x + 1) : x));
      }
    }
    EXPECT_EQ(std::bit_width(bits), std::bit_width(most));
  }
}

TEST(ProximalKernels, BeginAPhaseInUnitsThatAreCoarser) {
  Random random;
  for (int round = 0; round < 2000; ++round) {
    const int down = static_cast<int>(random.between(1, 42));
    const auto coarse = [down](std::int64_t x) {
      const Exact result = rounded(x, down);
      return static_cast<std::int64_t>(std::clamp<Exact>(result, -k_most_unit, k_most_unit));
    };
    Island island(1, {random});
    ProximalBlock& block = island.blocks[0];
    const int loose = static_cast<int>(random.between(0, 20));
    k_kernels.begin_phase(&block, 1, down, loose);
    std::uint64_t most = 0;
    for (std::size_t r = 0; r < block.rows; ++r) {
      const std::int64_t speed = block.moving[r] + block.bias[r];
      EXPECT_EQ(block.speed[r], coarse(speed));
      EXPECT_EQ(block.impulse[r], coarse(block.held[r]));
      EXPECT_EQ(block.start[r], block.impulse[r]);
      EXPECT_EQ(block.centre[r], coarse(block.held_centre[r]));
      const Exact tolerance = rounded(block.least_change[r], std::max(down - loose, 1));
      EXPECT_EQ(block.tolerance[r], std::max<Exact>(tolerance, 1));
      for (const std::int64_t x : {speed, block.held[r], block.warm[r]})
        most = std::max(most, static_cast<std::uint64_t>(x < 0 ? -(x + 1) : x));
    }
    EXPECT_EQ(std::bit_width(k_kernels.magnitudes(&block, 1)), std::bit_width(most));
  }
}

TEST(ProximalKernels, LeaveSpeedsThatFollowBodiesToNearest) {
  Random random;
  constexpr Exact k_bound = Exact{1} << 58;
  for (int round = 0; round < 2000; ++round) {
    const ProblemMaker maker{random};
    const int shift = static_cast<int>(random.between(-16, 62));
    Island island(3, maker);
    island.move(maker);
    std::vector<ProximalBlock> after = island.blocks;
    k_kernels.update_residuals(after.data(), after.size(), island.bodies.data(), shift);
    for (std::size_t c = 0; c < after.size(); ++c) {
      for (std::size_t r = 0; r < after[c].rows; ++r) {
        const Exact along = dot(island, island.blocks[c], r);
        const Exact change = shift > 0 ? rounded(along, shift) : along * (Exact{1} << -shift);
        const Exact expected = island.blocks[c].moving[r] + std::clamp(change, -k_bound, k_bound);
        ASSERT_EQ(after[c].moving[r],
                  static_cast<std::int64_t>(std::clamp(expected, -k_bound, k_bound)));
      }
    }
  }
}

// Coulomb's cone of a contact, in doubles. How far friction lies outside.
double outside_cone(const ProximalBlock& block) {
  double limit = 0, square = 0;
  for (std::size_t r = 0; r < block.rows; ++r) {
    const auto x = static_cast<double>(block.impulse[r]);
    if (r < block.points) limit += std::ldexp(x * block.limits[r], -k_friction_point);
    const double ratio =
        r == block.points + 2 ? std::ldexp(block.twist_ratio, -k_friction_point) : 1;
    if (r >= block.points) square += ratio * x * ratio * x;
  }
  return std::sqrt(square) - std::min(limit, static_cast<double>(k_most_unit));
}

// An impulse of the twist is rounded to its own unit, which may be many of a tangent's.
TEST(ProximalKernels, PassesLeaveNormalsThatPushAndFrictionWithinItsLimit) {
  Random random;
  int sliding = 0;
  for (int round = 0; round < 3000; ++round) {
    const ProblemMaker maker{random, false, static_cast<int>(random.between(4, 30))};
    Island island(static_cast<std::size_t>(random.between(1, 6)), maker);
    island.move(maker);
    for (int pass = 0; pass < 3; ++pass) {
      (void)island.pass();
      for (const ProximalBlock& block : island.blocks) {
        for (std::size_t r = 0; r < block.points; ++r)
          ASSERT_GE(block.impulse[r], 0);
        if (!block.has_friction()) continue;
        const double step = std::ldexp(block.twist_ratio, -k_friction_point) + 1;
        ASSERT_LE(outside_cone(block), 2 + step) << round;
        sliding += block.slides ? 1 : 0;
      }
    }
  }
  EXPECT_GT(sliding, 1000);
}

// Rows err by a few units: half of one at each change of residuals, and two for each contact that
// has moved a body since the phase began. D may grow by the square of that.
TEST(ProximalKernels, PassesNeverRaiseTheDualObjectiveBeyondRounding) {
  Random random;
  int lowered = 0, compared = 0;
  for (int round = 0; round < 3000; ++round) {
    const ProblemMaker maker{random, false, static_cast<int>(random.between(4, 22)),
                             round % 2 == 0};
    Island island(static_cast<std::size_t>(random.between(1, 6)), maker);
    const auto contacts = static_cast<std::int64_t>(island.blocks.size());
    for (int pass = 1; pass <= 4; ++pass) {
      const Exact before = twice_dual(island);
      ASSERT_TRUE(island.pass().fits);
      // Friction that is shortened goes where its limit is, not down.
      const bool slides = std::ranges::any_of(
          island.blocks, [](const ProximalBlock& block) { return block.slides; });
      if (slides) continue;
      const std::int64_t error = 8 + 2 * pass * contacts;
      const Exact bound = Exact{8 * 7 * contacts * error * error} << 61;
      const Exact after = twice_dual(island);
      ASSERT_LE(static_cast<double>(after - before), static_cast<double>(bound)) << round;
      ++compared;
      if (before - after > bound) ++lowered;
    }
  }
  EXPECT_GT(compared, 4000);
  EXPECT_GT(lowered, 2000);
}

// Soft rows, so that passes alone get there; `with_locks`: half of the rows are locks.
void soften(Random& random, bool with_locks, std::int64_t tolerance, ProximalBlock& block) {
  if (with_locks) {
    block.has_locks = true;
    block.points /= 2;
    std::fill(block.normal.begin() + block.points, block.normal.end(), 0);
    block.limits = {};
  }
  for (std::size_t r = 0; r < block.rows; ++r) {
    block.give[r] = k_whole_row >> random.between(0, 1);
    block.own_part[r] = (k_whole_row << 30) / (k_whole_row + block.give[r]);
    block.tolerance[r] = tolerance;
  }
  k_kernels.couple(block);
}

// Passes until no row changes.
void run_passes(Island& island) {
  PassResult last;
  for (int pass = 0; pass < 400 && !last.done; ++pass)
    last = island.pass();
  ASSERT_TRUE(last.fits);
  ASSERT_TRUE(last.done);
}

// Rows that push have no residual, and others open; locks have none. Rounding lets rows that push
// each other change by 2 units for ever, so a change of fewer than 4 counts as none.
TEST(ProximalKernels, PassesEndWhereTheConditionsOfTheLeastHold) {
  constexpr int k_cycle = 4, k_left = 8;
  Random random;
  int pulling = 0;
  for (int round = 0; round < 300; ++round) {
    SCOPED_TRACE(round);
    const ProblemMaker maker{random, false, static_cast<int>(random.between(8, 26)), false};
    Island island(static_cast<std::size_t>(random.between(1, 5)), maker);
    for (ProximalBlock& block : island.blocks)
      soften(random, round % 2 == 0, k_cycle, block);
    ASSERT_NO_FATAL_FAILURE(run_passes(island));
    (void)island.find_residuals();
    for (const ProximalBlock& block : island.blocks) {
      for (std::size_t r = 0; r < block.rows; ++r) {
        const double left = std::ldexp(static_cast<double>(block.residual[r]), -30);
        const bool is_lock = r >= block.points;
        EXPECT_GE(left, -k_left);
        EXPECT_TRUE((!is_lock && block.impulse[r] == 0) || left <= k_left) << left;
        pulling += is_lock && block.impulse[r] < 0 ? 1 : 0;
      }
    }
  }
  EXPECT_GT(pulling, 100);
}

// The rows of a joint, of which each second is in use, against the same rows of a block.
TEST(ProximalKernels, AddSubtractAndMultiplyTheRowsInUse) {
  Random random;
  for (int round = 0; round < 1000; ++round) {
    const ProblemMaker maker{random};
    Island island(1, maker);
    island.move(maker);
    ProximalBlock block = island.blocks[0];
    BlockWord rows[2 * k_most_rows] = {}, errors[2] = {};
    std::int64_t x[2 * k_most_rows] = {}, products[2 * k_most_rows] = {};
    std::uint32_t used = 0;
    block.weight.fill(k_whole_row);
    block.active.fill(-1);
    for (std::size_t r = 0; r < block.rows; ++r) {
      rows[2 * r + 1] = block.by_row[r];
      x[2 * r + 1] = random.between(-(1 << 27), 1 << 27);
      used |= 2U << 2 * r;
    }
    BodyBlock found[3], expected[3];
    const auto places = [](BodyBlock* to) { return MatrixPlaces{to, to + 1, to + 2, true}; };
    k_kernels.add_rows(rows, used, places(found));
    k_kernels.add_to_matrix(block, places(expected));
    for (std::size_t i = 0; i < 3; ++i)
      EXPECT_EQ(found[i], expected[i]);
    k_kernels.subtract_rows(rows, used, x, errors[0], errors[1]);
    for (std::size_t i = 0; i < k_sides; ++i) {
      Exact sum = 0;
      for (std::size_t r = 0; r < block.rows; ++r)
        sum -= Exact{side_entry(block, r, i)} * x[2 * r + 1];
      EXPECT_EQ(errors[i / k_body_words][i % k_body_words],
                static_cast<std::int64_t>(rounded(sum, 30)));
    }
    k_kernels.row_products(rows, used, island.bodies[block.a], island.bodies[block.b], products);
    for (std::size_t r = 0; r < block.rows; ++r) {
      EXPECT_EQ(products[2 * r], 0);
      EXPECT_EQ(products[2 * r + 1], static_cast<std::int64_t>(dot(island, block, r)));
    }
  }
}

// A direct step's system, with the matrix that the kernels gather.
struct System {
  std::size_t size;
  std::vector<long double> matrix, x;

  explicit System(const Island& island)
      : size((island.bodies.size() - 1) * k_body_words), matrix(size * size), x(size) {
    for (std::size_t i = 0; i < size; ++i)
      at(i, i) = std::ldexp(1.0L, -k_weight_point);
    for (const ProximalBlock& block : island.blocks)
      add(block, island.bodies.size() - 1);
  }
  long double& at(std::size_t row, std::size_t column) { return matrix[row * size + column]; }

  void add(const ProximalBlock& block, std::size_t unmoved) {
    BodyBlock a, b, both;
    const bool has_a = block.a != unmoved, has_b = block.b != unmoved, a_is_row = block.a > block.b;
    k_kernels.add_to_matrix(block, {has_a ? &a : nullptr, has_b ? &b : nullptr,
                                    has_a && has_b ? &both : nullptr, a_is_row});
    const std::size_t row = a_is_row ? block.a : block.b, column = a_is_row ? block.b : block.a;
    for (std::size_t i = 0; i < k_body_words; ++i) {
      for (std::size_t k = 0; k < k_body_words; ++k) {
        const auto entry = [&](const BodyBlock& from) {
          return std::ldexp(static_cast<long double>(from.words[k][i]), -50);
        };
        if (has_a) at(block.a * k_body_words + i, block.a * k_body_words + k) += entry(a);
        if (has_b) at(block.b * k_body_words + i, block.b * k_body_words + k) += entry(b);
        if (!has_a || !has_b) continue;
        at(row * k_body_words + i, column * k_body_words + k) += entry(both);
        at(column * k_body_words + k, row * k_body_words + i) += entry(both);
      }
    }
  }

  // Gaussian elimination; the matrix is positive.
  void solve() {
    for (std::size_t k = 0; k < size; ++k) {
      for (std::size_t i = k + 1; i < size; ++i) {
        const long double part = at(i, k) / at(k, k);
        for (std::size_t j = k; j < size; ++j)
          at(i, j) -= part * at(k, j);
        x[i] -= part * x[k];
      }
    }
    for (std::size_t k = size; k-- > 0;) {
      for (std::size_t j = k + 1; j < size; ++j)
        x[k] -= at(k, j) * x[j];
      x[k] /= at(k, k);
    }
  }
};

// All rows pushing and sticking, with γ = 1/16.
Island make_active_island(Random& random) {
  const ProblemMaker maker{random, false, 12};
  Island island(static_cast<std::size_t>(random.between(1, 4)), maker);
  for (ProximalBlock& block : island.blocks) {
    for (std::size_t r = 0; r < block.rows; ++r) {
      block.give[r] = k_whole_row / 16;
      block.weight[r] = (std::int64_t{1} << (60 - k_weight_point)) / block.give[r];
      block.active[r] = -1;
      block.tolerance[r] = 8;
      if (r < block.points) block.impulse[r] = block.centre[r] = 1 << 20;
    }
    if (block.has_friction()) block.limits.fill(INT32_MAX);
    block.twist_ratio = 1 << k_friction_point;
  }
  return island;
}

TEST(ProximalKernels, DirectStepsSolveTheEquationsOfTheActiveRows) {
  Random random;
  for (int round = 0; round < 300; ++round) {
    Island island = make_active_island(random);
    ProximalBlock* blocks = island.blocks.data();
    const std::size_t count = island.blocks.size();
    const int drop = std::max(1, static_cast<int>(std::bit_width(island.find_residuals())) - 27);
    std::vector<BlockWord> sums(island.bodies.size());
    k_kernels.add_right_sides(blocks, count, drop, sums.data());
    System system(island);
    for (std::size_t i = 0; i < system.size; ++i)
      system.x[i] = sums[i / k_body_words][i % k_body_words];
    system.solve();
    for (std::size_t i = 0; i < system.size; ++i)
      sums[i / k_body_words][i % k_body_words] = std::llround(system.x[i]);
    sums.back() = {};
    const Proposal proposal = k_kernels.propose(blocks, count, drop, true, sums.data());
    ASSERT_TRUE(proposal.fits && proposal.is_solved) << round;
    ASSERT_TRUE(k_kernels.add_changes(blocks, count, island.bodies.data()));
    island.bodies.back() = {};
    for (ProximalBlock& block : island.blocks)
      block.impulse = block.next;
    (void)island.find_residuals();
    for (const ProximalBlock& block : island.blocks)
      for (std::size_t r = 0; r < block.rows; ++r)
        EXPECT_LT(std::fabs(std::ldexp(static_cast<double>(block.residual[r]), -30)), 8.0) << round;
  }
}

}  // namespace
}  // namespace lockstone::lanes::test
