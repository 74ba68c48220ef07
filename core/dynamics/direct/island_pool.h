// The islands of a tick that are solved to convergence: their bodies, contacts, joints and rows, in
// pools, island by island.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/direct/pool_share.h"
#include "core/dynamics/problem/body_factor.h"
#include "core/dynamics/problem/island_joint.h"
#include "core/dynamics/problem/proximal_rows.h"

namespace lockstone {

/// An island's progress through the phases of a tick.
struct IslandState {
  BlockFloat unit{};           ///< 1/m₀
  int bits = 0;                ///< fraction bits of the phase's units
  int loose = 0;               ///< the phase's tolerance is 2^this times the least
  int stir = 0;                ///< EffortPolicy::stir_level; 0 with joints
  std::uint32_t unsolved = 0;  ///< phases of the tick that ended before they were solved
  bool is_first = true;        ///< substep of the tick
  bool is_measured = false;    ///< speeds of contacts' rows are measured before each phase, since
                               ///< joints or impacts change velocities as well
  bool warms = false;          ///< this phase begins with the impulses of the tick before
  bool was_factored = false;   ///< in this tick, since its rows last changed
  bool is_factored = false;    ///< for the rows that are active
  bool is_whole = false;       ///< `WholeIslands` solves it
  bool forgets = false;        ///< its contacts are new again in the next tick

  /// Where rows of the matrix change: the next phase begins with a factor of its own.
  void drop_factor() { is_factored = was_factored = false; }
};

/// Where blocks of the bodies of a contact or a joint are in the factor.
struct MatrixBlocks {
  static constexpr std::uint32_t k_none = 0xffffffff;

  std::uint32_t a = k_none, b = k_none;
  BodyFactor::Place both{k_none, false};
};

/// A contact of an island as it is added; a and b are the pair's numbers in the solver, 0 for a
/// body that nothing moves.
struct IslandContact {
  ContactId id;
  std::uint32_t a = 0, b = 0;
};

/// A body's change of velocity in a phase, m/s, Q32.
struct PhaseGain {
  RawVec3 velocity{}, spin{};
};

/// The parts of one island in the pools. Contacts and joints name their bodies by their order here;
/// the number after the last is a body that nothing moves, whose vectors are 0.
struct IslandView {
  IslandState& state;
  const BodyFactor::Plan& plan;
  std::span<const std::uint32_t> bodies;  ///< numbers in the solver
  std::span<ProximalContact> contacts;
  std::span<IslandJoint> joints;
  std::span<lanes::ProximalBlock> problems;  ///< of contacts, then of joints
  std::span<const MatrixBlocks> blocks;      ///< alike
  std::span<BodyVector> velocities;  ///< changes since the phase began; one more than bodies
  std::span<BodyVector> changes;     ///< alike
  std::span<PhaseGain> gains;        ///< alike
  std::span<InertiaRoot> roots;      ///< alike

  [[nodiscard]] std::span<lanes::ProximalBlock> contact_problems() const {
    return problems.first(contacts.size());
  }
  [[nodiscard]] std::span<lanes::ProximalBlock> joint_problems() const {
    return problems.subspan(contacts.size());
  }
};

class IslandPool {
 public:
  /// The sizes that the pools are made for.
  struct Capacity {
    std::size_t numbers = 0;   ///< bodies of islands are among the first of the solver
    std::size_t bodies = 0;    ///< of all islands
    std::size_t problems = 0;  ///< contacts and joints of all islands
    std::size_t joints = 0;
  };

  /// No function but this allocates.
  [[gnu::cold]] explicit IslandPool(const Capacity& capacity);

  void clear();

  /// Whether the pools have room for an island of this size, without its factor.
  [[nodiscard]] bool has_room(std::size_t bodies, std::size_t contacts, std::size_t joints);
  /// An island that there is room for, whose bodies, contacts and joints are given in their order;
  /// false if its factor is too large. Bodies are numbers in the solver.
  [[nodiscard]] bool add(std::span<const std::uint32_t> bodies,
                         std::span<const IslandContact> contacts,
                         std::span<const IslandJoint> joints);

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(islands_.size()); }
  /// The number of an island's first body in the solver.
  [[nodiscard]] std::uint32_t first_body(std::uint32_t island) const {
    return bodies_[islands_[island].first_body];
  }
  [[nodiscard]] PoolShare share(std::uint32_t island) const;
  /// The room that all islands share.
  [[nodiscard]] PoolShare room() const;
  /// Whether an island found no room since `clear`.
  [[nodiscard]] bool was_full() const { return was_full_ || factor_.pool_use().is_exhausted(); }
  [[nodiscard]] IslandView view(std::uint32_t island);
  [[nodiscard]] const IslandState& state(std::uint32_t island) const {
    return islands_[island].state;
  }
  [[nodiscard]] BodyFactor& factor() { return factor_; }

  /// Of all islands.
  [[nodiscard]] std::span<ProximalContact> contacts() { return contacts_; }

 private:
  // Where an island's parts begin, and how many there are.
  struct Island {
    IslandState state;
    BodyFactor::Plan plan;
    std::uint32_t first_body = 0, bodies = 0;
    std::uint32_t first_vector = 0;  // one more than bodies
    std::uint32_t first_contact = 0, contacts = 0;
    std::uint32_t first_joint = 0, joints = 0;
    std::uint32_t first_problem = 0;
  };

  [[nodiscard]] Island place(std::size_t bodies, std::size_t contacts, std::size_t joints) const;
  [[nodiscard]] bool plan(Island& island, std::span<const std::uint32_t> bodies,
                          std::span<const IslandContact> contacts,
                          std::span<const IslandJoint> joints);
  void add_problem(const Island& island, std::uint32_t a, std::uint32_t b);

  Capacity capacity_;
  std::vector<Island> islands_;
  std::vector<std::uint32_t> bodies_;
  std::vector<ProximalContact> contacts_;
  std::vector<IslandJoint> joints_;
  std::vector<lanes::ProximalBlock> problems_;
  std::vector<MatrixBlocks> blocks_;
  std::vector<BodyVector> velocities_, changes_;
  std::vector<PhaseGain> gains_;
  std::vector<InertiaRoot> roots_;
  std::vector<std::uint32_t> local_;  // by number in the solver: the order in its island
  std::vector<BodyFactor::Pair> pairs_;
  BodyFactor factor_;
  bool was_full_ = false;
};

}  // namespace lockstone
