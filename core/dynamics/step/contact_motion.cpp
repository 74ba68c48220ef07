// Where contacts took bodies in a tick.

#include <cstdlib>

#include "core/dynamics/body/motion.h"
#include "core/dynamics/contact/recycling_pose.h"
#include "core/dynamics/linkage/joint_solver.h"
#include "core/dynamics/step/contact_solver.h"

namespace lockstone {
namespace {

using lanes::RowBody;
using lanes::RowTravel;

// From the Q50 of rows to the Q32 of velocities.
Velocity from_row(std::int64_t row) {
  return Velocity::from_raw(row >> (lanes::k_velocity_bits - lanes::k_grid_bits));
}

}  // namespace

// In the order of colours.
void ContactSolver::add_axes(const Entry& entry, const Vec3<Unit>& normal) {
  for (const std::uint32_t index : {entry.body_a, entry.body_b})
    if ((index & k_immovable) == 0) axes_[index].add(normal);
}

// Normals that lean by less than 2^-10 are one.
void ContactSolver::PushAxis::add(const Vec3<Unit>& n) {
  constexpr std::int64_t k_parallel = (std::int64_t{1} << 60) - (std::int64_t{1} << 40);
  if (!pushed) normal = n;
  mixed = mixed || (pushed && std::abs(dot(normal, n).raw) < k_parallel);
  pushed = true;
}

// Positions went with the velocities at the ends of substeps. Half a substep of the velocity gained
// in the tick, taken back, makes that the mean of beginning and end: friction and gravity along a
// surface act to second order. Along the normal, contacts have placed the body, and it stays.
Vec3<Velocity> ContactSolver::half_step_back(std::size_t index, const BodyRecord& body) const {
  const PushAxis& axis = axes_[index];
  if (axis.mixed) return {};
  const RowBody& row = rows_[index];
  Vec3<Velocity> gain;
  for (int i = 0; i < 3; ++i)
    gain[i] = from_row(row.velocity[static_cast<std::size_t>(i)]) - body.velocity[i];
  if (axis.pushed) {
    const auto times = [](Velocity v, Unit u) {
      return Velocity::from_raw(raw::multiply_shift(v.raw, u.raw, Unit::frac_bits));
    };
    const Vec3<Unit>& n = axis.normal;
    const Velocity along = times(gain.x, n.x) + times(gain.y, n.y) + times(gain.z, n.z);
    for (int i = 0; i < 3; ++i)
      gain[i] -= times(along, n[i]);
  }
  for (int i = 0; i < 3; ++i)
    if (bodies_[index].is_held(i)) gain[i] = {};
  const auto half = [&](Velocity v) {
    return Velocity::from_raw(raw::round_divide(step_.substep.times(v.raw), 2));
  };
  return {half(gain.x), half(gain.y), half(gain.z)};
}

bool ContactSolver::keeps_contact_pose(std::uint32_t body, const BodyRecord& record) const {
  const std::uint32_t index = solver_index_[body];
  const std::uint32_t island = index == 0 ? 0 : islands_.of(index);
  if (island == 0 || islands_.load(island).is_converged) return false;
  const bool is_heap = islands_.load(island).is_heap();
  return is_near_contact_pose(record, is_heap ? k_fine_drift : k_coarse_drift);
}

const SolverBody* ContactSolver::find(std::uint32_t body) const {
  const std::uint32_t index = solver_index_[body];
  return index == 0 ? nullptr : &bodies_[index];
}

std::array<Vec3<Velocity>, 2> ContactSolver::speeds(const SolverBody& solved) const {
  const RowBody& row = rows_[static_cast<std::size_t>(&solved - bodies_.data())];
  const auto read = [](const auto& v) -> Vec3<Velocity> {
    return {from_row(v[0]), from_row(v[1]), from_row(v[2])};
  };
  return {read(row.velocity), read(row.spin)};
}

std::uint32_t ContactSolver::move(const SolverBody& solved, const Mat3& rotation,
                                  BodyRecord& body) {
  const auto index = static_cast<std::size_t>(&solved - bodies_.data());
  if (!bounces_ || !body.is_dynamic()) return move(index, rotation, body);
  const BodyRecord start = body;
  const std::uint32_t turns = move(index, rotation, body);
  note_gain(index, body, start);
  return turns;
}

std::uint32_t ContactSolver::move(std::size_t index, const Mat3& rotation, BodyRecord& body) const {
  const RowBody& row = rows_[index];
  const RowTravel& travel = travel_[index];
  const Vec3<Velocity> back = body.is_dynamic() ? half_step_back(index, body) : Vec3<Velocity>{};
  const auto moved = [&](std::int64_t sum) { return Velocity::from_raw(step_.substep.times(sum)); };
  // A component that did not move has nothing to take back.
  const auto gone = [&](std::int64_t sum, Velocity too_far) {
    return sum == 0 ? Velocity{} : moved(sum) - too_far;
  };
  if (body.is_dynamic()) {
    body.velocity = {from_row(row.velocity[0]), from_row(row.velocity[1]),
                     from_row(row.velocity[2])};
    body.spin = {from_row(row.spin[0]), from_row(row.spin[1]), from_row(row.spin[2])};
  }
  if (const JointPose* pose = joints_->find(members_[index]); pose != nullptr) {
    body.position = pose->position;
    body.orientation = pose->orientation;
    return 0;
  }
  return end_substeps(
      body, rotation,
      {gone(travel.velocity[0], back.x), gone(travel.velocity[1], back.y),
       gone(travel.velocity[2], back.z)},
      {moved(travel.surface[0]), moved(travel.surface[1]), moved(travel.surface[2])}, step_);
}

}  // namespace lockstone
