// Joints among the contacts of a tick.

#include "core/dynamics/body/lane_bodies.h"
#include "core/dynamics/linkage/joint_solver.h"
#include "core/dynamics/step/contact_solver.h"

namespace lockstone {

JointRun ContactSolver::joint_run() {
  return {bodies_, rows_, before_, inertias_, places_};
}

// Joints use number 0 for bodies that never move.
void ContactSolver::take_up_joints(const ContactScene& scene) {
  if (scene.joint_links.empty() && joints_->empty()) return;
  joints_->clear();
  for (const JointLink& link : scene.joint_links) {
    const auto side = [&](std::uint32_t body) -> JointSolver::Side {
      std::uint32_t index = solver_index_[body];
      if (index == 0 && scene.bodies[body].moves())
        index = take_up({body, static_cast<MotionType>(scene.bodies[body].motion)});
      return {body, index, scene.bodies[body], scene.rotations[body]};
    };
    const JointSolver::Side a = side(link.body_a), b = side(link.body_b);
    joints_->add(scene.joints[link.joint], a, b);
  }
  take_up_net(scene);
}

// Precondition: all bodies have their numbers. A body that stands still has a row of its own in
// each joint of a net, as in each contact.
void ContactSolver::take_up_net(const ContactScene& scene) {
  const std::span<const std::uint32_t> in_net = joints_->plan(first_without_contacts_);
  net_.clear(in_net.empty() ? 0 : static_cast<std::uint32_t>(members_.size()));
  for (const std::uint32_t i : in_net) {
    const JointLink& link = scene.joint_links[i];
    const auto end = [&](std::uint32_t body) -> JointNet::End {
      const bool pushed = solver_index_[body] != 0;
      const std::uint32_t index = pushed ? solver_index_[body] : k_immovable | immovables_++;
      return {row_of(index), &scene.bodies[body], &scene.rotations[body], pushed};
    };
    const JointNet::End a = end(link.body_a), b = end(link.body_b);
    net_.add(i, scene.joints[link.joint], a, b);
  }
  net_.lay_out();
}

void ContactSolver::begin_joints() {
  joints_->begin({bodies_, rows_, {}, {}, {}});
  for (std::size_t i = 1; i < members_.size(); ++i)
    inertias_[i] = source_body(bodies_[i].inverse_inertia);
}

void ContactSolver::store_joints(std::span<const JointLink> links, std::span<JointRecord> joints,
                                 Parallel& parallel) const {
  if (links.empty()) return;
  constexpr std::uint32_t k_slot_grain = 64;
  if (joints_->has_own()) {
    for (std::size_t i = 0; i < links.size(); ++i)
      joints_->store(i, joints[links[i].joint]);
  }
  parallel.for_each({net_.slot_count(), k_slot_grain},
                    [&](std::size_t first, std::size_t end, std::uint32_t) {
                      net_.store(links, joints, first, end);
                    });
}

}  // namespace lockstone
