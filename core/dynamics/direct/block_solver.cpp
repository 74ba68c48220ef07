#include "core/dynamics/direct/block_solver.h"

#include <lockstone/assert.h>

#include "core/dynamics/direct/contact_phases.h"
#include "core/dynamics/direct/contact_speeds.h"
#include "core/dynamics/direct/phase_solver.h"
#include "core/dynamics/direct/push_limit.h"

namespace lockstone {
namespace {

// Adds the velocities that the phase gave to bodies to the speeds of the rows.
void add_to_speeds(const IslandView& island) {
  lanes::proximal_kernels().update_residuals(island.problems.data(), island.problems.size(),
                                             island.velocities.data(),
                                             30 + island.state.bits - k_row_unit_bits);
}

}  // namespace

void BlockSolver::clear(std::uint32_t first_free) {
  first_free_ = first_free;
  islands_.clear();
}

void BlockSolver::begin(const ContactRun& run, std::uint32_t index, std::int64_t weight,
                        int substeps) {
  const IslandView island = islands_.view(index);
  contact_phases::begin(run, island, weight, substeps);
  if (island.state.is_measured) begin_measuring(run, island);
}

void BlockSolver::solve(const ContactRun& run, const JointAccess& joints, std::uint32_t index,
                        bool pushes_out) {
  const IslandView island = islands_.view(index);
  LKS_ASSERT(!island.contacts.empty() || !island.joints.empty());
  if (pushes_out)
    contact_phases::begin_substep(island);
  else
    contact_phases::return_leaks(island);
  if (!island.joints.empty()) joint_phases::update(run, joints, island, first_free_, pushes_out);
  if (island.state.is_measured) measure_again(run, island);
  contact_phases::set_biases(run, island, pushes_out);
  contact_phases::loosen(island);
  PhaseSolver phase(island, islands_.factor());
  if (!phase.set_units()) return;
  phase.solve(pushes_out);
  if (pushes_out && island.joints.empty() && limits_pushes(run, island)) phase.solve(pushes_out);
  if (!phase.is_done()) ++island.state.unsolved;
  if (island.state.warms)
    for (lanes::ProximalBlock& problem : island.problems)
      problem.warm = {};
  island.state.warms = false;
  contact_phases::give(run, island);
  joint_phases::give(joints, island);
  add_to_speeds(island);
}

void BlockSolver::end(const ContactRun& run, std::uint32_t index) {
  contact_phases::end(run, islands_.view(index));
}

}  // namespace lockstone
