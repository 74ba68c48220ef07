#include "core/dynamics/step/contacts/solved_motion.h"

#include <algorithm>
#include <cstdlib>

#include <lockstone/assert.h>

#include "core/base/reserved.h"
#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/body/motion.h"
#include "core/geometry/distance/manifold_checks.h"

namespace lockstone {
namespace {

using lanes::BodyVelocity;
using lanes::DeltaPose;

}  // namespace

SolvedMotion::SolvedMotion(const TimeStep& step, std::size_t number_capacity,
                           const SolverBodies& bodies)
    : step_(step), bodies_(bodies) {
  axes_.reserve(number_capacity);
}

void SolvedMotion::reserve() {
  LKS_ASSERT(is_reserved(axes_, bodies_.count()));
  if (axes_.size() < bodies_.count()) axes_.resize(bodies_.count());
}

void SolvedMotion::clear(std::size_t first, std::size_t end) {
  LKS_ASSERT(end <= axes_.size());
  for (std::size_t i = first; i < end; ++i)
    axes_[i] = {};
}

void SolvedMotion::note_push(const ContactRef& contact, const Vec3<Unit>& normal) {
  for (const BodyRef body : {contact.a, contact.b})
    if (!body.is_standing()) axes_[body.number()].add(normal);
}

// Normals that lean by less than 2^-10 are one.
void SolvedMotion::PushAxis::add(const Vec3<Unit>& n) {
  constexpr std::int64_t k_parallel = (std::int64_t{1} << 60) - (std::int64_t{1} << 40);
  if (!pushed) normal = n;
  mixed = mixed || (pushed && std::abs(dot(normal, n).raw) < k_parallel);
  pushed = true;
}

// Positions went with the velocities at the ends of substeps. Half a substep of the velocity gained
// in the tick, taken back, makes that the mean of beginning and end: friction and gravity along a
// surface act to second order. Along the normal, contacts have placed the body, and it stays.
Vec3<Velocity> SolvedMotion::half_step_back(std::uint32_t number, const BodyRecord& body) const {
  LKS_ASSERT(number > 0 && number < axes_.size());
  const PushAxis& axis = axes_[number];
  if (axis.mixed) return {};
  Vec3<Velocity> gain = velocity_of_row(bodies_.rows()[number].velocity) - body.velocity;
  if (axis.pushed) {
    const auto times = [](Velocity v, Unit u) {
      return Velocity::from_raw(raw::multiply_shift(v.raw, u.raw, Unit::frac_bits));
    };
    const Vec3<Unit>& n = axis.normal;
    LKS_ASSERT(geometry::is_unit(n));
    const Velocity along = times(gain.x, n.x) + times(gain.y, n.y) + times(gain.z, n.z);
    for (int i = 0; i < 3; ++i)
      gain[i] -= times(along, n[i]);
  }
  for (int i = 0; i < 3; ++i)
    if (bodies_.constants()[number].is_locked(i)) gain[i] = {};
  const auto half = [&](Velocity v) {
    return Velocity::from_raw(raw::round_divide(step_.substep.times(v.raw), 2));
  };
  return {half(gain.x), half(gain.y), half(gain.z)};
}

std::array<Vec3<Velocity>, 2> SolvedMotion::speeds(std::uint32_t number) const {
  const BodyVelocity& row = bodies_.rows()[number];
  return {velocity_of_row(row.velocity), velocity_of_row(row.spin)};
}

std::uint32_t SolvedMotion::scatter(std::uint32_t number, const Mat3& rotation,
                                    const JointPose* pose, BodyRecord& body) const {
  LKS_ASSERT(number != 0 && number < bodies_.count());
  const BodyVelocity& row = bodies_.rows()[number];
  const Vec3<Velocity> back =
      pose == nullptr && body.is_dynamic() ? half_step_back(number, body) : Vec3<Velocity>{};
  if (body.is_dynamic()) {
    body.velocity = velocity_of_row(row.velocity);
    body.spin = velocity_of_row(row.spin);
  }
  if (pose != nullptr) {
    body.position = pose->position;
    body.orientation = pose->orientation;
    return 0;
  }
  const DeltaPose& travel = bodies_.travel()[number];
  const auto moved = [&](std::int64_t sum) { return Velocity::from_raw(step_.substep.times(sum)); };
  // A component that did not move has nothing to take back.
  const auto gone = [&](std::int64_t sum, Velocity too_far) {
    return sum == 0 ? Velocity{} : moved(sum) - too_far;
  };
  return end_substeps(
      body, rotation,
      {gone(travel.velocity[0], back.x), gone(travel.velocity[1], back.y),
       gone(travel.velocity[2], back.z)},
      {moved(travel.surface[0]), moved(travel.surface[1]), moved(travel.surface[2])}, step_);
}

}  // namespace lockstone
