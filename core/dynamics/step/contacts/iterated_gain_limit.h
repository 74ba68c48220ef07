// Limits the kinetic energy that iterated islands gain.
//
// The impulses of the tick before belong to the poses of that tick. Those of a hit in its last
// substep, or of a converged island that is iterated from now on, may be many times the load that
// bodies carry; where the contacts have turned since, they would throw bodies apart. Likewise a
// substep repeats the impulses of the one before, and in a jam one iteration does not take back a
// hit that is repeated, nor velocities that part overlapping bodies.
//
// So where the warm start of a tick would raise the kinetic energy of an island by more than a
// quarter, or velocities within the tick are by a quarter above those of the tick's beginning, only
// the share of the impulses with the least energy is given, as for joints
// (core/dynamics/linkage/rows/cluster_energy.h). Converged islands have limits of their own
// (core/dynamics/direct/phase_solver.h, push_limit.h). Islands with joints are left out: there
// contacts and joints push against each other, and `EnergyLimit` watches them. So are, within the
// tick, islands that moving kinematic bodies or driven surfaces may give energy.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/step/contacts/constraint_layout.h"
#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/contact_scene.h"
#include "core/dynamics/step/input/solver_bodies.h"
#include "core/dynamics/step/islands/island_builder.h"
#include "core/math/block_float.h"

namespace lockstone {

class IteratedGainLimit {
 public:
  struct Parts {
    SolverBodies& bodies;
    const ContactList& contacts;
    IslandBuilder& islands;
    const ConstraintLayout& layout;
    int substeps;
  };

  /// `parts` must outlive it. No function but this allocates.
  [[gnu::cold]] IteratedGainLimit(std::size_t body_capacity, const Parts& parts);

  /// Once all impulses of the tick's beginning are known: those of single contacts, and the
  /// velocities that they give to bodies.
  void limit_warm_start(const ContactScene& scene, const ContactRun& run);
  /// Notes whether impulses changed a component of a velocity, in a substep of this tick, by more
  /// than k_soft_push. From any thread.
  void note_pushes(std::size_t first, std::size_t end);
  /// Of all impulses since a substep's beginning, once bodies have velocities by them. The scene is
  /// that of the tick's beginning.
  void limit_gains(const ContactRun& run);

 private:
  // The impulses in question: those of the tick before, which no body has felt yet, or those that
  // bodies felt in the substep.
  enum class Impulses : std::uint8_t { to_come, felt };

  // The motion of a body without these impulses, and the one that they give it.
  struct Motion {
    lanes::BodyVelocity free{}, given{};
  };

  // Sums over an island's bodies of twice their energies, by the mass of the first.
  struct Energies {
    std::int64_t free;    // without the impulses
    std::int64_t square;  // of the velocities that they give
    std::int64_t linear;  // of these and the free ones
  };
  // The same as from rough_twice_energy.
  struct RoughEnergies {
    std::uint64_t free;
    std::uint64_t all;  // with all impulses, and as much as it and the other may err
  };

  struct Island {
    BlockFloat unit{};             // inverse mass of its first body
    std::int32_t share = 1 << 30;  // of the impulses that is given, Q30
    bool is_pushed_hard = false;   // and may have gained too much
    bool knows_first = false;      // of this tick
    std::int64_t first = 0;        // energy at the tick's beginning, and by its gravity and forces
    union {
      RoughEnergies rough{};  // until `find_gains`
      Energies exact;         // from then on
    };
  };

  void limit(const ContactRun& run, Impulses which);
  [[nodiscard]] lanes::BodyVelocity free_motion(std::uint32_t number, Impulses which) const;
  [[nodiscard]] Motion motion_of(std::uint32_t number, Impulses which) const;
  [[nodiscard]] bool may_gain(const IslandTally& island, Impulses which) const;
  [[nodiscard]] bool find_hard_pushes(Impulses which);
  void clear_sums();
  template <class Work>
  void for_each_hard_pushed(Work work);
  void sum_rough_energies(Impulses which);
  [[nodiscard]] bool find_gains();
  void add_first_energy(std::uint32_t number, BlockFloat mass, Island& island) const;
  void sum_energies(Impulses which);
  void choose_shares(Impulses which);
  void scale_bodies(Impulses which);
  void scale_contacts(const ContactRun& run, Impulses which);

  Parts parts_;
  ContactScene scene_;                        // of the tick
  std::atomic<bool> are_pushed_hard_{false};  // bodies, in the tick
  std::vector<Island> islands_;
};

}  // namespace lockstone
