// Sleep: islands at rest leave the tick, and come back when something disturbs them.
//
// A body is awake or asleep by a flag of its record. A pair of bodies is looked at while one of the
// two is awake; contacts between bodies of which none is awake are frozen, as they are, until one
// wakes. All but the flags and the notes of rest is derived.

#include <algorithm>

#include "core/world/world_impl.h"

namespace lockstone {
namespace {

constexpr Displacement k_deep = Displacement::from_ratio(1, 300);

}  // namespace

// After a change of the body's sleep: there and back again is no event.
void World::Impl::note_changed_sleep(std::uint32_t body) {
  BodyRecord& record = bodies[body];
  if (record.is_dynamic()) {
    record.flags ^= k_body_changed_sleep;
    changed_sleep.flip(body);
  }
  body_hashes.mark(body);
}

void World::Impl::set_awake(std::uint32_t body) {
  BodyRecord& record = bodies[body];
  record.flags = static_cast<std::uint8_t>(record.flags & ~k_body_asleep);
  begin_rest(record, rest_rules);
  awake.insert(body);
  joint_graph.forget_awake_list();
  --asleep_count;
  note_changed_sleep(body);
  refresh_bounds(body);
}

void World::Impl::set_asleep(std::uint32_t body) {
  BodyRecord& record = bodies[body];
  record.flags = static_cast<std::uint8_t>((record.flags | k_body_asleep) & ~k_body_pushed);
  record.velocity = record.spin = {};
  begin_rest(record, rest_rules);
  awake.erase(body);
  joint_graph.forget_awake_list();
  ++asleep_count;
  note_changed_sleep(body);
  refresh_bounds(body);
}

void World::Impl::list_to_wake(std::uint32_t body) {
  if (!bodies[body].is_asleep()) return;
  set_awake(body);
  to_wake.push_back(body);
}

// Wakes the listed bodies, and all bodies that contacts and joints connect to them.
void World::Impl::wake_listed() {
  if (to_wake.empty()) return;
  std::vector<ContactRecord>& thawed = new_contacts;  // not in use between the stages
  thawed.clear();
  for (const std::uint32_t body : to_wake)
    if (bodies[body].is_asleep()) set_awake(body);
  while (!to_wake.empty()) {
    const std::uint32_t body = to_wake.back();
    to_wake.pop_back();
    for (const std::uint32_t other : joint_graph.neighbours(body))
      if (bodies[other].is_dynamic()) list_to_wake(other);
    frozen.remove_all_of(body, [&](const ContactRecord& record) {
      thawed.push_back(record);
      const std::uint32_t other = record.body_a == body ? record.body_b : record.body_a;
      if (!record.is_trigger() && bodies[other].is_dynamic()) list_to_wake(other);
    });
  }
  std::ranges::sort(thawed, {}, &ContactRecord::key);
  take_back(thawed);
}

// Merges contacts into those of awake bodies, both by key, from the last on. Their manifolds are
// not remembered: they have no slot.
void World::Impl::take_back(std::span<const ContactRecord> thawed) {
  std::size_t from = active_contacts;
  std::size_t to = from + thawed.size();
  active_contacts = static_cast<std::uint32_t>(to);
  if (remembers_manifolds) slots.resize(to);
  while (!thawed.empty()) {
    --to;
    const bool take_old = from > 0 && thawed.back().key() < contact_store[from - 1].key();
    contact_store[to] = take_old ? contact_store[from - 1] : thawed.back();
    if (remembers_manifolds) slots[to] = take_old ? slots[from - 1] : NarrowSlots::k_none;
    if (take_old)
      --from;
    else
      thawed = thawed.first(thawed.size() - 1);
  }
}

void World::Impl::wake(std::uint32_t body) {
  list_to_wake(body);
  wake_listed();
}

void World::Impl::wake_ends(const JointRecord& joint) {
  list_to_wake(joint.body_a);
  list_to_wake(joint.body_b);
  wake_listed();
}

// Wakes each body that a joint connects to an awake one: such a body was put to sleep by a command
// beside a kinematic body, or comes in a state from outside.
void World::Impl::wake_joined() {
  if (joint_graph.is_awake_list_current()) return;
  for (const JointLink& link : joint_graph.links()) {
    const bool a_awake = awake.has(link.body_a), b_awake = awake.has(link.body_b);
    const std::uint32_t other = a_awake ? link.body_b : link.body_a;
    if (a_awake != b_awake && bodies[other].is_dynamic()) list_to_wake(other);
  }
  wake_listed();
}

// Those with an awake body: found again when one slept, woke, came or went.
void World::Impl::find_active_joints() {
  joint_graph.list_awake([&](std::uint32_t body) { return awake.has(body); });
}

// The body changes: it wakes, and so do the bodies in contact with it or joined to it.
void World::Impl::disturb(std::uint32_t body) {
  if (asleep_count == 0) return;
  if (bodies[body].moves()) {
    wake(body);
    return;
  }
  frozen.for_each_of(body, [&](const ContactRecord& record) {
    list_to_wake(record.body_a == body ? record.body_b : record.body_a);
  });
  for (const std::uint32_t other : joint_graph.neighbours(body))
    list_to_wake(other);
  wake_listed();
}

// The body is new at its place: the bodies that sleep there wake. A body that moves is awake by now
// and finds the others by itself.
void World::Impl::disturb_around(std::uint32_t body) {
  if (asleep_count == 0 || bodies[body].moves()) return;
  const Bounds here = broad_phase.bounds(body);
  broad_phase.traverse(
      k_every_category, [&](const Bounds& bounds) { return overlap(here, bounds); },
      [&](std::uint32_t other) {
        if (should_collide(bodies[body].filter(), bodies[other].filter())) list_to_wake(other);
      });
  wake_listed();
}

void World::Impl::wake_all() {
  if (asleep_count == 0) return;
  for (std::uint32_t body = 0; body < header.body_limit; ++body)
    list_to_wake(body);
  wake_listed();
}

// Wakes the bodies that awake bodies are about to touch. Returns whether there was any: then there
// are more pairs.
bool World::Impl::wake_met() {
  if (asleep_count == 0) return false;
  for (const Pair& pair : pairs) {
    const bool a_awake = awake.has(pair.a), b_awake = awake.has(pair.b);
    if (a_awake && b_awake) continue;
    const std::uint32_t sleeper = a_awake ? pair.b : pair.a;
    if (bodies[sleeper].is_dynamic() && meet(pair)) list_to_wake(sleeper);
  }
  continuous.wake_struck();
  const bool any = !to_wake.empty();
  wake_listed();
  return any;
}

// Dynamic bodies of one island fall asleep together, once all of them rest. Bodies that a kinematic
// body moves or is about to move stay awake; a kinematic body that stands sleeps by itself. Bodies
// without joints that keep others awake are braked.
void World::Impl::rest_bodies(StepReport& report) {
  const StageTimer timer(profiler, StepStage::sleep);
  wake_listed();  // bodies that were hit during the step
  to_sleep.clear();
  if (rest_rules.ticks != 0 && watch_bodies()) {
    join_islands();
    hold_overlapping();
    report.islands = islands.settle(awake.list());
    const Velocity brake = rest_rules.brake(def.tick_rate);
    for (const std::uint32_t body : awake.list()) {
      BodyRecord& record = bodies[body];
      if (!record.is_dynamic()) continue;
      if (!islands.is_held(body)) to_sleep.push_back(body);
      const bool is_unrested =
          is_watched(record, rest_rules) && record.rest_ticks < rest_rules.ticks;
      if (!is_unrested || !islands.rests_in_part(body) || !joint_graph.neighbours(body).empty())
        continue;
      slow_down(record, cache.rotation(body), brake);
      refresh_bounds(body);
    }
  }
  for (const std::uint32_t body : to_sleep)
    set_asleep(body);
  if (!to_sleep.empty()) freeze_contacts();
  report.asleep_bodies = asleep_count;
}

// Counts the ticks of rest. Returns whether some dynamic body is ready to sleep.
bool World::Impl::watch_bodies() {
  bool ready = false;
  for (const std::uint32_t body : awake.list()) {
    BodyRecord& record = bodies[body];
    if (is_watched(record, rest_rules)) {
      ready |= count_rest(record, rest_rules);
    } else if (!record.is_dynamic() && record.may_sleep()) {
      if (record.velocity == Vec3<Velocity>{} && record.spin == Vec3<Velocity>{})
        to_sleep.push_back(body);
    }
  }
  return ready;
}

// Bodies that overlap deeply are still being pushed out, too slowly for the rest test to see: they
// must rest longer. At the end of a tick, when each contact has its manifold.
void World::Impl::hold_overlapping() {
  const auto hold = [&](std::uint32_t body) {
    const bool counts = awake.has(body) && bodies[body].is_dynamic();
    if (counts && bodies[body].rest_ticks < rest_rules.long_ticks()) islands.hold(body);
  };
  for (std::size_t i = 0; i < active_contacts; ++i) {
    if (slots[i] == NarrowSlots::k_none) continue;
    const Manifold& manifold = manifolds[slots[i]];
    const std::span points(manifold.points);
    const auto is_deep = [](const ManifoldPoint& point) { return point.separation < -k_deep; };
    if (std::ranges::none_of(points.first(static_cast<std::size_t>(manifold.count)), is_deep))
      continue;
    hold(contact_store[i].body_a);
    hold(contact_store[i].body_b);
  }
}

void World::Impl::join_islands() {
  find_active_joints();
  const std::span<const std::uint32_t> all = awake.list();
  islands.begin(all);
  for (const std::uint32_t body : all) {
    if (bodies[body].rest_ticks < rest_rules.ticks)
      islands.hold(body);
    else if (bodies[body].is_dynamic())
      islands.note_rest(body);
  }
  const auto tie = [&](std::uint32_t a, std::uint32_t b) {
    if (!awake.has(a) || !awake.has(b)) return;
    const bool a_dynamic = bodies[a].is_dynamic();
    if (a_dynamic && bodies[b].is_dynamic())
      islands.join(a, b);
    else
      islands.drive(a_dynamic ? a : b);
  };
  for (const ContactRecord& contact : contacts())
    if (!contact.is_trigger()) tie(contact.body_a, contact.body_b);
  for (const JointLink& joint : joint_graph.awake_links())
    tie(joint.body_a, joint.body_b);
}

// Moves contacts of which neither body is awake any more out of the way.
void World::Impl::freeze_contacts() {
  const auto stays = [&](const ContactRecord& contact) {
    return awake.has(contact.body_a) || awake.has(contact.body_b);
  };
  const std::span<const ContactRecord> all = contacts();
  for (std::size_t i = all.size(); i-- > 0;)
    if (!stays(all[i])) frozen.add(all[i]);
  std::size_t kept = 0;
  for (std::size_t i = 0; i < all.size(); ++i) {
    if (!stays(all[i])) continue;
    contact_store[kept] = all[i];
    if (remembers_manifolds) slots[kept] = slots[i];
    ++kept;
  }
  active_contacts = static_cast<std::uint32_t>(kept);
  if (remembers_manifolds) slots.resize(kept);
}

// Sorts contacts into active and sleeping ones by the flags of the bodies.
void World::Impl::adopt_contacts(std::span<const ContactRecord> all) {
  frozen.clear();
  std::copy(all.begin(), all.end(), contact_store.begin());
  active_contacts = static_cast<std::uint32_t>(all.size());
  freeze_contacts();
}

void World::Impl::add_sleep_events() {
  for (const std::uint32_t body : changed_sleep.list()) {
    const EventKind kind = bodies[body].is_asleep() ? EventKind::sleep : EventKind::wake;
    events.push_back({kind, {body, bodies[body].generation}, {}, {}});
    bodies[body].flags &= static_cast<std::uint8_t>(~k_body_changed_sleep);
    body_hashes.mark(body);
  }
  changed_sleep.clear();
}

Status World::Impl::execute(const WakeBody& command) {
  const BodyRecord* record = find(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!record->moves()) return Status::invalid_argument;
  wake(command.body.index);
  return Status::ok;
}

Status World::Impl::execute(const SleepBody& command) {
  const BodyRecord* record = find(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!record->is_dynamic() || rest_rules.ticks == 0) return Status::invalid_argument;
  if (record->is_asleep()) return Status::ok;
  join_islands();
  joint_graph.forget_awake_list();  // nothing was woken across joints: that is for the next step
  const std::uint32_t island = islands.root(command.body.index);
  to_sleep.clear();
  for (const std::uint32_t body : awake.list()) {
    if (!bodies[body].is_dynamic() || islands.root(body) != island) continue;
    if (!bodies[body].may_sleep()) return Status::invalid_argument;
    to_sleep.push_back(body);
  }
  for (const std::uint32_t body : to_sleep)
    set_asleep(body);
  freeze_contacts();
  return Status::ok;
}

Status World::Impl::execute(const SetAllowSleep& command) {
  BodyRecord* record = edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (!record->moves()) return Status::invalid_argument;
  if (!command.allow) wake(command.body.index);
  record->flags = static_cast<std::uint8_t>(command.allow ? record->flags & ~k_body_no_sleep
                                                          : record->flags | k_body_no_sleep);
  begin_rest(*record, rest_rules);
  return Status::ok;
}

}  // namespace lockstone
