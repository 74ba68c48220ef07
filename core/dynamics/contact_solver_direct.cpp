// Contacts of uneven masses in the contact solver: which there are, and what is lent to them.

#include "core/dynamics/contact_solver.h"
#include "core/dynamics/joint_solver.h"

namespace lockstone {

// Nothing unless a contact is uneven. Bodies with locks or joints are left to the sweeps, which
// know of both.
void ContactSolver::take_up_direct() {
  direct_.clear();
  if (!uneven_) return;
  const std::span<const ConstraintGraph::Place> places = graph_.places();
  const auto number = [&](std::uint32_t index) {
    return (index & k_immovable) == 0 && bodies_[index].is_pushed() ? index : 0;
  };
  for (std::size_t i = 0; i < entries_.size(); ++i) {
    const Entry& entry = entries_[i];
    const std::size_t slot = ranges_[places[i].color].first * lanes::k_block_lanes + places[i].rank;
    const std::int64_t share =
        blocks_[slot / lanes::k_block_lanes].share[slot % lanes::k_block_lanes];
    direct_.add({static_cast<std::uint32_t>(slot), number(entry.body_a), number(entry.body_b),
                 row_of(entry.body_a), row_of(entry.body_b), static_cast<std::int32_t>(share)});
  }
  for (std::uint32_t i = 1; i < members_.size(); ++i)
    if (bodies_[i].held != 0 || joints_->find(members_[i]) != nullptr) direct_.leave_out(i);
  direct_.plan(direct_run());
}

DirectRun ContactSolver::direct_run() {
  return {rows_, std::span(bodies_).first(members_.size()), blocks_, rules_};
}

}  // namespace lockstone
