// Leaves islands that stand still out of the tick, whether or not their bodies may fall asleep.
//
// Bodies at rest that may not sleep, or do not yet, cost as much as bodies that move, although
// nothing about them changes: the solver finds the same impulses again in each tick. So an island
// of which no body has changed its pose, by a single bit, for an eighth of a second, keeps its
// contacts and joints as they are, and so does one whose bodies have only trembled for a quarter of
// a second: by less than 61 µm/s, as errors of the solver let them. Velocities become zero.
// Converged contacts leave bodies at rest no velocity but rounding, while overlap is still being
// closed. Bodies of such an island are settled: they tremble and have less than 3.8 µm/s at the
// tick's end. A thirtieth of a second of that, two ticks at least, is enough. A still island is
// solved again in the tick in which anything about it differs: a contact or a point of one, a push,
// a surface that moves. Commands that would wake sleeping bodies reset the counts of bodies that
// are awake (Waking).
//
// Error: bodies do not stand still so long that would gain more than 6e-5 m/s² alone (the least
// speed at which bodies move, solver.md "Still bodies stay", in an eighth of a second), or 2.4e-4
// m/s² with others (61 µm/s in a quarter; 3.8 µm/s in a thirtieth are 1.1e-4 m/s²).
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/islands/islands.h"
#include "core/dynamics/islands/tick_islands.h"
#include "core/world/data/world_data.h"
#include "core/world/phases/motion/bounces.h"
#include "core/world/phases/motion/moved_bodies.h"
#include "core/world/phases/motion/pendulums.h"
#include "core/world/phases/tick_contacts.h"

namespace lockstone {

class StillIslands {
 public:
  /// No function but this allocates. All outlive this; `islands` is scratch that others may share.
  StillIslands(WorldData& world, TickContacts& found, const Bounces& bounces, Pendulums& pendulums,
               Islands& islands);

  /// Finds the still islands among the contacts and joints of this tick, and takes those from the
  /// solver. Once bounces and pendulums are known.
  void find();

  [[nodiscard]] bool has(std::uint32_t body) const { return is_still_[body] != 0; }
  /// Ascending.
  [[nodiscard]] std::span<const std::uint32_t> bodies() const { return bodies_; }
  /// Those that were not still in the tick before: they have lost their velocities.
  [[nodiscard]] std::span<const std::uint32_t> stopped() const { return stopped_; }
  /// Contacts of still islands, and their points.
  [[nodiscard]] std::uint32_t contacts() const { return contacts_; }
  [[nodiscard]] std::uint32_t points() const { return points_; }

  /// The still_ticks of a body of this island, or of none, once it was solved.
  [[nodiscard]] std::uint8_t count_of(const IslandTally* island, const BodyRecord& body) const;

  /// How a body moved from its pose at the tick's beginning.
  [[nodiscard]] BodyMotion motion_since(const Transform& start, const BodyRecord& body) const;

 private:
  [[nodiscard]] bool trembles(const Transform& start, const BodyRecord& body) const;
  [[nodiscard]] bool is_nearly_still(const BodyRecord& body) const;
  [[nodiscard]] bool may_find() const;
  void look_at_bodies();
  void look_at_contacts();
  void look_at_joints();
  void connect(std::uint32_t a, std::uint32_t b, bool differs);
  [[nodiscard]] bool differs(std::size_t contact) const;
  void stir(std::uint32_t body);
  void keep(std::uint32_t body);
  void leave_out_contacts();

  WorldData& world_;
  TickContacts& found_;
  const Bounces& bounces_;
  Pendulums& pendulums_;
  Islands& islands_;
  const std::uint16_t ticks_;           // so long, then an island is still
  std::vector<std::uint8_t> is_still_;  // by body
  std::vector<std::uint8_t> is_tied_;   // by body: by a contact or a joint
  std::vector<std::uint32_t> bodies_;   // that are still
  std::vector<std::uint32_t> stopped_;  // that are still since this tick
  std::uint32_t contacts_ = 0, points_ = 0;
};

}  // namespace lockstone
