#include "core/world/history/tick_memory.h"

#include "core/world/phases/hit_events.h"
#include "core/world/phases/motion/moved_bodies.h"

namespace lockstone {
namespace {

std::size_t state_bytes(const WorldDef& def) {
  return sizeof(WorldHeader) + WorldStores::record_bytes_max(def);
}

// As many as ContactEvents has room for.
std::size_t most_events(const WorldDef& def) {
  return std::size_t{2} * def.contact_capacity + std::size_t{4} * def.body_capacity;
}

}  // namespace

TickMemory::TickMemory(const WorldDef& def) : before(state_bytes(def)), after(state_bytes(def)) {
  events.reserve(most_events(def));
  hit_events.reserve(most_listed(def));
  joint_events.reserve(def.joint_capacity);
  pairs.reserve(def.pair_capacity);
  groups.reserve(def.body_capacity);
  shares.reserve(def.body_capacity);
  lookers.reserve(MovedBodies::most_looks(def));
}

std::size_t TickMemory::bytes_max(const WorldDef& def) {
  return sizeof(TickMemory) + 2 * state_bytes(def) + most_events(def) * sizeof(ContactEvent) +
         most_listed(def) * sizeof(HitEvent) + def.joint_capacity * sizeof(JointEvent) +
         def.pair_capacity * sizeof(Pair) +
         (def.body_capacity + MovedBodies::most_looks(def)) * sizeof(std::uint32_t) +
         def.body_capacity * sizeof(IslandShare);
}

}  // namespace lockstone
