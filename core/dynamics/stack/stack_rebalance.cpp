#include "core/dynamics/stack/stack_rebalance.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/contact/block_words.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {
namespace {

using lanes::BodyVelocity;
using lanes::k_block_points;
using lanes::ManifoldBlock;

// A body that stands firm has friction of this part of its push to spare, and is slower than this
// part of the speed that gravity gives in a substep: 2^-3.
constexpr int k_reserve_shift = 3;

// Fraction bits of the changes of velocity that are balanced, which are within 1/32 m/s.
constexpr int k_change_bits = 36;

// An impulse of the block, Q32.
std::int64_t finer(std::int64_t impulse) {
  return impulse * (std::int64_t{1} << k_row_more_bits);
}

// |(t, b, twist)| ≤ limit; Q20, all within 32 bits, or it is not.
bool is_within_limit(std::int64_t limit, std::int64_t t, std::int64_t b, std::int64_t twist) {
  constexpr std::int64_t k_most = lanes::k_most_impulse;
  limit = std::min(limit, k_most);
  if (limit < 0 || std::max({t, -t, b, -b}) > k_most) return false;
  const auto square = [](std::int64_t x) { return static_cast<std::uint64_t>(x * x); };
  return square(t) + square(b) + square(twist) <= square(limit);
}

// Whether the iterations solve it.
bool is_swept(const ManifoldBlock& block, std::size_t lane) {
  return block.mass_01[lane] != 0;
}

// Whether a face pushes, with friction to spare.
bool grips(const ManifoldBlock& block, std::size_t lane) {
  if (!is_swept(block, lane)) return false;
  std::int64_t push = 0;
  int pushing = 0;
  for (const ManifoldBlock::Point& point : block.points) {
    const std::int64_t impulse = low_word(point.impulse[lane]);
    pushing += impulse > 0 ? 1 : 0;
    push += impulse;
  }
  if (pushing < 3) return false;
  LKS_ASSERT(push >= 0);
  const std::int64_t most = product_rounded(push, high_word(block.share[lane]), 30);
  return is_within_limit(most - (push >> k_reserve_shift), low_word(block.friction[lane]),
                         high_word(block.friction[lane]), low_word(block.twist[lane]));
}

// A row's direction and its turning, through the share of its body, Q26, within ±2.
Motion6 column_of(const RawVec3& linear, const RawVec3& turn, std::int64_t share) {
  constexpr std::int64_t k_most = std::int64_t{1} << 27;
  Motion6 column{};
  for (std::size_t i = 0; i < 3; ++i) {
    column[i] = raw::round_shift(linear[i] * share, 34);
    const std::int64_t bounded = std::clamp(turn[i], -16 * k_most, 16 * k_most);
    column[i + 3] = raw::round_shift(bounded * share, 34);
  }
  return column;
}

// The change that stops a body: less the velocity that impulses and its own forces give it, Q36.
Motion6 change_of(const BodyVelocity& warm, const SolverBody& body) {
  Motion6 change{};
  for (std::size_t i = 0; i < 3; ++i) {
    constexpr int k_shift = lanes::k_velocity_bits - k_change_bits;
    change[i] = -raw::round_shift(warm.velocity[i] + body.gain[i] * k_to_row, k_shift);
    change[i + 3] = -raw::round_shift(warm.spin[i] + body.spin_gain[i] * k_to_row, k_shift);
  }
  return change;
}

}  // namespace

void StackRebalance::make_room(std::uint32_t workers) {
  while (scratch_.size() < workers) {
    scratch_.emplace_back();
    scratch_.back().supports.reserve(k_most_supports);
    scratch_.back().columns.reserve(k_most_supports * (k_block_points + 2));
  }
}

void StackRebalance::find(SupportGraph& order, const ContactRun& run, std::span<BodyVelocity> warm,
                          Parallel& parallel) {
  LKS_ASSERT(warm.size() >= run.bodies.size());
  order.find(run, [&](const SupportLink& link, std::uint32_t body) {
    if ((link.a == 0 || link.b == 0) && !link.is_on_ground) return false;
    return is_slower(run.rows[body], run.bodies[body], k_reserve_shift) &&
           grips(run.blocks[link.block()], link.lane());
  });
  order.descend(parallel, warm, [&](std::uint32_t body, std::uint32_t worker) {
    Scratch& scratch = scratch_[worker];
    gather(order, run, body, scratch);
    if (!balance(run, change_of(warm[body], run.bodies[body]), scratch)) return;
    for (const Support& support : scratch.supports) {
      RowPush to_a, to_b;
      push(run, support, to_a, to_b);
      order.propagate(support.link, support.pair.b == body, to_a, to_b, warm[body]);
    }
  });
  for (std::size_t body = 1; body < run.bodies.size(); ++body)
    if (order.is_supported(body)) run.rows[body] = {};
}

void StackRebalance::gather(const SupportGraph& order, const ContactRun& run, std::uint32_t body,
                            Scratch& scratch) {
  scratch.supports.clear();
  scratch.columns.clear();
  order.for_supports(body, [&](const SupportLink& link, std::uint32_t number) {
    if (scratch.supports.size() == k_most_supports) return;
    if (!is_swept(run.blocks[link.block()], link.lane())) return;
    Support& support = scratch.supports.emplace_back();
    support.pair = link;
    LKS_ASSERT(link.a == body || link.b == body);
    support.link = number;
    support.has_friction_rows = grips(run.blocks[link.block()], link.lane());
    add_columns(run, support, link.b == body, scratch.columns);
  });
}

// Of points that push, then of the tangents.
void StackRebalance::add_columns(const ContactRun& run, const Support& support, bool is_b,
                                 std::vector<Motion6>& columns) {
  const ManifoldBlock& block = run.blocks[support.pair.block()];
  const std::size_t lane = support.pair.lane();
  const RawVec3 normal = normal_of(block, lane);
  const RawVec3 t = tangent_of(block, lane), b = binormal_of(block, lane);
  const RawVec3 arm = is_b ? high_words(block.arm, lane) : low_words(block.arm, lane);
  const std::int64_t scale = is_b ? high_word(block.scale[lane]) : low_word(block.scale[lane]);
  const std::int64_t share_b = low_word(block.share[lane]);
  const std::int64_t share = is_b ? share_b : share_b - (std::int64_t{1} << 30);
  LKS_ASSERT(share_b >= 0 && share_b <= std::int64_t{1} << 30);
  for (const ManifoldBlock::Point& point : block.points) {
    if (low_word(point.impulse[lane]) <= 0) continue;
    const std::int64_t x = low_word(point.offset[lane]), y = high_word(point.offset[lane]);
    RawVec3 turn{};
    for (std::size_t i = 0; i < 3; ++i)
      turn[i] = raw::round_shift(t[i] * y - b[i] * x, 30);
    columns.push_back(column_of(normal, turned(arm, normal, scale, turn), share));
  }
  if (!support.has_friction_rows) return;
  for (const RawVec3& tangent : {t, b})
    columns.push_back(column_of(tangent, turned(arm, tangent, 0, {}), share));
}

// Whether all supports can give the impulses of the change.
bool StackRebalance::balance(const ContactRun& run, const Motion6& change, Scratch& scratch) {
  const auto is_great = [](std::int64_t x) {
    return x > MotionBalance::k_most_change || x < -MotionBalance::k_most_change;
  };
  if (std::ranges::any_of(change, is_great)) return false;
  MotionBalance all;
  for (const Motion6& column : scratch.columns)
    all.add(column);
  all.factor();
  Motion6 solution{};
  if (!all.solve(change, solution)) return false;
  auto column = scratch.columns.begin();
  // In steps of the block.
  const auto next = [&] {
    return raw::round_shift(MotionBalance::impulse(*column++, solution), k_change_bits - 20);
  };
  for (Support& support : scratch.supports) {
    const ManifoldBlock& block = run.blocks[support.pair.block()];
    for (std::size_t i = 0; i < k_block_points; ++i)
      if (low_word(block.points[i].impulse[support.pair.lane()]) > 0) support.points[i] = next();
    if (support.has_friction_rows) support.friction = {next(), next()};
    if (!holds(run, support)) return false;
  }
  LKS_ASSERT(column == scratch.columns.end());
  return true;
}

// Neither pulls nor slips.
bool StackRebalance::holds(const ContactRun& run, const Support& support) {
  const ManifoldBlock& block = run.blocks[support.pair.block()];
  const std::size_t lane = support.pair.lane();
  std::int64_t push = 0;
  for (std::size_t i = 0; i < k_block_points; ++i) {
    LKS_ASSERT(low_word(block.points[i].impulse[lane]) >= 0);
    const std::int64_t now = low_word(block.points[i].impulse[lane]) + support.points[i];
    if (now < 0 || now > lanes::k_most_impulse) return false;
    push += now;
  }
  if (!support.has_friction_rows) return true;
  return is_within_limit(product_rounded(push, high_word(block.share[lane]), 30),
                         low_word(block.friction[lane]) + support.friction[0],
                         high_word(block.friction[lane]) + support.friction[1],
                         low_word(block.twist[lane]));
}

// To the block, and at its centre to both bodies.
void StackRebalance::push(const ContactRun& run, const Support& support, RowPush& to_a,
                          RowPush& to_b) {
  ManifoldBlock& block = run.blocks[support.pair.block()];
  const std::size_t lane = support.pair.lane();
  const RawVec3 t = tangent_of(block, lane), b = binormal_of(block, lane);
  std::int64_t push = 0;
  ProductSum about_t, about_b;
  for (std::size_t i = 0; i < k_block_points; ++i) {
    const std::int64_t by = support.points[i];
    if (by == 0) continue;
    std::int64_t& word = block.points[i].impulse[lane];
    const std::int64_t now = low_word(word) + by;
    LKS_ASSERT(now >= 0 && now <= lanes::k_most_impulse);
    word = std::max<std::int64_t>(high_word(word), now) * (std::int64_t{1} << 32) + now;
    push += by;
    about_t.add(high_word(block.points[i].offset[lane]), finer(by));
    about_b.subtract(low_word(block.points[i].offset[lane]), finer(by));
  }
  const std::int64_t friction = block.friction[lane];
  block.friction[lane] = lanes::scalar::pack(low_word(friction) + support.friction[0],
                                             high_word(friction) + support.friction[1]);
  RawVec3 force = mixed(t, finer(support.friction[0]), b, finer(support.friction[1]));
  const RawVec3 along = mixed(normal_of(block, lane), finer(push), {}, 0);
  for (std::size_t i = 0; i < 3; ++i)
    force[i] += along[i];
  const RawVec3 torque = mixed(t, about_t.rounded(30), b, about_b.rounded(30));
  const std::int64_t turn = block.gain_turn[lane], share_b = low_word(block.share[lane]);
  RawVec3 spin_a{}, spin_b{};
  if (support.pair.a != 0)
    spin_a = moment_of(low_words(block.gain_arm, lane), force, torque, low_word(turn));
  if (support.pair.b != 0)
    spin_b = moment_of(high_words(block.gain_arm, lane), force, torque, high_word(turn));
  for (std::size_t i = 0; i < 3; ++i) {
    const std::int64_t part_b = product_rounded(force[i], share_b, 30);
    to_a.velocity[i] = (part_b - force[i]) * k_to_row;
    to_a.spin[i] = -spin_a[i] * k_to_row;
    to_b.velocity[i] = part_b * k_to_row;
    to_b.spin[i] = spin_b[i] * k_to_row;
  }
}

}  // namespace lockstone
