// Limits the energy that restitution gives to islands.
//
// Restitution says how fast points part, whatever friction and turning make of the way there, and
// so may give bodies more than they had (T. R. Kane, "A dynamics puzzle", 1984). Here bounces of an
// island are scaled down until its energy at the tick's end is no more than gravity and forces
// account for.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/time_step.h"
#include "core/dynamics/step/input/solver_bodies.h"
#include "core/dynamics/step/islands/island_builder.h"
#include "core/math/block_float.h"

namespace lockstone {

class BounceLimit {
 public:
  /// No function but this allocates. `bodies` and `islands` must outlive it.
  [[gnu::cold]] BounceLimit(const TimeStep& step, std::size_t body_capacity,
                            std::size_t number_capacity, SolverBodies& bodies,
                            const IslandBuilder& islands);

  /// Once all bodies have their numbers.
  void reserve();

  /// Before the bounces of a tick: keeps the speeds of bodies, by number.
  void keep_speeds(std::size_t first, std::size_t end);

  /// Once a body has moved: its gain of energy, less the work of gravity and forces on its way.
  void note_gain(std::uint32_t number, const BodyRecord& body, const BodyRecord& start);

  /// Once all have moved: bounces that would give an island energy give less.
  void limit(std::span<BodyRecord> bodies, Velocity speed_limit);

 private:
  // Velocity and spin before the bounces of a tick, and the gains that bounces gave.
  struct Bounce {
    Vec3<Velocity> velocity, spin, velocity_gain, spin_gain;
  };
  // Of an island, twice energies in a unit of its own.
  struct IslandGain {
    BlockFloat unit{};        // inverse mass
    std::int64_t gained = 0;  // besides the work of gravity and forces
    std::int64_t square = 0;  // of bounces
    std::int64_t linear = 0;  // of bounces and of the speeds before them
    std::int32_t share = 0;   // of bounces that is left, Q30
  };

  [[nodiscard]] Bounce bounce_of(std::uint32_t number, const BodyRecord& body) const;
  void add(std::uint32_t number, const IslandGain& gain, std::int64_t each,
           std::int64_t& sum) const;
  void sum_gains();
  void sum_bounces(std::span<const BodyRecord> bodies);
  void scale(std::span<BodyRecord> bodies, Velocity speed_limit);
  template <class Visit>
  void for_gaining(const Visit& visit);

  TimeStep step_;
  SolverBodies& bodies_;
  const IslandBuilder& islands_;
  std::vector<std::int64_t> gained_;  // by number: twice the energy that no force accounts for, of
                                      // each mass
  std::vector<IslandGain> gains_;     // by island
};

}  // namespace lockstone
