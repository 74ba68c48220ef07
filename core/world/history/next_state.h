// The state and the events after a tick, from computed bodies and from memory.
#pragma once

#include <span>
#include <vector>

#include "core/world/data/world_data.h"
#include "core/world/history/computed_bodies.h"
#include "core/world/history/tick_memory.h"

namespace lockstone {

/// Writes the state after a tick to `next.after`. `world` is where a tick of the computed bodies
/// alone has led, from `next.before`. False if contacts exceed their capacity.
[[nodiscard]] bool write_next_state(const WorldData& world, const ComputedBodies& computed,
                                    const TickMemory& known, TickMemory& next);

/// Those of computed bodies and, from memory, those of the others, in the order of a whole tick.
void merge_events(std::span<const ContactEvent> now, const ComputedBodies& computed,
                  const TickMemory& known, std::vector<ContactEvent>& events);
void merge_events(std::span<const HitEvent> now, const ComputedBodies& computed,
                  const TickMemory& known, std::vector<HitEvent>& events);
void merge_events(std::span<const JointEvent> now, const ComputedBodies& computed,
                  const TickMemory& known, std::vector<JointEvent>& events);

}  // namespace lockstone
