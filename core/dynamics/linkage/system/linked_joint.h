// A joint during one tick: its rows, its masses, its drives and its impulses so far.
//
// Impulses are the pair's velocity jump λ·(1/mA + 1/mB), m/s, Q50, by axis. A substep has two: one
// before positions move and one after it. The next substep begins with the sum of both.
#pragma once

#include <array>
#include <cstdint>

#include "core/dynamics/joint/joint_rows.h"
#include "core/dynamics/linkage/system/linked_body.h"
#include "core/dynamics/state/joint_record.h"
#include "core/dynamics/state/time_step.h"
#include "core/math/block_float.h"

namespace lockstone {

/// A part of a pair's inverse mass as mantissa · 2^-shift; no mantissa for a body that no impulse
/// moves.
struct MassShare {
  static constexpr int k_shift = 62;  // of parts of 2^-31 and more

  std::int64_t mantissa = 0;  // at most 2^62
  int shift = k_shift;        // at most 91
};

/// The inverse of a row's response to its own impulse: mantissa · 2^-shift.
struct InverseResponse {
  std::int64_t mantissa = 0;
  int shift = 1;
};

/// The impulse of a spring before positions move, or after it, with its damping a.
struct SpringPart {
  std::int64_t stiffness = 0;  // 1/s, Q40, per 1 + a
  std::int32_t forgets = 0;    // Q30, 1 / (1 + a)
  std::int32_t share = 0;      // of its bound, Q30
};

/// The motor or spring of an axis.
struct JointDrive {
  std::int64_t bound = 0;  // of its impulse, Q50; 0: none
  SpringPart before, after;

  [[nodiscard]] bool is_spring() const { return before.share != 0; }
};

/// Impulses of the rows of a joint, Q50.
using RowImpulses = std::array<std::int64_t, k_max_joint_rows>;

/// Impulses of the axes of a joint, Q50.
using AxisImpulses = std::array<std::int64_t, k_joint_axes>;

struct LinkedJoint {
  const JointRecord* record = nullptr;
  JointRows rows;
  JointFrames frames;                        // where the bodies are now
  std::uint32_t a = 0, b = 0;                // in JointSystem::bodies
  std::uint32_t solver_a = 0, solver_b = 0;  // numbers of the bodies in the contact solver
  MassShare share_a, share_b;
  BlockFloat inverse_mass{};              // of the pair
  std::int64_t lever_a = 0, lever_b = 0;  // to the anchors, m, Q20: sums of their components
  int exponent = 0;                       // of angular rows
  std::int32_t energy_gained = 0;         // of its cluster, if it is the first one there

  std::array<InverseResponse, k_max_joint_rows> inverse_responses{};  // of limits and drives
  std::array<JointDrive, k_joint_axes> drives{};

  AxisImpulses locks{};    // before positions move; of limits in both phases
  AxisImpulses relaxed{};  // of locks, after positions moved
  AxisImpulses carried{};  // `relaxed` of the substep before, or saved where no cluster moves first
  AxisImpulses saved{};    // of `locks`
  AxisImpulses driven{};   // of drives, before positions move
  AxisImpulses driven_later{};                         // of drives, after it
  std::array<std::int64_t, k_joint_axes> left_open{};  // of locks, by row: too far to close in the
                                                       // substep, m, Q32

  std::uint64_t factored = 0;  // rows that the factor has, as a list of `list_rows`
  std::uint32_t left_out = 0;  // rows, a bit each, without impulses from the factor of loops
  std::array<std::int8_t, k_joint_axes> scales{};  // of its locks in the factor, exponents
  std::uint8_t far = 0;            // axes whose limits have no rows in this tick, a bit each
  bool holds_a_point = false;      // and nothing else has rows in this tick
  bool turns_locks = false;        // the record does: the frame on body a turns
  std::uint8_t substeps_left = 0;  // of the tick, where the bodies are now
};

/// The rows of a joint as a list of digits: the axis of each, and whether it is a lock, a limit or
/// a drive. Two lists are equal if the factor of one fits the other.
[[nodiscard]] std::uint64_t list_rows(const JointRows& rows);

/// Sets bodies, masses and levers of a joint. Its rows and drives are left alone.
void set_masses(LinkedJoint& joint, const LinkedBody& a, const LinkedBody& b);

/// The frames as many substeps before the end of the tick: that on body a turns with its locks.
[[nodiscard]] JointFrames frames_of(const JointRecord& joint, const TimeStep& step,
                                    std::int32_t substeps_left);

/// Begins with the impulses of the last tick: those of locks times 2^(shift − 30).
void load_impulses(LinkedJoint& joint, int shift);

/// Writes the impulses to a record. `moves_first`: positions moved half a substep first.
void store_impulses(const LinkedJoint& joint, bool moves_first, JointRecord& record);

/// Whether a joint neither limits nor drives any axis, nor turns locks.
[[nodiscard]] bool only_locks(const JointRecord& joint);

}  // namespace lockstone
