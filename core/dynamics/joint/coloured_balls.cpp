#include "core/dynamics/joint/coloured_balls.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/body/mass_share.h"

namespace lockstone {
namespace {

using lanes::BallBlock;
using lanes::BallKernels;
using lanes::k_block_lanes;
using lanes::scalar::high;
using lanes::scalar::low;
using lanes::scalar::pack;

// The inertia of a pair is told by the greater exponent of the two.
constexpr int k_factor_exponent = 12;
constexpr int k_inertia_bits = 28;

// A lane without a joint: nothing moves its bodies.
constexpr std::int64_t k_empty_scale = pack(20, 20);
constexpr std::int64_t k_empty_share = pack(1 << 30, k_inertia_bits);

std::int32_t impulse_of(const JointRecord& record, std::size_t axis) {
  return std::clamp(record.axes[axis].impulse.raw, -lanes::k_most_impulse, lanes::k_most_impulse);
}

// Whether it turns alike about all axes, and will until the tick ends.
bool stays_alike(const SolverBody& body) {
  return body.is_spherical && turns_alike(body.inverse_inertia);
}

void empty_lane(std::size_t lane, BallBlock& block) {
  LKS_ASSERT(lane < lanes::k_block_lanes);
  block.body_a[lane] = block.body_b[lane] = 0;
  for (lanes::BlockWord& word : block.anchor)
    word[lane] = 0;
  for (lanes::BlockWord& word : block.impulse)
    word[lane] = 0;
  block.scale[lane] = k_empty_scale;
  block.factor[lane] = pack(1, 1);
  block.share[lane] = k_empty_share;
}

}  // namespace

ColouredBalls::ColouredBalls(std::int32_t substep_rate, std::size_t row_capacity,
                             std::size_t joint_capacity)
    : substep_rate_(substep_rate), graph_(row_capacity, joint_capacity) {
  const std::size_t blocks = (joint_capacity + k_block_lanes - 1) / k_block_lanes;
  // Each colour may leave one block half empty, but none without a joint.
  const std::size_t most = std::min(joint_capacity, blocks + k_graph_colors);
  entries_.reserve(joint_capacity);
  blocks_.reserve(most);
  lane_entries_.reserve(most * k_block_lanes);
}

void ColouredBalls::clear(std::uint32_t rows) {
  entries_.clear();
  lane_entries_.clear();
  graph_.clear();
  for (std::uint32_t row = 1; row < rows; ++row)
    graph_.add_body();
  std::fill(std::begin(ranges_), std::end(ranges_), Range{});
}

void ColouredBalls::add(std::uint32_t link, const JointRecord& record, bool has_others,
                        const End& a, const End& b) {
  LKS_ASSERT(a.pushed || b.pushed);
  graph_.add(a.row, a.pushed, b.row, b.pushed);
  entries_.push_back({link,
                      a.row,
                      b.row,
                      a.pushed,
                      b.pushed,
                      has_others,
                      record.anchor_a,
                      record.anchor_b,
                      {impulse_of(record, 0), impulse_of(record, 1), impulse_of(record, 2)}});
}

void ColouredBalls::lay_out() {
  std::size_t blocks = 0;
  for (std::size_t color = 0; color <= k_graph_colors; ++color) {
    ranges_[color] = {blocks, (graph_.count(color) + k_block_lanes - 1) / k_block_lanes};
    blocks += ranges_[color].count;
  }
  kernels_ = &lanes::ball_kernels(graph_.greatest_count());
  lane_entries_.assign(blocks * k_block_lanes, k_no_joint);
  if (blocks_.size() < blocks) blocks_.resize(blocks);  // they only grow
  const std::span<const ConstraintGraph::Place> places = graph_.places();
  for (std::size_t i = 0; i < places.size(); ++i) {
    std::uint32_t& lane_index =
        lane_entries_[ranges_[places[i].color].first * k_block_lanes + places[i].rank];
    LKS_ASSERT(lane_index == k_no_joint);
    lane_index = static_cast<std::uint32_t>(i);
  }
}

const BallKernels& ColouredBalls::kernels_of(std::size_t color) const {
  return color == k_overflow_color ? lanes::k_scalar_balls : *kernels_;
}

void ColouredBalls::fill(const ColouredBallsRun& run, const JointedWorld& world, std::size_t color,
                         std::size_t first, std::size_t end) {
  const BallKernels& kernels = kernels_of(color);
  LKS_ASSERT(first <= end && end <= ranges_[color].count);
  for (std::size_t i = ranges_[color].first + first; i < ranges_[color].first + end; ++i) {
    for (std::size_t lane = 0; lane < k_block_lanes; ++lane) {
      const std::uint32_t entry = lane_entries_[i * k_block_lanes + lane];
      if (entry == k_no_joint) {
        empty_lane(lane, blocks_[i]);
      } else {
        fill_lane(run, world, entries_[entry], lane, blocks_[i]);
      }
    }
    kernels.begin(&blocks_[i], 1, run.places, run.inertias, run.before, substep_rate_);
  }
}

// Fills a lane, and writes the places of bodies that are not pushed.
void ColouredBalls::fill_lane(const ColouredBallsRun& run, const JointedWorld& world,
                              const Entry& entry, std::size_t lane, BallBlock& block) {
  const auto place = [&](std::uint32_t row, std::uint32_t body) {
    run.places[row] = body_place(world.bodies[body].position, world.rotations[body]);
  };
  if (!entry.pushed_a) place(entry.row_a, world.links[entry.link].body_a);
  if (!entry.pushed_b) place(entry.row_b, world.links[entry.link].body_b);
  static constexpr SolverBody k_standing{.is_spherical = true};
  const SolverBody& a = entry.pushed_a ? run.bodies[entry.row_a] : k_standing;
  const SolverBody& b = entry.pushed_b ? run.bodies[entry.row_b] : k_standing;
  const int of_a = a.inverse_inertia.exponent, of_b = b.inverse_inertia.exponent;
  const int pair = std::max(of_a, of_b);
  LKS_ASSERT(pair - of_a <= k_factor_exponent && pair - of_b <= k_factor_exponent);
  block.body_a[lane] = lanes::body_velocity_offset(entry.row_a);
  block.body_b[lane] = lanes::body_velocity_offset(entry.row_b);
  for (int axis = 0; axis < 3; ++axis)
    block.anchor[axis][lane] = pack(entry.anchor_a[axis].raw, entry.anchor_b[axis].raw);
  block.scale[lane] = pack(20 + a.scale_exponent, 20 + b.scale_exponent);
  if (!stays_alike(a) || !stays_alike(b)) block.scale[lane] |= lanes::k_special_balls;
  block.factor[lane] = pack(std::int64_t{1} << (k_factor_exponent - pair + of_a),
                            std::int64_t{1} << (k_factor_exponent - pair + of_b));
  block.share[lane] = pack(share_of_b(a.inverse_mass, b.inverse_mass), k_inertia_bits - pair);
  block.impulse[0][lane] = pack(entry.impulse[0], entry.impulse[1]);
  block.impulse[1][lane] = entry.impulse[2];
}

void ColouredBalls::solve_positions(const ColouredBallsRun& run, std::size_t color,
                                    std::size_t first, std::size_t end) {
  LKS_ASSERT(first <= end && end <= ranges_[color].count);
  kernels_of(color).solve_positions(run.rows, &blocks_[ranges_[color].first + first], end - first);
}

void ColouredBalls::update(const ColouredBallsRun& run, std::size_t color, std::size_t first,
                           std::size_t end) {
  LKS_ASSERT(first <= end && end <= ranges_[color].count);
  kernels_of(color).update(run.rows, run.before, &blocks_[ranges_[color].first + first],
                           end - first, run.places, run.inertias, substep_rate_);
}

void ColouredBalls::store(std::span<const JointLink> links, std::span<JointRecord> joints,
                          std::size_t first, std::size_t end) const {
  for (std::size_t lane_index = first; lane_index < end; ++lane_index) {
    if (lane_entries_[lane_index] == k_no_joint) continue;
    LKS_ASSERT(entries_[lane_entries_[lane_index]].link < links.size());
    const BallBlock& block = blocks_[lane_index / k_block_lanes];
    const std::size_t lane = lane_index % k_block_lanes;
    const Entry& entry = entries_[lane_entries_[lane_index]];
    JointRecord& joint = joints[links[entry.link].joint];
    const std::int32_t impulse[] = {low(block.impulse[0][lane]), high(block.impulse[0][lane]),
                                    low(block.impulse[1][lane])};
    for (std::size_t axis = 0; axis < 3; ++axis)
      joint.axes[axis].impulse = SolverVelocity::from_raw(impulse[axis]);
    if (!entry.has_others) continue;
    for (std::size_t axis = 0; axis < k_joint_axes; ++axis) {
      if (axis >= 3) joint.axes[axis].impulse = {};
      joint.axes[axis].drive_impulse = {};
    }
  }
}

}  // namespace lockstone
