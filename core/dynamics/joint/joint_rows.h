// The rows of a joint: errors and Jacobians from the poses of two bodies.
//
// Units: velocities are m/s, Q50, as in `lanes::BodyVelocity`; Jacobians have 30 fraction bits. A
// row of an angle is an angle times 2^k m, k = `angular_exponent`. An impulse is the pair's
// velocity jump λ·(1/mA + 1/mB).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/dynamics/body/inertia.h"
#include "core/dynamics/body/raw_vec3.h"
#include "core/dynamics/state/joint_record.h"
#include "core/dynamics/state/time_step.h"

namespace lockstone {

namespace geometry {
class Curve;
}

/// Where a body is within a tick.
struct JointPose {
  Vec3<Position> position{};
  Quat orientation{};
  Mat3 rotation{};
};

enum class RowKind : std::uint8_t { lock, limit, drive };

/// The Jacobian of a row for both bodies, with its kind and axis.
struct JointDirections {
  RawVec3 linear_a{}, linear_b{};    // Q30, signs included
  RawVec3 angular_a{}, angular_b{};  // of surface velocity
  RowKind kind = RowKind::lock;
  std::uint8_t axis = 0;
  bool flipped = false;  // the upper limit: impulses count against the axis
  bool shifts = false;   // a row about an axis that has linear parts too
};

/// Whether the linear parts of a row are not zero.
[[nodiscard]] inline bool has_linear_parts(const JointDirections& row) {
  return row.axis < 3 || row.shifts;
}

struct JointRow : JointDirections {
  RawVec3 response_a{}, response_b{};  // M·angular: of spin
  std::int64_t error = 0;              // m, Q32: of a lock its opening, of a limit the way left

  std::int64_t speed = 0;  // that a drive wants, or with which a lock turns, Q50
};

/// Each axis has at most a lock or limit, and a drive.
inline constexpr std::size_t k_max_joint_rows = 2 * k_joint_axes;

struct JointRows {
  std::span<JointRow> rows;  // room for them
  std::uint8_t locks = 0;    // these come first
  std::uint8_t count = 0;
  bool is_point = false;  // the first three lock the axes of the world
};

/// The frames of a joint on its bodies, each in its body's frame.
struct JointFrames {
  Mat3 a{}, b{};
};

/// The inputs from which a joint's rows are found.
struct JointPlace {
  const JointRecord& joint;
  const JointFrames& frames;
  const JointPose& a;
  const JointPose& b;
  int scale_a;  // exponents of the bodies
  int scale_b;
  int exponent;                            // of angular rows
  std::uint8_t far = 0;                    // axes, a bit each, whose limits get no rows
  bool holds_a_point = false;              // as below
  bool turns_locks = false;                // the record does
  const geometry::Curve* curve = nullptr;  // of a path joint
};

/// The parts of a joint's rows to compute.
enum class RowParts : std::uint8_t { all, locks };

/// Jacobians and errors; responses are left alone.
void fill_rows(const JointPlace& place, RowParts parts, JointRows& out);

/// The errors of the locks alone, in the order of their rows.
struct LockErrors {
  std::array<std::int64_t, k_joint_axes> errors;
  std::size_t count = 0;
};
[[nodiscard]] LockErrors lock_errors(const JointPlace& place);

/// The most rows that it can have.
[[nodiscard]] std::size_t most_rows(const JointRecord& joint);

/// The opening of a joint that locks the axes of the world, as errors of its first three rows.
[[nodiscard]] RawVec3 point_gap(const JointPlace& place);

/// Whether the locks of the first three axes are along the axes of the world, not of frame a.
[[nodiscard]] bool has_world_axes(const JointRecord& joint);

/// Whether it is a ball without limits.
[[nodiscard]] bool is_free_ball(const JointRecord& joint);

/// Whether it holds a point and nothing else: a ball without limits and drives.
[[nodiscard]] bool is_point(const JointRecord& joint);

/// Whether it holds a point and nothing else has rows, without limits that are far.
[[nodiscard]] bool holds_a_point(const JointRecord& joint, std::uint8_t far);

}  // namespace lockstone
