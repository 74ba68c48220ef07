#include "core/world/sleep/waking.h"

#include <algorithm>

#include "core/world/phases/motion/continuous.h"

namespace lockstone {

Waking::Waking(WorldData& world, SleepFlags& flags, TickContacts& found)
    : world_(world), flags_(flags), thawed_(found.records) {
  to_wake_.reserve(std::size_t{1 + k_max_impacts} * world.def.body_capacity);
}

void Waking::stir(std::uint32_t body) {
  if (world_.bodies[body].still_ticks == 0) return;
  world_.bodies[body].still_ticks = 0;
  world_.hashes.bodies.mark(body);
}

// All that may touch the body, or are joined to it.
void Waking::stir_around(std::uint32_t body) {
  for (const std::uint32_t other : world_.joint_graph.neighbours(body))
    stir(other);
  if (!world_.broad_phase.has(body)) return;
  world_.broad_phase.settle(BroadPhase::Moment::command);
  const Bounds here = world_.broad_phase.bounds(body);
  world_.broad_phase.traverse(
      k_every_category, [&](const Bounds& bounds) { return overlap(here, bounds); },
      [&](std::uint32_t other) { stir(other); });
}

void Waking::list(std::uint32_t body) {
  stir(body);
  if (!world_.bodies[body].is_asleep()) return;
  flags_.set_awake(body);
  to_wake_.push_back(body);
}

bool Waking::wake_listed() {
  if (to_wake_.empty()) return false;
  thawed_.clear();
  for (const std::uint32_t body : to_wake_)
    if (world_.bodies[body].is_asleep()) flags_.set_awake(body);
  while (!to_wake_.empty()) {
    const std::uint32_t body = to_wake_.back();
    to_wake_.pop_back();
    spread_from(body);
  }
  std::ranges::sort(thawed_, {}, &ContactRecord::key);
  world_.contacts.merge(thawed_);
  return true;
}

void Waking::spread_from(std::uint32_t body) {
  for (const std::uint32_t other : world_.joint_graph.neighbours(body))
    if (world_.bodies[other].is_dynamic()) list(other);
  world_.contacts.thaw_all_of(body, [&](const ContactRecord& record) {
    thawed_.push_back(record);
    const std::uint32_t other = record.body_a == body ? record.body_b : record.body_a;
    if (!record.is_inert() && world_.bodies[other].is_dynamic()) list(other);
  });
}

void Waking::wake(std::uint32_t body) {
  list(body);
  wake_listed();
}

void Waking::wake_ends(const JointRecord& joint) {
  list(joint.body_a);
  list(joint.body_b);
  wake_listed();
}

void Waking::wake_all() {
  for (std::uint32_t body = 0; body < world_.header.body_limit; ++body)
    list(body);
  wake_listed();
}

// Such a body was put to sleep by a command beside a kinematic body, or comes in a state from
// outside.
void Waking::wake_joined() {
  if (world_.joint_graph.is_awake_list_current()) return;
  for (const JointLink& link : world_.joint_graph.links()) {
    const bool a_awake = world_.awake.has(link.body_a), b_awake = world_.awake.has(link.body_b);
    const std::uint32_t other = a_awake ? link.body_b : link.body_a;
    if (a_awake != b_awake && world_.bodies[other].is_dynamic()) list(other);
  }
  wake_listed();
}

void Waking::disturb(std::uint32_t body) {
  stir_around(body);
  if (flags_.asleep_count() == 0) return;
  if (world_.bodies[body].moves()) {
    wake(body);
    return;
  }
  world_.contacts.sleeping().for_each_of(body, [&](const ContactRecord& record) {
    list(record.body_a == body ? record.body_b : record.body_a);
  });
  for (const std::uint32_t other : world_.joint_graph.neighbours(body))
    list(other);
  wake_listed();
}

// A body that moves is awake by now and finds the others by itself.
void Waking::disturb_around(std::uint32_t body) {
  if (world_.bodies[body].moves()) return stir_around(body);
  if (world_.broad_phase.has(body)) disturb_within(world_.broad_phase.bounds(body), body);
}

void Waking::disturb_within(const Bounds& here, std::uint32_t body) {
  const bool may_wake = flags_.asleep_count() != 0;
  world_.broad_phase.settle(BroadPhase::Moment::command);
  world_.broad_phase.traverse(
      k_every_category, [&](const Bounds& bounds) { return overlap(here, bounds); },
      [&](std::uint32_t other) {
        stir(other);
        if (may_wake && should_collide(world_.bodies[body].filter(), world_.bodies[other].filter()))
          list(other);
      });
  wake_listed();
}

}  // namespace lockstone
