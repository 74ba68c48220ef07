// Solves each small island's contacts and joints to convergence: one proximal problem a phase, two
// phases a substep.
//
// `PhaseSolver` has the method. Rows and factors of an island stay for the tick where they can.
#pragma once

#include <cstdint>
#include <span>

#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/direct/island_pool.h"
#include "core/dynamics/direct/joint_phases.h"

namespace lockstone {

class BlockSolver {
 public:
  /// No function but this allocates.
  [[gnu::cold]] explicit BlockSolver(const IslandPool::Capacity& capacity) : islands_(capacity) {}

  /// `first_free`: bodies of this number or above touch nothing.
  void clear(std::uint32_t first_free);

  /// The islands of the tick. All are added before `begin`.
  [[nodiscard]] IslandPool& islands() { return islands_; }
  [[nodiscard]] const IslandPool& islands() const { return islands_; }
  [[nodiscard]] std::uint32_t count() const { return islands_.count(); }

  /// Once blocks are prepared: takes contacts over from the iterations. `weight` is gravity's gain
  /// in a substep, m/s, Q32.
  void begin(const ContactRun& run, std::uint32_t island, std::int64_t weight, int substeps);

  /// One phase. With `pushes_out` overlap goes.
  void solve(const ContactRun& run, const JointAccess& joints, std::uint32_t island,
             bool pushes_out);

  /// After the last phase: writes the impulses to the blocks, and gives the contacts back to the
  /// iterations.
  void end(const ContactRun& run, std::uint32_t island);

 private:
  IslandPool islands_;
  std::uint32_t first_free_ = 0;
};

}  // namespace lockstone
