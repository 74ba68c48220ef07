// Triggers that something passes within a tick. Overlaps are found where a tick begins; a pair that
// overlaps neither there nor at the tick's end, but does in between, enters and exits in that tick.
#pragma once

#include <cstdint>
#include <vector>

#include <lockstone/event.h>

#include "core/collision/broad_phase/pair.h"
#include "core/collision/continuous/first_impact.h"
#include "core/world/data/world_data.h"
#include "core/world/phases/motion/moved_bodies.h"
#include "core/world/phases/tick_contacts.h"

namespace lockstone {

class ContinuousCollision;

class TriggerPasses {
 public:
  /// No function but this allocates. All outlive this.
  TriggerPasses(WorldData& world, const TickContacts& found, const ContinuousCollision& continuous,
                MovedBodies& moved);

  /// Forgets the passes of the tick before.
  void begin();
  /// Notes each pair that touches while the body goes a fraction of its motion, which begins at
  /// `done` of the tick.
  void note(std::uint32_t body, const Sweep& motion, Unit done, Unit fraction);
  /// Adds an entry and an exit for each noted pair that is apart again, to events in the order of
  /// their pairs.
  void add_events(std::vector<ContactEvent>& events);

  /// After the last note of a tick: puts the pairs in order, each once, and keeps the first ones,
  /// as many as there is room for bodies.
  void finish();
  /// Whether pairs were dropped because there were more of them than room for bodies.
  [[nodiscard]] bool overflowed() const { return overflowed_; }

 private:
  [[nodiscard]] bool senses(std::uint32_t body, std::uint32_t other) const;
  void note_pair(const Pair& pair, const Sweep& a, const Sweep& b);

  WorldData& world_;
  const TickContacts& found_;
  const ContinuousCollision& continuous_;
  MovedBodies& moved_;
  std::vector<Pair> passes_;  // until `finish` in any order, some twice
  bool overflowed_ = false;
};

}  // namespace lockstone
