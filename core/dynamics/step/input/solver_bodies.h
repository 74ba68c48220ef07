// The bodies of a tick's solver: numbers them, gathers their data, and integrates them in substeps.
//
// A body enters with its first constraint. Number 0 is no body; numbers are given in the order of
// the constraints, so they follow from the state alone.
#pragma once

#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/body/solver_body.h"
#include "core/dynamics/state/time_step.h"
#include "core/dynamics/step/input/contact_scene.h"
#include "core/kernels/contact/manifold_block.h"

namespace lockstone {

class SolverBodies {
 public:
  /// No function but this allocates. A moving body has one number, or, if no impulse moves it, one
  /// in each contact. Bodies that stand still have rows in contacts and in coloured balls.
  [[gnu::cold]] SolverBodies(const TimeStep& step, std::size_t body_capacity,
                             std::size_t contact_capacity, std::size_t joint_capacity);

  void clear();

  /// The reference by which a constraint names its body. A body that no impulse moves enters again
  /// with every constraint, since constraints that are solved side by side write to all their
  /// bodies.
  [[nodiscard]] BodyRef gather(BodySide side) {
    const std::uint32_t known = side.is_dynamic() ? number_of_[side.body()] : 0;
    return known != 0 ? BodyRef::numbered(known) : add(side);
  }
  /// A new reference, even where the body has one.
  BodyRef add(BodySide side);
  [[nodiscard]] BodyRef add_standing() { return BodyRef::standing(standing_count_++); }

  /// Once all bodies have their numbers: makes room for their rows.
  void reserve_rows();

  /// Numbers in use, with 0.
  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(sides_.size()); }
  /// Rows: by number, then those of standing bodies.
  [[nodiscard]] std::uint32_t row_count() const { return count() + standing_count_; }
  [[nodiscard]] std::uint32_t row_of(BodyRef body) const {
    return body.is_standing() ? count() + body.standing_index() : body.number();
  }

  /// The first number of a body of the world; 0: it is not in the solver.
  [[nodiscard]] std::uint32_t number_of(std::uint32_t body) const { return number_of_[body]; }
  [[nodiscard]] BodySide side(std::uint32_t number) const { return sides_[number]; }
  /// The number of a body that impulses move, else 0. Known once bodies are filled.
  [[nodiscard]] std::uint32_t pushed_number(BodyRef body) const {
    return !body.is_standing() && constants_[body.number()].is_pushed() ? body.number() : 0;
  }

  /// Gathers the data of rows `first` … `end` − 1 from the records.
  void fill(const ContactScene& scene, std::size_t first, std::size_t end);

  /// Adds gravity, forces and the warm start to a body's velocity at the beginning of a substep.
  void integrate_velocity(bool is_first, std::uint32_t number);
  /// Adds its velocity to its travel.
  void integrate_position(std::uint32_t number);

  /// Clears the velocity along locked axes of moving.
  void apply_axis_locks(std::uint32_t number);
  [[nodiscard]] bool has_axis_locks() const {
    return has_axis_locks_.load(std::memory_order_relaxed);
  }

  /// By number.
  [[nodiscard]] std::span<SolverBody> constants() { return std::span(constants_).first(count()); }
  [[nodiscard]] std::span<const SolverBody> constants() const {
    return std::span(constants_).first(count());
  }
  /// By row.
  [[nodiscard]] std::span<lanes::BodyVelocity> rows() { return rows_; }
  [[nodiscard]] std::span<const lanes::BodyVelocity> rows() const { return rows_; }
  /// Velocities at the beginning of the substep; before the first: those of the warm start.
  [[nodiscard]] std::span<lanes::BodyVelocity> before() { return before_; }
  [[nodiscard]] std::span<const lanes::DeltaPose> travel() const { return travel_; }
  [[nodiscard]] std::span<lanes::BodyInertia> inertias() { return inertias_; }

 private:
  void fill_numbered(const ContactScene& scene, std::size_t number);

  TimeStep step_;
  std::vector<std::uint32_t> number_of_;  // by body of the world: the first of its numbers, or 0
  std::vector<BodySide> sides_;           // by number
  std::vector<SolverBody> constants_;     // by number
  std::vector<lanes::BodyInertia> inertias_;
  std::vector<lanes::BodyVelocity> rows_;
  std::vector<lanes::BodyVelocity> before_;
  std::vector<lanes::DeltaPose> travel_;
  std::uint32_t standing_count_ = 0;
  std::atomic<bool> has_axis_locks_{false};  // any locked axis of moving
};

}  // namespace lockstone
