#include "core/world/sleep/sleep_flags.h"

#include <lockstone/assert.h>

namespace lockstone {

SleepFlags::SleepFlags(WorldData& world)
    : world_(world),
      rest_rules_(RestRules::of(world.def.tick_rate, world.def.sleep_ms, world.def.sleep_distance)),
      changed_(world.def.body_capacity) {}

// There and back again is no event.
void SleepFlags::note_changed(std::uint32_t body) {
  BodyRecord& record = world_.bodies[body];
  if (record.is_dynamic()) {
    record.flags ^= k_body_changed_sleep;
    changed_.flip(body);
  }
  world_.hashes.bodies.mark(body);
}

void SleepFlags::finish_change(std::uint32_t body) {
  world_.joint_graph.forget_awake_list();
  note_changed(body);
  world_.refresh_bounds(body);
}

void SleepFlags::set_awake(std::uint32_t body) {
  BodyRecord& record = world_.bodies[body];
  LKS_ASSERT(record.is_asleep() && asleep_count_ > 0);
  record.flags = static_cast<std::uint8_t>(record.flags & ~k_body_asleep);
  begin_rest(record, rest_rules_);
  world_.awake.insert(body);
  --asleep_count_;
  finish_change(body);
}

void SleepFlags::set_asleep(std::uint32_t body) {
  BodyRecord& record = world_.bodies[body];
  LKS_ASSERT(record.moves() && !record.is_asleep());
  record.flags = static_cast<std::uint8_t>((record.flags | k_body_asleep) & ~k_body_pushed);
  record.velocity = record.spin = {};
  record.still_ticks = 0;
  begin_rest(record, rest_rules_);
  world_.awake.erase(body);
  ++asleep_count_;
  finish_change(body);
}

void SleepFlags::forget(std::uint32_t body) {
  LKS_ASSERT(!world_.bodies[body].is_asleep());
  world_.awake.erase(body);
  changed_.erase(body);
}

void SleepFlags::add_events(std::vector<ContactEvent>& events) {
  for (const std::uint32_t body : changed_.list()) {
    BodyRecord& record = world_.bodies[body];
    const EventKind kind = record.is_asleep() ? EventKind::sleep : EventKind::wake;
    events.push_back({kind, world_.handle_of(body), {}, {}});
    record.flags &= static_cast<std::uint8_t>(~k_body_changed_sleep);
    world_.hashes.bodies.mark(body);
  }
  changed_.clear();
}

void SleepFlags::rebuild() {
  world_.awake.clear();
  changed_.clear();
  asleep_count_ = 0;
  for (std::uint32_t i = 0; i < world_.header.body_limit; ++i) {
    const BodyRecord& record = world_.bodies[i];
    if (!record.exists()) continue;
    if (record.is_asleep()) ++asleep_count_;
    if (record.is_awake()) world_.awake.insert(i);
    if (record.has_changed_sleep()) changed_.insert(i);
  }
}

void SleepFlags::note_loaded(std::uint32_t body) {
  const BodyRecord& record = world_.bodies[body];
  if (changed_.has(body) != record.has_changed_sleep()) changed_.flip(body);
  if (world_.awake.has(body) != record.is_awake()) world_.awake.flip(body);
}

}  // namespace lockstone
