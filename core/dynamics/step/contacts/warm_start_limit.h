// Limits the energy of the impulses with which iterated islands begin a tick.
//
// The impulses of the tick before belong to the poses of that tick. Those of a hit in its last
// substep, or of a converged island that is iterated from now on, may be many times the load that
// bodies carry; where the contacts have turned since, they would throw bodies apart. So where the
// warm start would raise the kinetic energy of an island by more than a quarter, only the share of
// it with the least energy is given, as for joints (core/dynamics/linkage/rows/cluster_energy.h).
// Converged islands scale theirs always (core/dynamics/direct/phase_solver.h). Islands with joints
// are left out: there contacts and joints push against each other, and `EnergyLimit` watches them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/step/contacts/constraint_layout.h"
#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/solver_bodies.h"
#include "core/dynamics/step/islands/island_builder.h"
#include "core/math/block_float.h"

namespace lockstone {

class WarmStartLimit {
 public:
  struct Parts {
    SolverBodies& bodies;
    const ContactList& contacts;
    const IslandBuilder& islands;
    const ConstraintLayout& layout;
  };

  /// `parts` must outlive it. No function but this allocates.
  [[gnu::cold]] WarmStartLimit(std::size_t body_capacity, const Parts& parts);

  /// Once all impulses of the tick's beginning are known: those of single contacts, and the
  /// velocities that they give to bodies.
  void limit(const ContactRun& run);

 private:
  // Of an island, twice energies by the mass of its first body.
  struct Island {
    BlockFloat unit{};             // inverse mass
    bool is_pushed_hard = false;   // the energies are summed
    std::int64_t free = 0;         // without the warm start
    std::int64_t square = 0;       // of the velocities that it gives
    std::int64_t linear = 0;       // of these and the free ones
    std::int32_t share = 1 << 30;  // of the warm start that is given, Q30
  };

  [[nodiscard]] bool find_hard_pushes();
  void sum_energies();
  void choose_shares();
  void scale_bodies();
  void scale_contacts(const ContactRun& run);

  Parts parts_;
  std::vector<Island> islands_;
};

}  // namespace lockstone
