// Solves the locks and motors of groups of joints with loops, by a factor with six rows a body.
//
// In a loop some locks repeat others. With a compliance γ there is one solution for the errors r:
// λ = −(A + γ)⁻¹·r, A = J·M⁻¹·Jᵀ. It is found by way of velocities: (1 + Jᵀ·J/γ)·x = −Jᵀ·r/γ and
// λ = −(r + J·x)/γ. Another solve adds to those impulses, and then a part of the compliance of the
// first ones counts as an error: rows become stiffer, and impulses of locks against each other do
// not add up without limit.
//
// Source: J. Carpentier, R. Budhiraja, N. Mansard, "Proximal and sparse resolution of constrained
// dynamic equations", 2021.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/joint/joint_rows.h"
#include "core/dynamics/problem/body_factor.h"
#include "core/dynamics/problem/proximal_rows.h"
#include "core/dynamics/state/joint_record.h"

namespace lockstone {

class ProximalLocks {
 public:
  /// Room for this many bodies and joints. No function but this allocates.
  [[gnu::cold]] ProximalLocks(std::size_t body_capacity, std::size_t joint_capacity);

  void clear();

  /// One end of a joint: a body by its number in the group, or one that no impulse moves.
  struct End {
    static constexpr std::uint32_t k_unpushed = 0xffffffff;
    std::uint32_t body = k_unpushed;
    BlockFloat inverse_mass{};
  };

  /// Whether a group of this size may have a factor. Only such groups are begun.
  [[nodiscard]] static bool may_fit(std::uint32_t bodies, std::uint32_t joints) {
    return bodies <= BodyFactor::k_most_bodies && joints <= k_most_joints;
  }

  /// Begins a group, whose joints are then added in their order.
  void begin_group();
  void add_joint(const End& a, const End& b);

  /// Of all groups since `clear`.
  [[nodiscard]] PoolUse pool_use() const { return factor_.pool_use(); }

  /// Ends it: bodies are named 0 … bodies − 1. Returns its number, or k_too_large; then it has not
  /// been planned.
  static constexpr std::uint32_t k_too_large = 0xffffffff;
  [[nodiscard]] std::uint32_t end_group(std::uint32_t bodies);

  /// Before a factor: how a body of a group turns, and the rows of a joint of it; `left_out` has a
  /// bit for each that gets no impulse.
  void set_inertia(std::uint32_t group, std::uint32_t body, const InverseInertia& inertia);
  void set_rows(std::uint32_t group, std::uint32_t joint, std::span<const JointRow> rows,
                std::uint32_t left_out);
  void factor(std::uint32_t group);

  /// The speed errors that the impulses of a joint's rows are to remove, m/s, Q50.
  [[nodiscard]] std::span<std::int64_t> errors(std::uint32_t group, std::uint32_t joint) {
    return joints_[groups_[group].first_joint + joint].errors;
  }

  /// Adds 1/64 of the compliance of each row of a joint times its whole impulse so far (the pair's
  /// velocity jump, Q50) to its error, so that impulses of rows against each other do not grow.
  void give(std::uint32_t group, std::uint32_t joint, std::span<const std::int64_t> impulses);

  /// Takes the errors away, as far as one solve does: finds the impulses of all rows.
  void solve(std::uint32_t group);

  /// Of the rows of a joint: the pair's velocity jumps, Q50.
  [[nodiscard]] std::span<const std::int64_t> impulses(std::uint32_t group, std::uint32_t joint) {
    return joints_[groups_[group].first_joint + joint].impulses;
  }

 private:
  // Of a group: sums of the factor have room for the rows of this many.
  static constexpr std::uint32_t k_most_joints = 512;

  template <class T>
  using ByRow = std::array<T, k_max_joint_rows>;

  struct Joint {
    std::uint32_t a = End::k_unpushed, b = End::k_unpushed;
    std::int64_t part_a = 0, part_b = 0;  // roots of shares of the pair's inverse mass, Q30
    BlockFloat inverse_mass{};            // of the pair
    RowScale mass;                        // its root as a part of the group's unit
    std::uint32_t count = 0;              // of rows
    std::uint32_t used = 0;               // a bit for each row that may get an impulse
    ByRow<lanes::BlockWord> rows{};       // as the kernels have them, and two scales
    ByRow<RowScale> own{};                // response of a row to itself
    ByRow<std::int64_t> errors{};
    ByRow<std::int64_t> impulses{};  // the pair's velocity jump, m/s, Q50

    [[nodiscard]] bool uses(std::size_t row) const { return (used >> row & 1) != 0; }
    void set_row(std::size_t row, const ProximalLock& lock);
    [[nodiscard]] RowScale to_speed(std::size_t row) const { return scale_in(rows[row][6]); }
    [[nodiscard]] RowScale to_impulse(std::size_t row) const { return scale_in(rows[row][7]); }
    [[nodiscard]] static RowScale scale_in(std::int64_t word) {
      return {static_cast<std::uint32_t>(word), static_cast<std::int32_t>(word >> 32)};
    }
  };
  struct Group {
    BodyFactor::Plan plan;
    std::uint32_t first_joint = 0;
    std::uint32_t joints = 0;
    BlockFloat unit{};  // 1/m₀, of the heaviest pair
  };

  [[nodiscard]] std::span<Joint> joints_of(const Group& group) {
    return std::span(joints_).subspan(group.first_joint, group.joints);
  }
  // The change of a body's velocity; `unmoved` for one that no impulse moves.
  [[nodiscard]] BodyVector& change_of(const Group& group, std::uint32_t body, BodyVector& unmoved) {
    return body == End::k_unpushed ? unmoved : changes_[group.plan.first_column + body];
  }
  void add_to_factor(const Group& group, const Joint& joint);
  [[nodiscard]] int coarsest_bits(const Group& group);
  [[nodiscard]] bool try_solve(const Group& group, int bits);
  void add_changes(const Group& group, Joint& joint, int bits);
  void set_impulses(const Group& group, Joint& joint, int bits);

  std::vector<Group> groups_;
  std::vector<Joint> joints_;  // group by group
  std::vector<BodyFactor::Pair> pairs_;
  std::vector<InertiaRoot> roots_;   // by column of the factor
  std::vector<BodyVector> changes_;  // alike
  BodyFactor factor_;
};

}  // namespace lockstone
