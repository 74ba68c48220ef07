#include "core/dynamics/step/input/tick_joints.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/body/lane_bodies.h"

namespace lockstone {

TickJoints::TickJoints(const TimeStep& step, std::size_t body_capacity,
                       std::size_t contact_capacity, std::size_t joint_capacity, bool solves_loops,
                       SolverBodies& bodies)
    : bodies_(bodies),
      solver_(std::make_unique<JointSolver>(step, body_capacity, joint_capacity, solves_loops)),
      balls_(step.substep_rate(), joint_capacity == 0 ? 0 : body_capacity, joint_capacity) {
  if (joint_capacity != 0) places_.reserve(body_capacity + contact_capacity + 1 + joint_capacity);
}

// Joints use number 0 for bodies that never move.
void TickJoints::gather(const ContactScene& scene) {
  first_without_contacts_ = bodies_.count();
  if (scene.joint_links.empty() && solver_->empty()) return;
  solver_->clear(scene.assets);
  for (const JointLink& link : scene.joint_links) {
    LKS_ASSERT(link.joint < scene.joints.size());
    LKS_ASSERT(link.body_a < scene.bodies.size() && link.body_b < scene.bodies.size());
    const auto side = [&](std::uint32_t body) -> JointSolver::Side {
      const BodyRecord& record = scene.bodies[body];
      std::uint32_t number = bodies_.number_of(body);
      if (number == 0 && record.moves())
        number = bodies_.add({body, static_cast<MotionType>(record.motion)}).number();
      return {body, number, record, scene.rotations[body]};
    };
    const JointSolver::Side a = side(link.body_a), b = side(link.body_b);
    solver_->add(scene.joints[link.joint], a, b);
  }
  gather_balls(scene);
}

// Precondition: all bodies have their numbers. A body that stands still has a row of its own in
// each coloured ball joint, as in each contact.
void TickJoints::gather_balls(const ContactScene& scene) {
  const std::span<const std::uint32_t> coloured = solver_->plan(first_without_contacts_);
  balls_.clear(coloured.empty() ? 0 : bodies_.count());
  for (const std::uint32_t i : coloured) {
    LKS_ASSERT(i < scene.joint_links.size());
    const JointLink& link = scene.joint_links[i];
    const auto end = [&](std::uint32_t body) -> ColouredBalls::End {
      const std::uint32_t number = bodies_.number_of(body);
      const BodyRef ref = number != 0 ? BodyRef::numbered(number) : bodies_.add_standing();
      return {bodies_.row_of(ref), number != 0};
    };
    const ColouredBalls::End a = end(link.body_a), b = end(link.body_b);
    balls_.add(i, scene.joints[link.joint], solver_->added(i).has_other_impulses, a, b);
  }
  balls_.lay_out();
}

void TickJoints::reserve_rows() {
  if (!balls_.empty() && places_.size() < bodies_.row_count()) places_.resize(bodies_.row_count());
}

void TickJoints::begin() {
  solver_->begin({bodies_.constants(), bodies_.rows(), {}, {}, {}});
  const std::span<const SolverBody> constants = bodies_.constants();
  for (std::size_t i = 1; i < constants.size(); ++i)
    bodies_.inertias()[i] = body_inertia(constants[i].inverse_inertia);
}

JointRun TickJoints::run() {
  return {bodies_.constants(), bodies_.rows(), bodies_.before(), bodies_.inertias(), places_};
}

ColouredBallsRun TickJoints::balls_run() {
  return {bodies_.rows().data(), bodies_.before().data(), bodies_.inertias().data(),
          bodies_.constants().data(), places_.data()};
}

void TickJoints::store(std::span<const JointLink> links, std::span<JointRecord> joints,
                       Parallel& parallel) const {
  if (links.empty()) return;
  LKS_ASSERT(std::ranges::all_of(
      links, [&](const JointLink& link) { return link.joint < joints.size(); }));
  constexpr std::uint32_t k_lane_grain = 64;
  if (solver_->has_own()) {
    for (std::size_t i = 0; i < links.size(); ++i)
      solver_->store(i, joints[links[i].joint]);
  }
  parallel.for_each({balls_.lane_count(), k_lane_grain},
                    [&](std::size_t first, std::size_t end, std::uint32_t) {
                      balls_.store(links, joints, first, end);
                    });
}

}  // namespace lockstone
