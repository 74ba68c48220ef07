// The joints of a tick as the problem of an island's contacts sees them (`BlockSolver`): rows,
// their speeds, and the impulses that the problem gives them.
#pragma once

#include <cstdint>
#include <span>

#include "core/dynamics/linkage/system/joint_run.h"
#include "core/dynamics/linkage/system/joint_system.h"
#include "core/dynamics/problem/island_joint.h"

namespace lockstone {

class IslandJoints {
 public:
  explicit IslandJoints(JointSystem& system) : system_(system) {}

  /// A joint by its number in the system.
  [[nodiscard]] IslandJoint joint(std::uint32_t joint) const;

  /// Before a tick's joints begin: the problem has the joint, and gravity acts on its bodies as on
  /// those with contacts.
  void put_among_contacts(std::uint32_t joint);

  [[nodiscard]] std::span<const JointRow> rows(std::uint32_t joint) const {
    const JointRows& rows = system_.joints[joint].rows;
    return rows.rows.first(rows.count);
  }

  /// The relative velocity that a row sees, m/s, Q50.
  [[nodiscard]] std::int64_t speed(const JointRun& run, std::uint32_t joint, std::size_t row) const;

  /// The speed at which the rest of the way to a limit may be gone, or, before positions move, at
  /// which it is pushed back; Q50.
  [[nodiscard]] std::int64_t limit_speed(const JointRow& row, bool positions) const;

  /// The impulse of a limit so far, ≥ 0, Q50.
  [[nodiscard]] std::int64_t limit_impulse(std::uint32_t joint, std::size_t row) const;

  /// Applies impulses, by row; the next substep begins with them.
  void give(const JointRun& run, std::uint32_t joint, const RowImpulses& impulses);

 private:
  JointSystem& system_;
};

}  // namespace lockstone
