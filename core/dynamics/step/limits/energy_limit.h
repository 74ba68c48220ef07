// Limits the energy of islands that have both joints and contacts.
//
// Contacts and joints of an island may work against each other: joints that fasten bodies where
// they overlap, or links that turn faster than the substep resolves while something presses them.
// So the energy of such an island is checked in each substep. Its gain in a tick, besides the work
// of gravity and forces and beyond a small part, is taken away from all of its bodies alike; and
// positions do not move with velocities of much more energy than those before them.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/body/solver_body.h"
#include "core/dynamics/islands/tick_islands.h"
#include "core/dynamics/step/input/solver_bodies.h"
#include "core/kernels/contact/contact_rows.h"
#include "core/math/block_float.h"

namespace lockstone {

class JointSolver;

class EnergyLimit {
 public:
  /// The solver's bodies by their numbers, from 1. `before`: velocities at the substep's beginning,
  /// which change along with those now, so that differences of the two stay.
  struct Bodies {
    const SolverBodies& numbers;
    std::span<const SolverBody> bodies;
    std::span<lanes::BodyVelocity> rows, before;
    const TickIslands& islands;
    const JointSolver& joints;
  };

  /// No function but this allocates.
  [[gnu::cold]] void reserve(std::size_t body_capacity);

  /// At the beginning of a tick: finds the islands to watch.
  void begin(const Bodies& all);
  [[nodiscard]] bool watches() const { return watches_; }

  /// At the beginning of a substep.
  void note(const Bodies& all);
  /// Before positions move: a body that goes too far in a substep may be lifted, or leave its
  /// joints.
  void limit_moves(const Bodies& all);
  /// At the end of a substep.
  void limit_gains(const Bodies& all);

  /// How often energy was taken away in this tick.
  [[nodiscard]] std::uint32_t count() const { return count_; }

 private:
  // Of an island, twice energies by its heaviest body's mass.
  struct Island {
    BlockFloat unit{};        // its inverse mass; zero: the island is not watched
    std::int64_t gained = 0;  // in this tick, besides the work of gravity and forces
    std::int64_t first = 0;   // at the substep's beginning
    std::int64_t now = 0;
    std::int64_t change = 0;       // in the substep, besides that work
    std::int64_t moving_gain = 0;  // the most of it before positions move
    std::int32_t share = 0;        // of velocities that is left, Q30
  };

  template <class Visit>
  void for_watched(const Bodies& all, const Visit& visit);
  void sum(const Bodies& all);
  void take(Island& island, std::int64_t excess);
  void scale(const Bodies& all);

  std::vector<Island> islands_;
  std::vector<Vec3<Velocity>> starts_;  // velocities at the beginning of the substep, if watched
  bool watches_ = false;
  bool knows_now_ = false;  // `now` holds, since no energy was taken away after it was summed
  std::uint32_t count_ = 0;
};

}  // namespace lockstone
