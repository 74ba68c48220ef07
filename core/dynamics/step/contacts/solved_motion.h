// The motion of bodies once the substeps have run: writes poses and velocities back to the records.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include "core/dynamics/linkage/joint_solver.h"
#include "core/dynamics/state/time_step.h"
#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/solver_bodies.h"

namespace lockstone {

class SolvedMotion {
 public:
  /// No function but this allocates. `bodies` must outlive it.
  [[gnu::cold]] SolvedMotion(const TimeStep& step, std::size_t number_capacity,
                             const SolverBodies& bodies);

  /// Once all bodies have their numbers.
  void reserve();
  /// Forgets the pushes of the last tick; bodies by number.
  void clear(std::size_t first, std::size_t end);

  /// A contact that touched pushed its bodies along its normal. In the order of colours; contacts
  /// of one colour share no body.
  void note_push(const ContactRef& contact, const Vec3<Unit>& normal);

  /// Writes a body's substeps back: position, orientation, velocity and spin. `rotation` is the
  /// matrix of its orientation, `pose` the place where joints have put it, or null. Returns the
  /// same as `fly`.
  std::uint32_t scatter(std::uint32_t number, const Mat3& rotation, const JointPose* pose,
                        BodyRecord& body) const;

  /// The velocity and the spin of a body now.
  [[nodiscard]] std::array<Vec3<Velocity>, 2> speeds(std::uint32_t number) const;

 private:
  // Along which axis contacts pushed a body in this tick; `mixed` when along several.
  struct PushAxis {
    Vec3<Unit> normal{};
    bool pushed = false;
    bool mixed = false;

    void add(const Vec3<Unit>& n);
  };

  [[nodiscard]] Vec3<Velocity> half_step_back(std::uint32_t number, const BodyRecord& body) const;

  TimeStep step_;
  const SolverBodies& bodies_;
  std::vector<PushAxis> axes_;  // by number
};

}  // namespace lockstone
