// Islands that are solved whole: all substeps of one island before those of the next, so that its
// data stay in a near cache. The stages of an island, and so its motion, are those of
// `SubstepSchedule`, which has the islands that are left.
//
// An island is solved whole if it is converged, or has joints and no contacts, unless a stage of
// several islands pushes its bodies: impacts of balls, coloured ball joints, and joints to bodies
// that move by themselves.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/step/contacts/contact_constraints.h"
#include "core/dynamics/step/contacts/impulse_totals.h"
#include "core/dynamics/step/converged_islands.h"
#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/solver_bodies.h"
#include "core/dynamics/step/input/tick_joints.h"
#include "core/dynamics/step/islands/island_builder.h"
#include "core/dynamics/step/limits/energy_limit.h"
#include "core/dynamics/step/substep_schedule.h"

namespace lockstone {

class WholeIslands {
 public:
  /// The other parts of the tick, which must outlive this.
  struct Parts {
    SolverBodies& bodies;
    const ContactList& contacts;
    IslandBuilder& islands;
    TickJoints& joints;
    ContactConstraints& constraints;
    EnergyLimit& energy_limit;
    ImpulseTotals& totals;
  };

  /// No function but this allocates.
  [[gnu::cold]] WholeIslands(std::size_t body_capacity, std::size_t converged_contacts,
                             std::size_t joint_capacity, int substeps, const Parts& parts,
                             ConvergedIslands& converged);

  /// Once a tick is prepared but for its totals: chooses.
  void plan();

  /// Takes their share out of the work of the stages.
  void leave_out(TickWork& work) const;

  /// All substeps of islands `first` … `end` − 1, by their numbers here.
  void solve(std::size_t first, std::size_t end);

 private:
  static constexpr std::uint32_t k_no_contacts = 0xffffffff;

  struct Island {
    std::uint32_t island = 0;                 // of the tick
    std::uint32_t converged = k_no_contacts;  // among the converged ones
    std::uint32_t watched = 0;                // by `EnergyLimit`, or its k_unwatched
    std::uint32_t joints = 0;                 // in its clusters
    bool is_apart = true;                     // all of its clusters are
    std::uint32_t first_body = 0,
                  bodies = 0;  // with bodies of its contacts that move by themselves
    std::uint32_t first_cluster = 0, clusters = 0;
  };

  void find_candidates();
  void count_clusters();
  void choose();
  void list_bodies(Island& island);
  void list_clusters();
  void add_body(Island& island, std::uint32_t number);
  void take_contacts(Island& island);
  [[nodiscard]] std::uint32_t& entry_of_cluster(std::uint32_t cluster);
  void solve(const Island& island);
  void push(const Island& island, bool is_first);
  void relax(const Island& island);
  [[nodiscard]] EnergyLimit::Bodies energy_bodies();

  Parts parts_;
  ConvergedIslands& converged_;
  int substeps_;
  std::vector<Island> islands_;
  std::vector<std::uint32_t> bodies_;    // numbers, island by island
  std::vector<std::uint32_t> clusters_;  // alike
  std::uint32_t converged_count_ = 0, contact_count_ = 0;
};

}  // namespace lockstone
