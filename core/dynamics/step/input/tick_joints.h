// The joints of a tick: gathers them with their bodies, for the joint solver or the coloured ball
// joints, and stores their impulses.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/dynamics/joint/coloured_balls.h"
#include "core/dynamics/linkage/joint_solver.h"
#include "core/dynamics/step/input/contact_scene.h"
#include "core/dynamics/step/input/solver_bodies.h"

namespace lockstone {

class TickJoints {
 public:
  /// No function but this allocates. `bodies` must outlive it.
  [[gnu::cold]] TickJoints(const TimeStep& step, std::size_t body_capacity,
                           std::size_t contact_capacity, std::size_t joint_capacity,
                           bool solves_loops, SolverBodies& bodies);

  /// Once contacts have named their bodies: gathers the joints of a scene and the rest of the
  /// bodies.
  void gather(const ContactScene& scene);

  /// Once all bodies have their numbers.
  void reserve_rows();
  /// Once bodies are filled: bodies as heavy to turn as the joints need.
  void begin();

  /// Neither the joint solver nor the coloured ball joints have any.
  [[nodiscard]] bool empty() const { return solver_->empty(); }
  /// Bodies of this number or above touch nothing.
  [[nodiscard]] std::uint32_t first_without_contacts() const { return first_without_contacts_; }
  [[nodiscard]] JointSolver& solver() { return *solver_; }
  [[nodiscard]] const JointSolver& solver() const { return *solver_; }
  [[nodiscard]] ColouredBalls& balls() { return balls_; }
  [[nodiscard]] const ColouredBalls& balls() const { return balls_; }

  [[nodiscard]] JointRun run();
  [[nodiscard]] ColouredBallsRun balls_run();

  /// Writes the last impulses of each joint to the records.
  void store(std::span<const JointLink> links, std::span<JointRecord> joints,
             Parallel& parallel) const;

 private:
  void gather_balls(const ContactScene& scene);

  SolverBodies& bodies_;
  std::unique_ptr<JointSolver> solver_;
  ColouredBalls balls_;
  std::uint32_t first_without_contacts_ = 1;
  std::vector<lanes::BodyPlace> places_;  // by row, of the bodies of coloured ball joints
};

}  // namespace lockstone
