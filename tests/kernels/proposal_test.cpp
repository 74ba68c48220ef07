// The impulses and rows that one solve of a direct step proposes, in exact numbers. The scalar
// twins stand for all targets: check_proximal.cpp holds them together.
#include <cstddef>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include "core/kernels/proximal/proximal_block.h"
#include "tests/kernels/proximal_values.h"

namespace lockstone::lanes::test {
namespace {

// Makes a row of γ = 1 active, or idle, with this impulse.
void set_row(ProximalBlock& block, std::size_t row, bool is_active, std::int64_t impulse) {
  block.give[row] = k_whole_row;
  block.own_part[row] = k_whole_row / 2;
  block.weight[row] = std::int64_t{1} << (30 - k_weight_point);
  block.tolerance[row] = 4;
  block.active[row] = is_active ? -1 : 0;
  block.impulse[row] = block.next[row] = impulse;
}

// Normal rows, active, with impulses of 100.
ProximalBlock make_normals(std::uint32_t points) {
  ProximalBlock block;
  block.points = block.rows = points;
  block.b = 1;
  for (std::size_t r = 0; r < points; ++r) {
    set_row(block, r, true, 100);
    block.normal[r] = -1;
  }
  return block;
}

// Proposes with residuals of these many units at the solution.
Proposal propose(ProximalBlock& block, const std::vector<std::int64_t>& residuals,
                 bool follows = true) {
  const BlockWord bodies[2]{};
  for (std::size_t r = 0; r < residuals.size(); ++r)
    block.residual[r] = residuals[r] * k_whole_row;
  return k_scalar_proximal.propose(&block, 1, 8, follows, bodies);
}

TEST(ProximalKernels, AnAllowedSolutionIsProposed) {
  ProximalBlock block = make_normals(2);
  EXPECT_EQ(propose(block, {60, -60}), (Proposal{true, true, 0, 0}));
  EXPECT_EQ(block.next[0], 40);
  EXPECT_EQ(block.next[1], 160);
}

TEST(ProximalKernels, ARowThatWouldPullBecomesIdle) {
  ProximalBlock block = make_normals(2);
  EXPECT_EQ(propose(block, {160, 0}), (Proposal{false, true, 1, std::uint64_t{99} << 30}));
  EXPECT_EQ(block.next[0], 0);
  EXPECT_EQ(block.next_active[0], 0);
  EXPECT_EQ(block.next_active[1], -1);
}

TEST(ProximalKernels, ARowThatClosesBecomesActive) {
  ProximalBlock block = make_normals(2);
  block.active[1] = block.impulse[1] = block.next[1] = 0;
  EXPECT_EQ(propose(block, {60, 60}), (Proposal{true, true, 0, 0}));
  EXPECT_EQ(block.next[1], 0);
  EXPECT_EQ(propose(block, {60, -60}), (Proposal{false, true, 1, (std::uint64_t{60} << 30) - 1}));
  EXPECT_EQ(block.next_active[1], -1);
}

TEST(ProximalKernels, AProposalThatDoesNotFitSaysSo) {
  ProximalBlock block = make_normals(2);
  EXPECT_FALSE(propose(block, {0, -(std::int64_t{1} << 32)}).fits);
}

// A normal row and two rows of friction, whose limit is half of the normal's impulse.
ProximalBlock make_friction(bool sticks) {
  ProximalBlock block = make_normals(1);
  block.rows = 3;
  block.limits[0] = 1 << (k_friction_point - 1);
  for (std::size_t r = 1; r < 3; ++r)
    set_row(block, r, sticks, 0);
  return block;
}

TEST(ProximalKernels, FrictionBeyondItsLimitBecomesIdleAndHasItsLimit) {
  ProximalBlock block = make_friction(true);
  EXPECT_EQ(propose(block, {0, -60, 80}), (Proposal{false, true, 1, std::uint64_t{30 | 39} << 30}));
  EXPECT_EQ(block.next[1], 30);
  EXPECT_EQ(block.next[2], -40);
  EXPECT_EQ(block.next_active[1], 0);
}

TEST(ProximalKernels, FrictionWithinItsLimitBecomesActive) {
  ProximalBlock block = make_friction(false);
  EXPECT_EQ(propose(block, {0, -60, 0}), (Proposal{false, true, 1, 0}));
  EXPECT_EQ(block.next_active[1], -1);
  EXPECT_EQ(block.next_active[2], -1);
}

// It slides in the direction of its impulse's opposite, and stays at its limit.
TEST(ProximalKernels, FrictionThatSlidesStaysAtItsLimit) {
  ProximalBlock block = make_friction(false);
  block.impulse[1] = block.next[1] = 50;
  EXPECT_EQ(propose(block, {0, -60, 0}), (Proposal{true, true, 0, 0}));
  EXPECT_EQ(block.next[1], 50);
  EXPECT_EQ(block.next_active[1], 0);
}

TEST(ProximalKernels, FrictionThatSlidesFollowsItsNormal) {
  ProximalBlock block = make_friction(false);
  block.impulse[1] = block.next[1] = 50;
  EXPECT_EQ(propose(block, {-100, -200, 0}), (Proposal{false, true, 0, std::uint64_t{50} << 30}));
  EXPECT_EQ(block.next[1], 100);
}

TEST(ProximalKernels, FrictionThatSlidesAndDoesNotFollowIsNoSolution) {
  ProximalBlock block = make_friction(false);
  block.impulse[1] = block.next[1] = 50;
  EXPECT_EQ(propose(block, {-100, -60, 0}, false), (Proposal{false, true, 0, 0}));
  EXPECT_EQ(block.next[1], 50);
}

}  // namespace
}  // namespace lockstone::lanes::test
