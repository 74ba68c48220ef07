// Joints among the contacts of a tick.

#include "core/dynamics/contact_solver.h"

namespace lockstone {

// What never moves is number 0 to joints.
void ContactSolver::take_up_joints(const ContactScene& scene) {
  joints_.clear();
  for (const JointLink& link : scene.joint_links) {
    const auto side = [&](std::uint32_t body) -> JointSolver::Side {
      std::uint32_t index = solver_index_[body];
      if (index == 0 && scene.bodies[body].moves()) index = take_up(scene, body);
      return {body, index, scene.bodies[body], scene.rotations[body]};
    };
    const JointSolver::Side a = side(link.body_a), b = side(link.body_b);
    joints_.add(scene.joints[link.joint], a, b);
  }
}

void ContactSolver::begin_joints() {
  joints_.begin({bodies_, rows_, {}, {}}, first_without_contacts_);
  for (std::size_t i = 1; i < members_.size(); ++i) {
    const InverseInertia& m = bodies_[i].inverse_inertia;
    inertias_[i].inertia = {m.xx, m.yy, m.zz, m.xy, m.xz, m.yz};
  }
}

void ContactSolver::store_joints(std::span<const JointLink> links,
                                 std::span<JointRecord> joints) const {
  for (std::size_t i = 0; i < links.size(); ++i)
    joints_.store(i, joints[links[i].joint]);
}

void ContactSolver::run_joints(bool relaxes, bool after) {
  const JointRun run = joint_run();
  if (!relaxes) {
    if (after) joints_.warm_start(run);
    return;
  }
  if (!after) return joints_.solve(run);
  joints_.move(run);
  joints_.relax(run);
}

}  // namespace lockstone
