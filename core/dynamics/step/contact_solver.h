// The solver of one tick: its parts, and the order in which a tick uses them.
//
// Source of the method: E. Catto, "Solver2D", 2024 (the soft-step solver): each substep integrates
// velocities, starts warm, solves with soft bias, integrates positions and relaxes without bias.
// docs/explanation/solver.md lists the differences.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/base/parallel.h"
#include "core/base/pool_use.h"
#include "core/dynamics/body/solver_body.h"
#include "core/dynamics/state/time_step.h"
#include "core/dynamics/step/contacts/contact_constraints.h"
#include "core/dynamics/step/contacts/impulse_totals.h"
#include "core/dynamics/step/contacts/solved_motion.h"
#include "core/dynamics/step/contacts/stack_warm_start.h"
#include "core/dynamics/step/converged_islands.h"
#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/contact_scene.h"
#include "core/dynamics/step/input/solver_bodies.h"
#include "core/dynamics/step/input/tick_joints.h"
#include "core/dynamics/step/islands/effort_policy.h"
#include "core/dynamics/step/islands/island_builder.h"
#include "core/dynamics/step/limits/ball_impacts.h"
#include "core/dynamics/step/limits/bounce_limit.h"
#include "core/dynamics/step/limits/energy_limit.h"
#include "core/dynamics/step/substep_schedule.h"
#include "core/dynamics/step/whole_islands.h"

namespace lockstone {

/// Counts of a tick.
struct SolverCounts {
  std::uint32_t contacts = 0;
  std::uint32_t points = 0;
  std::uint32_t colors = 0;
  std::uint32_t overflow_contacts = 0;  ///< that found no colour
  std::uint32_t saturations = 0;        ///< values that were clamped to their range
  std::uint32_t energy_limits = 0;      ///< times that an island gave back energy
  PoolUse pools;                        ///< of joints; exhausted if any pool was
};

class ContactSolver {
 public:
  /// No functions but this and `make_room` allocate. `converged_contacts`: of all islands that are
  /// solved to convergence, with their joints.
  [[gnu::cold]] ContactSolver(const TimeStep& step, std::size_t body_capacity,
                              std::size_t contact_capacity, std::size_t joint_capacity,
                              std::size_t converged_contacts);
  [[gnu::cold]] ~ContactSolver();

  /// For this many workers.
  void make_room(std::uint32_t workers) { warm_start_.make_room(workers); }

  /// Gathers the touched bodies and makes the constraints, in the order of the records.
  void prepare(const ContactScene& scene, Parallel& parallel);

  /// All substeps.
  void run(Parallel& parallel);

  /// Writes the last impulses of each point, and whether the surfaces met, to the records, and the
  /// fastest approach of each to `approaches`.
  void store(std::span<const Manifold> manifolds, std::span<ContactRecord> records,
             std::span<SolverVelocity> approaches, Parallel& parallel);

  /// The impulses of the watched contacts that came in fast.
  [[nodiscard]] const ImpulseTotals& totals() const { return totals_; }

  /// Writes the last impulses of each joint to the records.
  void store_joints(std::span<const JointLink> links, std::span<JointRecord> joints,
                    Parallel& parallel) const {
    joints_.store(links, joints, parallel);
  }

  /// Null when no constraint touched the body.
  [[nodiscard]] const SolverBody* find(std::uint32_t body) const;

  /// Writes a touched body's substeps back: position, orientation, velocity and spin.
  /// `rotation` is the matrix of its orientation; returns the same as `fly`.
  std::uint32_t move(const SolverBody& solved, const Mat3& rotation, BodyRecord& body);

  /// Once all have moved: bounces that would give an island energy give less.
  void limit_bounces(std::span<BodyRecord> bodies, Velocity speed_limit);

  /// The velocity and the spin that a touched body has after `run`.
  [[nodiscard]] std::array<Vec3<Velocity>, 2> speeds(const SolverBody& solved) const {
    return motion_.speeds(number_of(solved));
  }

  /// Whether a body's manifolds may stay as they are: its island (`island_of`) is left to the
  /// iterations, and it has not moved far.
  [[nodiscard]] static bool keeps_recycling_pose(const IslandTally* island,
                                                 const BodyRecord& record, Length inner_radius);

  /// How a body moved in the tick. From any thread.
  void note_motion(std::uint32_t body, const BodyRecord& record, const BodyMotion& motion);
  /// The counts of a body's island; null of a body that is in none.
  [[nodiscard]] const IslandTally* island_of(std::uint32_t body) const {
    return islands_.find(bodies_, body);
  }

  [[nodiscard]] SolverCounts counts() const;
  /// Lists the places of converged islands in their pools.
  void list_shares(std::vector<IslandShare>& to) const;
  /// The room of these pools.
  [[nodiscard]] PoolShare room() const;

 private:
  struct Tick {
    std::uint32_t first_substep = 0;  // from the world's beginning, modulo 2^32
    std::uint32_t saturations = 0;
    bool is_idle = false;  // neither contacts nor joints
  };

  struct Converged {
    Converged(const TimeStep& step, std::size_t body_capacity, std::size_t contact_capacity,
              std::size_t joint_capacity, std::size_t converged_contacts,
              std::uint32_t most_island_contacts, const WholeIslands::Parts& parts);

    ConvergedIslands islands;
    WholeIslands whole;
  };

  void gather(const ContactScene& scene, Parallel& parallel);
  [[nodiscard]] TickWork work() const;
  void fill_bodies(const ContactScene& scene, std::size_t first, std::size_t end);
  void prepare_piece(const ContactScene& scene, const Stage& stage, std::size_t first,
                     std::size_t end);
  void run_piece(const Stage& stage, std::size_t first, std::size_t end);
  [[nodiscard]] EnergyLimit::Bodies energy_bodies();
  [[nodiscard]] std::uint32_t number_of(const SolverBody& solved) const {
    return static_cast<std::uint32_t>(&solved - bodies_.constants().data());
  }

  SolverBodies bodies_;
  ContactList contacts_;
  TickJoints joints_;
  IslandBuilder islands_;
  EffortPolicy effort_;
  ContactConstraints constraints_;
  std::unique_ptr<Converged> converged_;  // null where no island is solved to convergence
  StackWarmStart warm_start_;
  ImpulseTotals totals_;
  BallImpacts impacts_;
  EnergyLimit energy_limit_;
  SolvedMotion motion_;
  BounceLimit bounce_limit_;
  SubstepSchedule schedule_;
  Tick tick_;
};

}  // namespace lockstone
