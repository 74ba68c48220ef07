#include "core/dynamics/step/input/solver_bodies.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/base/reserved.h"
#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/body/motion.h"

namespace lockstone {
namespace {

using lanes::BodyVelocity;
using lanes::DeltaPose;

// The greatest speed of a body in a substep along each axis: 1000 m/s, Q50. Sums of sixteen
// substeps can be read.
constexpr std::int64_t k_row_limit = std::int64_t{1000} << lanes::k_velocity_bits;

std::int64_t to_row(Velocity v) {
  return v.raw << k_grid_to_row;
}

std::int64_t within_limit(std::int64_t x) {
  return std::clamp(x, -k_row_limit, k_row_limit);
}

// One component of a body in the first substep. `before` holds the velocity that the impulses of
// the last tick give, and receives the component as it was.
void start_component(std::int64_t gain, std::int64_t& now, std::int64_t& before) {
  const std::int64_t start = within_limit(now), warm = within_limit(before);
  now = start + gain * (std::int64_t{1} << k_grid_to_row) + warm;
  before = start;
}

// In a later substep it gains as much as in the one before.
void repeat_component(std::int64_t& now, std::int64_t& before) {
  const std::int64_t start = within_limit(now);
  now = 2 * start - before;
  before = start;
}

}  // namespace

SolverBodies::SolverBodies(const TimeStep& step, std::size_t body_capacity,
                           std::size_t contact_capacity, std::size_t joint_capacity)
    : step_(step), number_of_(body_capacity) {
  LKS_ASSERT(body_capacity <= std::size_t{1} << 29);
  const std::size_t most_numbers = body_capacity + contact_capacity + 1;
  const std::size_t most_rows = most_numbers + joint_capacity;
  sides_.reserve(most_numbers);
  constants_.reserve(most_numbers);
  rows_.reserve(most_rows);
  inertias_.reserve(most_rows);
  before_.reserve(most_rows);
  travel_.reserve(most_rows);
}

void SolverBodies::clear() {
  for (const BodySide side : sides_)
    number_of_[side.body()] = 0;
  sides_.assign(1, {});
  standing_count_ = 0;
  has_axis_locks_ = false;
}

BodyRef SolverBodies::add(BodySide side) {
  if (side.motion() == MotionType::static_body) return add_standing();
  const std::uint32_t number = count();
  LKS_ASSERT(is_reserved(sides_, std::size_t{number} + 1));
  if (number_of_[side.body()] == 0) number_of_[side.body()] = number;
  sides_.push_back(side);
  return BodyRef::numbered(number);
}

// Rows only grow, within their capacity.
void SolverBodies::reserve_rows() {
  LKS_ASSERT(is_reserved(rows_, row_count()));
  if (constants_.size() < count()) constants_.resize(count());
  if (rows_.size() >= row_count()) return;
  inertias_.resize(row_count());
  rows_.resize(row_count());
  before_.resize(row_count());
  travel_.resize(row_count());
}

void SolverBodies::fill(const ContactScene& scene, std::size_t first, std::size_t end) {
  LKS_ASSERT(end <= row_count());
  for (std::size_t row = first; row < end; ++row) {
    inertias_[row] = {};
    rows_[row] = before_[row] = {};
    travel_[row] = {};
    if (row >= 1 && row < sides_.size()) fill_numbered(scene, row);
  }
}

void SolverBodies::fill_numbered(const ContactScene& scene, std::size_t number) {
  LKS_ASSERT(number > 0 && number < sides_.size() && number < constants_.size());
  const std::uint32_t body = sides_[number].body();
  LKS_ASSERT(body < scene.bodies.size());
  const BodyRecord& record = scene.bodies[body];
  SolverBody& constants = constants_[number];
  constants = solver_body(record, scene.rotations[body], scene.gravity, step_);
  if (constants.locked != 0) has_axis_locks_.store(true, std::memory_order_relaxed);
  inertias_[number] = body_inertia(constants.inverse_inertia);
  for (int i = 0; i < 3; ++i) {
    rows_[number].velocity[static_cast<std::size_t>(i)] = to_row(record.velocity[i]);
    rows_[number].spin[static_cast<std::size_t>(i)] = to_row(record.spin[i]);
  }
}

// In the first substep: gravity and the impulses of the tick before. Later ones start with the
// impulses that the substep before ended with. All responses are fixed for a tick, so these
// impulses and gravity give a body the same velocity as in the substep before.
void SolverBodies::integrate_velocity(bool is_first, std::uint32_t number) {
  LKS_ASSERT(number > 0 && number < count());
  BodyVelocity& row = rows_[number];
  BodyVelocity& before = before_[number];
  const SolverBody& body = constants_[number];
  for (std::size_t axis = 0; axis < 3; ++axis) {
    if (is_first) {
      start_component(body.gain[axis], row.velocity[axis], before.velocity[axis]);
      start_component(body.spin_gain[axis], row.spin[axis], before.spin[axis]);
    } else {
      repeat_component(row.velocity[axis], before.velocity[axis]);
      repeat_component(row.spin[axis], before.spin[axis]);
    }
  }
  apply_axis_locks(number);
}

// Preparation gives locked axes no response; here the velocity that a push left there is cleared.
void SolverBodies::apply_axis_locks(std::uint32_t number) {
  if (constants_[number].locked == 0) return;
  for (int axis = 0; axis < 3; ++axis) {
    if (constants_[number].is_locked(axis))
      rows_[number].velocity[static_cast<std::size_t>(axis)] = 0;
  }
}

void SolverBodies::integrate_position(std::uint32_t number) {
  LKS_ASSERT(number > 0 && number < count());
  const SolverBody& body = constants_[number];
  if (body.is_pushed() && is_still(rows_[number])) return;
  const BodyVelocity row = body.is_alone ? steadied(rows_[number]) : rows_[number];
  DeltaPose& travel = travel_[number];
  const std::array<std::int64_t, 3> spin = {within_limit(row.spin[0]), within_limit(row.spin[1]),
                                            within_limit(row.spin[2])};
  const std::array<std::int64_t, 3> surface = surface_velocity(body.inverse_inertia, spin);
  for (std::size_t axis = 0; axis < 3; ++axis) {
    travel.velocity[axis] += within_limit(row.velocity[axis]) >> k_grid_to_row;
    travel.surface[axis] += surface[axis];
  }
}

}  // namespace lockstone
