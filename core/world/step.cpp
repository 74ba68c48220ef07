// The tick.

#include <algorithm>
#include <atomic>

#include "core/dynamics/motion.h"
#include "core/geometry/shape_properties.h"
#include "core/math/wide/rotations.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// Pairs closer than this get contact points ahead of time. Half of it widens each body's bounds.
constexpr Length k_contact_margin = Length::from_ratio(1, 50);

// Largest speculative distance, so that Displacement holds it.
constexpr Length k_max_speculation = Length::from_integer(32);

// How far a pair can close is rounded up to 1 mm, so that what trembles keeps its margin.
constexpr int k_reach_bits = 10;

// Pairs that are worth a worker.
constexpr std::uint32_t k_pair_grain = 8;
constexpr std::uint32_t k_number_grain = 256;
constexpr std::uint32_t k_body_grain = 32;
constexpr std::uint32_t k_copy_grain = 512;

// How far a body goes in one tick, along one axis.
Position travel(Velocity v, const TimeStep& step) {
  return Position::from_raw(step.tick.times(v.raw));
}

// How far ahead a pair must look: what it can close in one tick, but no farther than the bodies are
// thick, lest a glancing pass be taken for a hit.
Length speculative_distance(const BodyRecord& a, const BodyRecord& b, Length thickness,
                            const TimeStep& step) {
  constexpr std::int64_t k_below_step = (std::int64_t{1} << k_reach_bits) - 1;
  const std::int64_t closing = step.tick.times(sum_of_magnitudes(a.velocity - b.velocity));
  const std::int64_t steps = ((closing >> 12) + k_below_step) >> k_reach_bits;
  const Length reach = Length::from_raw(raw::saturate<std::int32_t>(steps << k_reach_bits));
  return k_contact_margin + min(min(reach, thickness), k_max_speculation);
}

}  // namespace

void World::Impl::refresh(std::uint32_t body) {
  rotations[body] = to_matrix(bodies[body].orientation);
  refresh_bounds(body);
}

void World::Impl::refresh_bounds(std::uint32_t body) {
  const BodyRecord& record = bodies[body];
  inner_radii[body] = inner_radius(record.shape(), body_assets[body]);
  broad_phase.set(body, bounds_of(body),
                  {record.filter(), record.moves(), record.is_dynamic(), record.is_trigger(),
                   record.is_asleep()});
}

// Where the body is, and where it goes in a tick, with a margin.
Bounds World::Impl::bounds_of(std::uint32_t body) const {
  const BodyRecord& record = bodies[body];
  const WorldBox box = world_box(placed(body));
  Bounds bounds;
  for (int i = 0; i < 3; ++i) {
    const Position margin = rounded<Position>(k_contact_margin / 2);
    const Position swept = travel(record.velocity[i], time_step);
    bounds.lower[i] = round_down(box.lower[i] - margin + min(swept, Position{}));
    bounds.upper[i] = round_up(box.upper[i] + margin + max(swept, Position{}));
  }
  return bounds;
}

StepReport World::Impl::step() {
  StepReport report;
  if (traces_stages) stage_digests.before = digest_of(StepStage::move);
  find_pairs(report);
  collide_pairs(report);
  solve_contacts(report);
  move_bodies(report);
  stop_at_impacts(report);
  refresh_moved();
  find_events();
  mark_joints();
  break_joints();
  rest_bodies(report);
  add_sleep_events();
  profiler.count_step();
  ++header.tick;
  return report;
}

void World::Impl::find_pairs(StepReport& report) {
  const StageTimer timer(profiler, StepStage::find_pairs);
  do {
    find_active_joints();
    pairs = broad_phase.find_pairs(parallel);
  } while (wake_met());
  report.pairs = static_cast<std::uint32_t>(pairs.size());
  if (broad_phase.overflowed()) report.status = Status::capacity_exhausted;
}

// Each pair leaves what it found in slots of its own; then the contacts are numbered in the order
// of the pairs.
void World::Impl::collide_pairs(StepReport& report) {
  const StageTimer timer(profiler, StepStage::collide);
  std::swap(slots, old_slots);
  std::swap(manifolds, old_manifolds);
  std::swap(inputs, old_inputs);
  found_contacts.resize(pairs.size());
  if (!collide_side_by_side()) collide_one_by_one();
  if (narrow.has_overflowed()) report.status = Status::capacity_exhausted;
  number_contacts(report);
  remembers_manifolds = true;
}

Length World::Impl::margin_of(const Pair& pair) const {
  const Length thickness = max(inner_radii[pair.a], inner_radii[pair.b]);
  return speculative_distance(bodies[pair.a], bodies[pair.b], thickness, time_step);
}

// Whether the two would get a contact now.
bool World::Impl::meet(const Pair& pair) {
  if (bodies[pair.a].is_trigger() || bodies[pair.b].is_trigger()) return false;
  PairScratch& scratch = narrow.scratch(0);
  collide_bodies(placed(pair.a), placed(pair.b), margin_of(pair), scratch.triangles.get(),
                 scratch.part_contacts);
  return scratch.part_contacts.count > 0;
}

// Answers whether all found room.
bool World::Impl::collide_side_by_side() {
  narrow.begin(parallel.workers());
  parallel.for_each(
      {static_cast<std::uint32_t>(pairs.size()), k_pair_grain, profiler.times_pairs()},
      [&](std::uint32_t first, std::uint32_t end, std::uint32_t worker) {
        collide_piece(first, end, narrow.scratch(worker));
      });
  return parallel.workers() == 1 || !narrow.is_out_of_slots();
}

// Slots are given out in the order of the pairs, so that the last pairs are those that find none.
void World::Impl::collide_one_by_one() {
  narrow.begin(1);
  collide_piece(0, static_cast<std::uint32_t>(pairs.size()), narrow.scratch(0));
}

// Old contacts are sorted by key and pairs are too, so that one pass carries records over.
void World::Impl::collide_piece(std::uint32_t first, std::uint32_t end, PairScratch& scratch) {
  const auto bodies_of = [](const ContactRecord& r) { return Pair{r.body_a, r.body_b}; };
  const std::span<const ContactRecord> all = contacts();
  const auto begin = std::ranges::lower_bound(all, pairs[first], {}, bodies_of);
  std::span<const ContactRecord> before(begin, all.end());
  auto joined = std::ranges::lower_bound(joined_pairs, pairs[first]);
  for (std::uint32_t i = first; i < end; ++i) {
    found_contacts[i] = {};
    while (joined != joined_pairs.end() && *joined < pairs[i])
      ++joined;
    if (joined != joined_pairs.end() && *joined == pairs[i]) continue;
    while (!before.empty() && bodies_of(before.front()) < pairs[i])
      before = before.subspan(1);
    std::size_t known = 0;
    while (known < before.size() && bodies_of(before[known]) == pairs[i])
      ++known;
    collide_pair(i, before.first(known), scratch);
    before = before.subspan(known);
  }
}

// `before`: the records of this pair a tick ago.
void World::Impl::collide_pair(std::uint32_t index, std::span<const ContactRecord> before,
                               PairScratch& scratch) {
  const Pair pair = pairs[index];
  const BodyRecord& a = bodies[pair.a];
  const BodyRecord& b = bodies[pair.b];
  PairTimer timer(profiler, a.shape().kind, b.shape().kind);
  if (a.is_trigger() || b.is_trigger()) {
    if (bodies_overlap(placed(pair.a), placed(pair.b))) add_trigger(index, before, scratch);
    return;
  }
  const Length margin = margin_of(pair);
  const ManifoldInput input = manifold_input(pair, margin);
  if (const Manifold* known = known_manifold(before, input); known != nullptr) {
    timer.found(1, 1);
    const PartContact contact{0, 0, nullptr, nullptr, *known};
    return add_contacts(index, {&contact, 1}, input, before, scratch);
  }
  PartContacts& parts = scratch.part_contacts;
  collide_bodies(placed(pair.a), placed(pair.b), margin, scratch.triangles.get(), parts);
  timer.found(parts.count);
  if (parts.overflowed) narrow.note_overflow();
  add_contacts(index, {parts.begin(), parts.end()}, input, before, scratch);
}

// Centres are read to the lengths that primitives are collided with; frames of assets follow from
// every bit.
World::Impl::ManifoldInput World::Impl::manifold_input(const Pair& pair, Length margin) const {
  const BodyRecord& a = bodies[pair.a];
  const BodyRecord& b = bodies[pair.b];
  Vec3<Position> offset = b.position - a.position;
  if (body_assets[pair.a] == nullptr && body_assets[pair.b] == nullptr) {
    offset = rounded<Position>(saturated<Length>(offset));
  }
  return {offset, a.orientation, b.orientation, margin};
}

// The manifold of a tick ago when it would come out the same: only of pairs with a single contact,
// which parts 0 and 0 name.
const Manifold* World::Impl::known_manifold(std::span<const ContactRecord> before,
                                            const ManifoldInput& input) const {
  if (!remembers_manifolds || before.size() != 1) return nullptr;
  const ContactRecord& record = before.front();
  const auto index = static_cast<std::size_t>(&record - contact_store.data());
  const std::uint32_t slot = old_slots[index];
  if (slot == NarrowSlots::k_none) return nullptr;
  const bool same = record.part_a == 0 && record.part_b == 0 && old_inputs[slot] == input &&
                    has_one_piece(record.body_a) && has_one_piece(record.body_b);
  return same ? &old_manifolds[slot] : nullptr;
}

bool World::Impl::has_one_piece(std::uint32_t body) const {
  const Asset* asset = body_assets[body];
  return asset == nullptr || asset->polytope() != nullptr;
}

void World::Impl::add_trigger(std::uint32_t index, std::span<const ContactRecord> before,
                              PairScratch& scratch) {
  const std::uint32_t slot = narrow.take(scratch, 1);
  if (slot == NarrowSlots::k_none) return;
  found_contacts[index] = {slot, 1};
  origins[slot] = {0, 0, before.empty() ? k_new : index_of(before.front())};
  manifolds[slot] = {};
  inputs[slot] = {};
  surfaces[slot] = {};
  surfaces[slot].tag_a = bodies[pairs[index].a].tag;
  surfaces[slot].tag_b = bodies[pairs[index].b].tag;
}

void World::Impl::add_contacts(std::uint32_t index, std::span<const PartContact> parts,
                               const ManifoldInput& input, std::span<const ContactRecord> before,
                               PairScratch& scratch) {
  if (parts.empty()) return;
  const auto count = static_cast<std::uint32_t>(parts.size());
  const std::uint32_t first = narrow.take(scratch, count);
  if (first == NarrowSlots::k_none) return;
  const Pair pair = pairs[index];
  found_contacts[index] = {first, count};
  for (std::uint32_t i = 0; i < count; ++i) {
    const PartContact& contact = parts[i];
    const ContactKey key{pair.a, pair.b, contact.part_a, contact.part_b};
    const auto old = std::ranges::find(before, key, &ContactRecord::key);
    origins[first + i] = {key.part_a, key.part_b, old == before.end() ? k_new : index_of(*old)};
    manifolds[first + i] = contact.manifold;
    inputs[first + i] = input;
    surfaces[first + i] = surface_of(pair, contact);
  }
}

// Within contact_store.
std::uint32_t World::Impl::index_of(const ContactRecord& record) const {
  return static_cast<std::uint32_t>(&record - contact_store.data());
}

void World::Impl::number_contacts(StepReport& report) {
  const std::uint32_t room = def.contact_capacity - frozen.count();
  std::uint32_t count = 0;
  for (FoundContacts& of_pair : found_contacts) {
    of_pair.count = std::min(of_pair.count, room - count);
    of_pair.index = count;
    count += of_pair.count;
  }
  if (narrow.taken() > count) report.status = Status::capacity_exhausted;
  slots.resize(count);
  new_contacts.resize(count);
  approach_speeds.resize(count);
  parallel.for_each({static_cast<std::uint32_t>(pairs.size()), k_number_grain},
                    [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
                      for (std::uint32_t i = first; i < end; ++i)
                        number_contacts_of(i);
                    });
}

// A record keeps the impulses and the touching flag of the tick before.
void World::Impl::number_contacts_of(std::uint32_t pair) {
  const FoundContacts& of_pair = found_contacts[pair];
  for (std::uint32_t i = 0; i < of_pair.count; ++i) {
    const std::uint32_t slot = of_pair.slot + i;
    const ContactOrigin& origin = origins[slot];
    const Pair& both = pairs[pair];
    ContactRecord record = origin.before == k_new ? ContactRecord{} : contact_store[origin.before];
    record.body_a = both.a;
    record.body_b = both.b;
    record.part_a = origin.part_a;
    record.part_b = origin.part_b;
    if (bodies[both.a].is_trigger() || bodies[both.b].is_trigger()) {
      record.flags = static_cast<std::uint8_t>(record.flags | k_contact_trigger);
    }
    slots[of_pair.index + i] = slot;
    new_contacts[of_pair.index + i] = record;
    approach_speeds[of_pair.index + i] = {};
  }
}

void World::Impl::solve_contacts(StepReport& report) {
  find_bounces();
  prepare_contacts();
  run_substeps();
  store_impulses();
  report.contacts = solver.contacts();
  report.contact_points = solver.points();
  report.contacts += static_cast<std::uint32_t>(bouncing_contacts.size());
  for (const BouncingContact& each : bouncing_contacts) {
    const Manifold& manifold = manifolds[slots[each.contact]];
    report.contact_points += static_cast<std::uint32_t>(manifold.count);
  }
  report.colors = solver.colors();
  report.overflow_contacts = solver.overflow();
  report.saturations += solver.saturations();
}

void World::Impl::prepare_contacts() {
  const StageTimer timer(profiler, StepStage::prepare);
  solver.prepare(
      {std::span(bodies).first(header.body_limit), rotations, slots, manifolds, surfaces,
       new_contacts, std::span(joints).first(header.joint_limit), active_joints, header.gravity},
      parallel);
}

void World::Impl::run_substeps() {
  const StageTimer timer(profiler, StepStage::solve);
  solver.run(parallel);
}

// The new records: what each contact ended with, and whether the surfaces met.
void World::Impl::store_impulses() {
  const StageTimer timer(profiler, StepStage::store);
  solver.store(manifolds, new_contacts, approach_speeds, parallel);
  solver.store_joints(active_joints, joints, parallel);
}

// Joints of awake bodies may have changed.
void World::Impl::mark_joints() {
  for (const JointLink& joint : active_joints)
    joint_hashes.mark(joint.joint);
}

void World::Impl::move_bodies(StepReport& report) {
  const StageTimer timer(profiler, StepStage::move);
  moved.clear();
  for (const std::uint32_t body : awake.list()) {
    body_hashes.mark(body);
    moved.push_back(body);
  }
  report.moving_bodies = static_cast<std::uint32_t>(moved.size());
  run_bounces();
  std::atomic<std::uint32_t> free_bodies{0}, axis_turns{0}, saturations{0};
  parallel.for_each(each_moved(), [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
    MoveCounts counts;
    for (std::uint32_t i = first; i < end; ++i) {
      move_body(moved[i], counts);
      note_far_mover(moved[i]);
    }
    free_bodies.fetch_add(counts.free_bodies, std::memory_order_relaxed);
    axis_turns.fetch_add(counts.axis_turns, std::memory_order_relaxed);
    saturations.fetch_add(counts.saturations, std::memory_order_relaxed);
  });
  report.free_bodies = free_bodies;
  report.axis_turns += axis_turns;
  report.saturations += saturations;
}

Loop World::Impl::each_moved() const {
  return {static_cast<std::uint32_t>(moved.size()), k_body_grain};
}

// As `refresh` does for each, with the rotations all at once. Only what leaves its fat box changes
// more of the broad phase than its own bounds.
void World::Impl::refresh_moved() {
  const StageTimer timer(profiler, StepStage::refresh);
  std::atomic<bool> changed{false};
  parallel.for_each(each_moved(), [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
    const lanes::QuatField orientations{&bodies.front().orientation, sizeof(BodyRecord)};
    lanes::compute_rotations(orientations, std::span(moved).subspan(first, end - first),
                             rotations.data());
    bool any = false;
    for (std::uint32_t i = first; i < end; ++i) {
      const Bounds bounds = bounds_of(moved[i]);
      any = any || bounds != broad_phase.bounds(moved[i]);
      leaves_fat_box[i] = broad_phase.follow(moved[i], bounds) ? 0 : 1;
    }
    if (any) changed.store(true, std::memory_order_relaxed);
  });
  if (changed) broad_phase.note_change();
  for (std::size_t i = 0; i < moved.size(); ++i) {
    if (leaves_fat_box[i] != 0) refresh_bounds(moved[i]);
  }
  if (!moved.empty()) broad_phase.settle();
}

void World::Impl::move_body(std::uint32_t body, MoveCounts& counts) {
  BodyRecord& record = bodies[body];
  const bool bounced = has_bounced[body] != 0;
  if (!bounced) starts[body] = {record.position, record.orientation};
  const SolverBody* solved = solver.find(body);
  const InverseInertia inertia =
      solved != nullptr ? solved->inverse_inertia : inverse_inertia(record, rotations[body]);
  if (solved != nullptr) {
    counts.axis_turns += solver.move(*solved, rotations[body], record);
    if (record.is_dynamic()) damp_velocity(record, time_step);
  } else if (bounced) {
    damp_velocity(record, time_step);
    ++counts.free_bodies;
  } else {
    counts.axis_turns += fly(record, rotations[body], header.gravity, time_step, header.tick);
    ++counts.free_bodies;
  }
  damp_spin(record, time_step);
  hold_axes(record);
  counts.saturations += limit_speed(record, inertia, def.speed_limit) ? 1U : 0U;
  counts.saturations += limit_position(record) ? 1U : 0U;
  if (record.is_pushed()) end_pushes(record, rest_rules);
}

// Begin, stay or end of what a pair of bodies did before and does now.
void World::Impl::add_event(const PairState& before, const PairState& now) {
  const bool was = before.touching, is = now.touching;
  const bool trigger = before.trigger || now.trigger;
  if (!trigger && was == is) return;
  const Pair pair = now.exists ? now.bodies : before.bodies;
  const EventKind kind = trigger ? (!is   ? EventKind::trigger_exit
                                    : was ? EventKind::trigger_stay
                                          : EventKind::trigger_enter)
                                 : (is ? EventKind::contact_begin : EventKind::contact_end);
  const Velocity approach =
      kind == EventKind::contact_begin ? rounded<Velocity>(now.approach) : Velocity{};
  const bool ended = !now.exists;
  events.push_back({kind,
                    {pair.a, bodies[pair.a].generation},
                    {pair.b, bodies[pair.b].generation},
                    approach,
                    ended ? bodies[pair.a].tag : now.tag_a,
                    ended ? bodies[pair.b].tag : now.tag_b});
}

// What the records of the first pair of bodies say together; they are taken from the list. The
// approach speed is the greatest of its contacts.
World::Impl::PairState World::Impl::take_pair(std::span<const ContactRecord>& records,
                                              std::span<const SolverVelocity> approaches) const {
  PairState state;
  state.exists = true;
  state.bodies = {records.front().body_a, records.front().body_b};
  while (!records.empty() && Pair{records.front().body_a, records.front().body_b} == state.bodies) {
    const ContactRecord& record = records.front();
    state.trigger = state.trigger || record.is_trigger();
    state.touching = state.touching || record.is_touching() || record.is_trigger();
    if (!approaches.empty()) {
      const std::size_t index = approaches.size() - records.size();
      const bool first = state.contacts++ == 0;
      if (first || approaches[index] > state.approach) {
        state.approach = approaches[index];
        const ContactSurface& surface = surfaces[slots[index]];
        state.tag_a = surface.tag_a;
        state.tag_b = surface.tag_b;
      }
    }
    records = records.subspan(1);
  }
  return state;
}

// Merges the old and the new contacts, both sorted by pair, and makes the new ones the state.
void World::Impl::find_events() {
  const StageTimer timer(profiler, StepStage::events);
  events.clear();
  std::span<const ContactRecord> before = contacts(), now = new_contacts;
  while (!before.empty() || !now.empty()) {
    const auto bodies_of = [](const ContactRecord& r) { return Pair{r.body_a, r.body_b}; };
    const bool take_old =
        now.empty() || (!before.empty() && bodies_of(before.front()) <= bodies_of(now.front()));
    const bool take_new =
        before.empty() || (!now.empty() && bodies_of(now.front()) <= bodies_of(before.front()));
    const PairState was = take_old ? take_pair(before, {}) : PairState{};
    const PairState is = take_new ? take_pair(now, approach_speeds) : PairState{};
    add_event(was, is);
  }
  events.insert(events.end(), impacts.begin(), impacts.end());
  active_contacts = static_cast<std::uint32_t>(new_contacts.size());
  parallel.for_each({active_contacts, k_copy_grain},
                    [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
                      std::copy(new_contacts.begin() + first, new_contacts.begin() + end,
                                contact_store.begin() + first);
                    });
  header.contact_count = active_contacts + frozen.count();
}

}  // namespace lockstone
