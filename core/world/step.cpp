// The tick.

#include <algorithm>

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
  const WorldBox box = world_box(placed(body));
  Bounds bounds;
  for (int i = 0; i < 3; ++i) {
    const Position margin = rounded<Position>(k_contact_margin / 2);
    const Position swept = travel(record.velocity[i], time_step);
    bounds.lower[i] = round_down(box.lower[i] - margin + min(swept, Position{}));
    bounds.upper[i] = round_up(box.upper[i] + margin + max(swept, Position{}));
  }
  broad_phase.set(body, bounds,
                  {record.filter(), record.moves(), record.is_dynamic(), record.is_trigger(),
                   record.is_asleep()});
}

StepReport World::Impl::step() {
  StepReport report;
  find_pairs(report);
  collide_pairs(report);
  solve_contacts(report);
  move_bodies(report);
  stop_at_impacts(report);
  refresh_moved();
  find_events();
  mark_joints();
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
    pairs = broad_phase.find_pairs();
  } while (wake_met());
  report.pairs = static_cast<std::uint32_t>(pairs.size());
  if (broad_phase.overflowed()) report.status = Status::capacity_exhausted;
}

// Both contact lists are sorted by key, so that one pass carries records over.
void World::Impl::collide_pairs(StepReport& report) {
  const StageTimer timer(profiler, StepStage::collide);
  std::swap(manifolds, old_manifolds);
  std::swap(inputs, old_inputs);
  new_contacts.clear();
  manifolds.clear();
  inputs.clear();
  surfaces.clear();
  std::span<const ContactRecord> before = contacts();
  const auto bodies_of = [](const ContactRecord& r) { return Pair{r.body_a, r.body_b}; };
  auto joined = joined_pairs.begin();
  for (const Pair& pair : pairs) {
    while (joined != joined_pairs.end() && *joined < pair)
      ++joined;
    if (joined != joined_pairs.end() && *joined == pair) continue;
    while (!before.empty() && bodies_of(before.front()) < pair)
      before = before.subspan(1);
    std::size_t known = 0;
    while (known < before.size() && bodies_of(before[known]) == pair)
      ++known;
    collide_pair(pair, before.first(known), report);
    before = before.subspan(known);
  }
  remembers_manifolds = true;
}

Length World::Impl::margin_of(const Pair& pair) const {
  const Length thickness = max(inner_radii[pair.a], inner_radii[pair.b]);
  return speculative_distance(bodies[pair.a], bodies[pair.b], thickness, time_step);
}

// Whether the two would get a contact now.
bool World::Impl::meet(const Pair& pair) {
  if (bodies[pair.a].is_trigger() || bodies[pair.b].is_trigger()) return false;
  collide_bodies(placed(pair.a), placed(pair.b), margin_of(pair), triangle_scratch.get(),
                 part_contacts);
  return part_contacts.count > 0;
}

// `before`: the records of this pair a tick ago.
void World::Impl::collide_pair(const Pair& pair, std::span<const ContactRecord> before,
                               StepReport& report) {
  const BodyRecord& a = bodies[pair.a];
  const BodyRecord& b = bodies[pair.b];
  PairTimer timer(profiler, a.shape().kind, b.shape().kind);
  if (a.is_trigger() || b.is_trigger()) {
    if (bodies_overlap(placed(pair.a), placed(pair.b))) add_trigger(pair, before, report);
    return;
  }
  const Length margin = margin_of(pair);
  const ManifoldInput input = manifold_input(pair, margin);
  if (const Manifold* known = known_manifold(before, input); known != nullptr) {
    timer.found(1, 1);
    add_contact(pair, {0, 0, nullptr, nullptr, *known}, input, before, report);
    return;
  }
  collide_bodies(placed(pair.a), placed(pair.b), margin, triangle_scratch.get(), part_contacts);
  timer.found(part_contacts.count);
  if (part_contacts.overflowed) report.status = Status::capacity_exhausted;
  for (const PartContact& contact : part_contacts)
    add_contact(pair, contact, input, before, report);
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
  const bool same = record.part_a == 0 && record.part_b == 0 && old_inputs[index] == input &&
                    has_one_piece(record.body_a) && has_one_piece(record.body_b);
  return same ? &old_manifolds[index] : nullptr;
}

bool World::Impl::has_one_piece(std::uint32_t body) const {
  const Asset* asset = body_assets[body];
  return asset == nullptr || asset->polytope() != nullptr;
}

void World::Impl::add_trigger(const Pair& pair, std::span<const ContactRecord> before,
                              StepReport& report) {
  ContactRecord record;
  if (!before.empty()) record = before.front();
  record.body_a = pair.a;
  record.body_b = pair.b;
  record.flags = static_cast<std::uint8_t>(record.flags | k_contact_trigger);
  if (!add_record(record, report)) return;
  manifolds.emplace_back();
  inputs.emplace_back();
  surfaces.emplace_back();
}

// The record keeps the impulses and the touching flag of the tick before.
void World::Impl::add_contact(const Pair& pair, const PartContact& contact,
                              const ManifoldInput& input, std::span<const ContactRecord> before,
                              StepReport& report) {
  const ContactKey key{pair.a, pair.b, contact.part_a, contact.part_b};
  const auto old = std::ranges::find(before, key, &ContactRecord::key);
  ContactRecord record;
  if (old != before.end()) record = *old;
  record.body_a = key.body_a;
  record.body_b = key.body_b;
  record.part_a = key.part_a;
  record.part_b = key.part_b;
  if (!add_record(record, report)) return;
  manifolds.push_back(contact.manifold);
  inputs.push_back(input);
  surfaces.push_back(surfaces_of(pair, contact));
}

// A part's own surface, or the body's.
SurfacePair World::Impl::surfaces_of(const Pair& pair, const PartContact& contact) const {
  const auto surface = [](const BodyRecord& body, const Surface* part) {
    return part != nullptr ? *part : Surface{body.friction, body.restitution};
  };
  return {surface(bodies[pair.a], contact.surface_a), surface(bodies[pair.b], contact.surface_b)};
}

bool World::Impl::add_record(const ContactRecord& record, StepReport& report) {
  if (new_contacts.size() + frozen.count() == def.contact_capacity) {
    report.status = Status::capacity_exhausted;
    return false;
  }
  new_contacts.push_back(record);
  return true;
}

void World::Impl::solve_contacts(StepReport& report) {
  approach_speeds.assign(new_contacts.size(), SolverVelocity{});
  prepare_contacts();
  run_substeps();
  store_impulses();
  report.contacts = solver.contacts();
  report.contact_points = solver.points();
  report.colors = solver.colors();
  report.overflow_contacts = solver.overflow();
  report.saturations += solver.saturations();
}

void World::Impl::prepare_contacts() {
  const StageTimer timer(profiler, StepStage::prepare);
  solver.prepare({std::span(bodies).first(header.body_limit), rotations, manifolds, surfaces,
                  new_contacts, header.gravity},
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
    starts[body] = {bodies[body].position, bodies[body].orientation};
    body_hashes.mark(body);
    move_body(body, report);
    moved.push_back(body);
  }
}

// As `refresh` does for each, with the rotations all at once.
void World::Impl::refresh_moved() {
  const StageTimer timer(profiler, StepStage::refresh);
  if (moved.empty()) return;
  const lanes::QuatField orientations{&bodies.front().orientation, sizeof(BodyRecord)};
  lanes::compute_rotations(orientations, moved, rotations.data());
  for (const std::uint32_t body : moved)
    refresh_bounds(body);
  broad_phase.settle();
}

void World::Impl::move_body(std::uint32_t body, StepReport& report) {
  BodyRecord& record = bodies[body];
  const SolverBody* solved = solver.find(body);
  const InverseInertia inertia =
      solved != nullptr ? solved->inverse_inertia : inverse_inertia(record, rotations[body]);
  if (solved != nullptr) {
    report.axis_turns += solver.move(*solved, rotations[body], record);
  } else {
    report.axis_turns += fly(record, rotations[body], header.gravity, time_step, header.tick);
    ++report.free_bodies;
  }
  apply_damping(record, time_step);
  report.saturations += limit_speed(record, inertia) ? 1U : 0U;
  report.saturations += limit_position(record) ? 1U : 0U;
  ++report.moving_bodies;
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
  events.push_back(
      {kind, {pair.a, bodies[pair.a].generation}, {pair.b, bodies[pair.b].generation}, approach});
}

// What the records of the first pair of bodies say together; they are taken from the list. The
// approach speed is the greatest of its contacts.
World::Impl::PairState World::Impl::take_pair(std::span<const ContactRecord>& records,
                                              std::span<const SolverVelocity> approaches) {
  PairState state;
  state.exists = true;
  state.bodies = {records.front().body_a, records.front().body_b};
  while (!records.empty() && Pair{records.front().body_a, records.front().body_b} == state.bodies) {
    const ContactRecord& record = records.front();
    state.trigger = state.trigger || record.is_trigger();
    state.touching = state.touching || record.is_touching() || record.is_trigger();
    if (!approaches.empty()) {
      const std::size_t index = approaches.size() - records.size();
      state.approach = max(state.approach, approaches[index]);
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
  std::copy(new_contacts.begin(), new_contacts.end(), contact_store.begin());
  active_contacts = static_cast<std::uint32_t>(new_contacts.size());
  header.contact_count = active_contacts + frozen.count();
}

}  // namespace lockstone
