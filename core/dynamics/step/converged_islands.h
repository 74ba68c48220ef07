// The islands of a tick that are solved to convergence: chooses them, and hands their contacts and
// joints to the block solver.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/direct/block_solver.h"
#include "core/dynamics/step/contacts/constraint_layout.h"
#include "core/dynamics/step/input/tick_joints.h"
#include "core/dynamics/step/islands/effort_policy.h"
#include "core/dynamics/step/islands/island_lists.h"

namespace lockstone {

class ConvergedIslands {
 public:
  /// No function but this allocates. `contacts`: of all converged islands, with their joints.
  [[gnu::cold]] ConvergedIslands(const TimeStep& step, std::size_t body_capacity,
                                 std::size_t contact_capacity, std::size_t joint_capacity,
                                 std::size_t converged_contacts,
                                 std::uint32_t most_island_contacts);

  [[nodiscard]] std::uint32_t count() const { return solver_.count(); }

  /// Their places in pools.
  [[nodiscard]] const IslandPool& pool() const { return solver_.islands(); }

  /// Contacts of all these islands.
  [[nodiscard]] std::span<const ProximalContact> contacts() { return solver_.islands().contacts(); }

  /// Once islands are built: chooses, and takes the joints of chosen islands from the joint solver.
  void plan(const ContactScene& scene, const SolverBodies& bodies, const ContactList& contacts,
            const EffortPolicy& effort, IslandBuilder& islands, TickJoints& joints);

  /// The parts of a tick that `begin` reads; of `bodies` it writes to `before`.
  struct Tick {
    const ContactScene& scene;
    SolverBodies& bodies;
    const ContactList& contacts;
    const IslandBuilder& islands;
    const ConstraintLayout& layout;
  };
  /// Once blocks are prepared: takes the contacts of islands `first` … `end` − 1 over from the
  /// iterations.
  void begin(const Tick& tick, const ContactRun& run, std::size_t first, std::size_t end);

  /// The bodies, contacts and joints of all islands.
  [[nodiscard]] const IslandLists& lists() const { return lists_; }

  /// Leaves an island, by its number here, to `WholeIslands`.
  IslandView take(std::uint32_t island);
  [[nodiscard]] std::span<const ProximalContact> contacts(std::uint32_t island) {
    return solver_.islands().view(island).contacts;
  }

  /// One phase of an island. With `pushes_out` overlap goes.
  void solve(const ContactRun& run, TickJoints& joints, std::uint32_t island, bool pushes_out) {
    solver_.solve(run, {joints.solver().island_joints(), joints.run()}, island, pushes_out);
  }
  /// After its last phase.
  void end(const ContactRun& run, std::uint32_t island) { solver_.end(run, island); }

  /// After the last phase: marks the islands that are given up.
  void give_up(const EffortPolicy& effort, const ContactRun& run, IslandBuilder& islands);

  /// Once impulses are stored: contacts of islands that are given up, and stand, are new again.
  void forget(const ContactList& contacts, std::span<ContactRecord> records);

  /// Calls `work(island)` for islands `first` … `end` − 1 that are not solved whole.
  template <class Work>
  void for_staged(std::size_t first, std::size_t end, const Work& work) const {
    for (auto i = static_cast<std::uint32_t>(first); i < end; ++i)
      if (!solver_.islands().state(i).is_whole) work(i);
  }

 private:
  void begin(const Tick& tick, const ContactRun& run, std::uint32_t island, std::int64_t weight);
  void list(const ContactList& contacts, const IslandBuilder& islands, TickJoints& joints,
            std::uint32_t island);

  TimeStep step_;
  BlockSolver solver_;
  IslandLists lists_;
  std::vector<std::uint32_t> bodies_;  // of the island at hand
  std::vector<IslandContact> contacts_;
  std::vector<IslandJoint> joints_;
};

}  // namespace lockstone
