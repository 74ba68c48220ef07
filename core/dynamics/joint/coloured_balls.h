// Ball joints of many loops: coloured like contacts, and solved in blocks of eight.
//
// A mesh of joints has too many loops for a direct solve of all its locks. Each substep closes a
// part of the openings before positions move, and keeps the rest from opening afterwards. Impulses
// of the substep before are part of the bodies' warm start.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/body/solver_body.h"
#include "core/dynamics/islands/constraint_graph.h"
#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/joint_record.h"
#include "core/kernels/ball/ball_block.h"

namespace lockstone {

/// The data of the iterations, by row.
struct ColouredBallsRun {
  lanes::BodyVelocity* rows;
  lanes::BodyVelocity* before;  // at the beginning of the substep; before the first: warm
  const lanes::BodyInertia* inertias;
  const SolverBody* bodies;  // those that are pushed
  lanes::BodyPlace* places;
};

/// The world's bodies, by their numbers there, and its joints, in which `add` counted.
struct JointedWorld {
  std::span<const JointLink> links;
  std::span<const BodyRecord> bodies;
  std::span<const Mat3> rotations;
};

class ColouredBalls {
 public:
  /// No function but this allocates.
  ColouredBalls(std::int32_t substep_rate, std::size_t row_capacity, std::size_t joint_capacity);

  /// Leaves nothing; bodies are those in rows 0 … rows − 1.
  void clear(std::uint32_t rows);

  /// One end of a joint; a body that is not pushed stands still, in a row of this joint alone.
  struct End {
    std::uint32_t row = 0;
    bool pushed = false;
  };

  /// A joint, in the order of their indices: the colours follow from that order. `has_others`: its
  /// record has other impulses than those along the first three axes, which are to be cleared.
  void add(std::uint32_t link, const JointRecord& record, bool has_others, const End& a,
           const End& b);

  /// Gives each colour its blocks and each joint its lane.
  void lay_out();

  [[nodiscard]] bool empty() const { return entries_.empty(); }

  /// Blocks of one colour; the last is the overflow, whose joints may share bodies.
  [[nodiscard]] std::uint32_t block_count(std::size_t color) const {
    return static_cast<std::uint32_t>(ranges_[color].count);
  }

  // Blocks of one colour, counted from its first.

  /// Fills them, and adds the velocities that their impulses give to the bodies' warm start.
  void fill(const ColouredBallsRun& run, const JointedWorld& world, std::size_t color,
            std::size_t first, std::size_t end);
  void solve_positions(const ColouredBallsRun& run, std::size_t color, std::size_t first,
                       std::size_t end);
  /// After bodies moved; relaxes as well.
  void update(const ColouredBallsRun& run, std::size_t color, std::size_t first, std::size_t end);

  /// Impulses back to the records of `links`, in which `add` counted.
  void store(std::span<const JointLink> links, std::span<JointRecord> joints, std::size_t first,
             std::size_t end) const;
  [[nodiscard]] std::uint32_t lane_count() const {
    return static_cast<std::uint32_t>(lane_entries_.size());
  }

 private:
  static constexpr std::uint32_t k_no_joint = 0xffffffff;

  struct Range {
    std::size_t first = 0;
    std::size_t count = 0;
  };
  // All that fills a lane, in a line of the cache: records are larger, and lanes take them in
  // another order.
  struct Entry {
    std::uint32_t link;
    std::uint32_t row_a, row_b;
    bool pushed_a, pushed_b;
    bool has_others;  // other impulses than those of the three axes
    Vec3<Length> anchor_a, anchor_b;
    std::array<std::int32_t, 3> impulse;
  };

  [[nodiscard]] const lanes::BallKernels& kernels_of(std::size_t color) const;
  static void fill_lane(const ColouredBallsRun& run, const JointedWorld& world, const Entry& entry,
                        std::size_t lane, lanes::BallBlock& block);

  std::int32_t substep_rate_;
  ConstraintGraph graph_;
  std::vector<Entry> entries_;
  Range ranges_[k_graph_colors + 1];
  const lanes::BallKernels* kernels_ = nullptr;  // for as many balls as a colour has at most
  std::vector<std::uint32_t> lane_entries_;      // by lane of each block: an entry, or k_no_joint
  std::vector<lanes::BallBlock> blocks_;
};

}  // namespace lockstone
