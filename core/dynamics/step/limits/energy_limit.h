// Limits the energy of islands that have both joints and contacts.
//
// Contacts and joints of an island may work against each other: joints that fasten bodies where
// they overlap, or links that turn faster than the substep resolves while something presses them.
// So the energy of such an island is checked in each substep. Its gain in a tick, besides the work
// of gravity and forces and beyond a small part, is taken away from all of its bodies alike; and
// positions do not move with velocities of much more energy than those before them.
#pragma once

#include <atomic>
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
  /// The solver's bodies, whose velocities at the substep's beginning change along with those now,
  /// so that differences of the two stay.
  struct Bodies {
    SolverBodies& bodies;
    const TickIslands& islands;
    const JointSolver& joints;
  };

  /// No function but this allocates.
  [[gnu::cold]] void reserve(std::size_t body_capacity);

  /// At the beginning of a tick: finds the islands to watch.
  void begin(const Bodies& all);
  /// Islands that are watched. The functions below take one by its number among these, and may run
  /// side by side for several.
  [[nodiscard]] std::uint32_t watched() const {
    return static_cast<std::uint32_t>(islands_.size());
  }
  /// The island of the tick.
  [[nodiscard]] std::uint32_t island(std::uint32_t watched) const {
    return islands_[watched].island;
  }
  /// The number of an island of the tick, or `k_unwatched`.
  static constexpr std::uint32_t k_unwatched = 0xffffffff;
  [[nodiscard]] std::uint32_t number_of(std::uint32_t island) const {
    return islands_.empty() ? k_unwatched : numbers_[island];
  }

  /// At the beginning of a substep.
  void note(const Bodies& all, std::uint32_t watched);
  /// Before positions move: a body that goes too far in a substep may be lifted, or leave its
  /// joints.
  void limit_moves(const Bodies& all, std::uint32_t watched);
  /// At the end of a substep.
  void limit_gains(const Bodies& all, std::uint32_t watched);

  /// How often energy was taken away in this tick.
  [[nodiscard]] std::uint32_t count() const { return count_.load(std::memory_order_relaxed); }

 private:
  // Of an island, twice energies by its heaviest body's mass.
  struct Island {
    std::uint32_t island = 0;
    std::uint32_t first = 0, count = 0;  // of its bodies
    bool knows_now = false;              // since no energy was taken away after it was summed
    BlockFloat unit{};                   // inverse mass
    std::int64_t gained = 0;             // in this tick, besides the work of gravity and forces
    std::int64_t start = 0;              // at the substep's beginning
    std::int64_t now = 0;
    std::int64_t change = 0;       // in the substep, besides that work
    std::int64_t moving_gain = 0;  // the most of it before positions move, of an island at rest
  };
  struct WatchedBody {
    std::uint32_t number = 0;
    BlockFloat mass{};       // by the island's unit
    Vec3<Velocity> start{};  // velocity at the beginning of the substep
  };

  void find_islands(const Bodies& all);
  void list_bodies(const Bodies& all);
  [[nodiscard]] std::span<WatchedBody> bodies_of(const Island& island) {
    return std::span(bodies_).subspan(island.first, island.count);
  }
  void sum(const Bodies& all, Island& island);
  void take(const Bodies& all, const Island& island, std::int64_t excess);

  std::vector<Island> islands_;         // that are watched
  std::vector<std::uint32_t> numbers_;  // by island of the tick
  std::vector<WatchedBody> bodies_;     // island by island
  std::atomic<std::uint32_t> count_{0};
};

}  // namespace lockstone
