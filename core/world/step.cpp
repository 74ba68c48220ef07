// The tick.

#include <algorithm>

#include "core/dynamics/contact_solver.h"
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

// |x| + |y| + |z|, at least the length.
std::int64_t sum_of_magnitudes(const Vec3<Velocity>& v) {
  return abs(v.x).raw + abs(v.y).raw + abs(v.z).raw;
}

// How far a body goes in one tick, along one axis.
Position travel(Velocity v, const TimeStep& step) {
  return Position::from_raw(step.tick.times(v.raw));
}

// How far ahead a pair must look: what it can close in one tick, but no farther than the bodies are
// thick, lest a glancing pass be taken for a hit.
Length speculative_distance(const BodyRecord& a, const BodyRecord& b, Length thickness,
                            const TimeStep& step) {
  const std::int64_t closing = step.tick.times(sum_of_magnitudes(a.velocity - b.velocity));
  const Length reach = Length::from_raw(raw::saturate<std::int32_t>(raw::round_shift(closing, 12)));
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
                  {record.filter(), record.moves(), record.is_dynamic(), record.is_trigger()});
}

StepReport World::Impl::step() {
  StepReport report;
  find_pairs(report);
  collide_pairs(report);
  prepare_contacts(report);
  run_substeps(report);
  store_impulses();
  move_bodies(report);
  stop_at_impacts(report);
  refresh_moved();
  find_events();
  profiler.count_step();
  ++header.tick;
  return report;
}

void World::Impl::find_pairs(StepReport& report) {
  const StageTimer timer(profiler, StepStage::find_pairs);
  pairs = broad_phase.find_pairs();
  report.pairs = static_cast<std::uint32_t>(pairs.size());
  if (broad_phase.overflowed()) report.status = Status::capacity_exhausted;
}

// Both contact lists are sorted by key, so that one pass carries records over.
void World::Impl::collide_pairs(StepReport& report) {
  const StageTimer timer(profiler, StepStage::collide);
  new_contacts.clear();
  manifolds.clear();
  surfaces.clear();
  std::span<const ContactRecord> before = contacts();
  const auto bodies_of = [](const ContactRecord& r) { return Pair{r.body_a, r.body_b}; };
  for (const Pair& pair : pairs) {
    while (!before.empty() && bodies_of(before.front()) < pair)
      before = before.subspan(1);
    std::size_t known = 0;
    while (known < before.size() && bodies_of(before[known]) == pair)
      ++known;
    collide_pair(pair, before.first(known), report);
    before = before.subspan(known);
  }
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
  const Length thickness = max(inner_radii[pair.a], inner_radii[pair.b]);
  const Length margin = speculative_distance(a, b, thickness, time_step);
  collide_bodies(placed(pair.a), placed(pair.b), margin, triangle_scratch.get(), part_contacts);
  timer.found(part_contacts.count);
  if (part_contacts.overflowed) report.status = Status::capacity_exhausted;
  for (const PartContact& contact : part_contacts)
    add_contact(pair, contact, before, report);
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
  surfaces.emplace_back();
}

// The record keeps the impulses and the touching flag of the tick before.
void World::Impl::add_contact(const Pair& pair, const PartContact& contact,
                              std::span<const ContactRecord> before, StepReport& report) {
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
  if (new_contacts.size() == def.contact_capacity) {
    report.status = Status::capacity_exhausted;
    return false;
  }
  new_contacts.push_back(record);
  return true;
}

// Bodies enter the solver when a constraint first names them.
std::uint32_t World::Impl::solver_body_of(std::uint32_t body) {
  if (!bodies[body].moves()) return 0;
  if (solver_index[body] == 0) {
    solver_index[body] = static_cast<std::uint32_t>(solver_bodies.size());
    solver_bodies.push_back(
        begin_substeps(bodies[body], rotations[body], header.gravity, time_step));
    solver_bodies.back().body = body;
  }
  return solver_index[body];
}

void World::Impl::prepare_contacts(StepReport& report) {
  const StageTimer timer(profiler, StepStage::prepare);
  constraints.clear();
  solver_bodies.clear();
  solver_bodies.emplace_back();
  std::fill_n(solver_index.begin(), header.body_limit, 0U);
  approach_speeds.assign(new_contacts.size(), SolverVelocity{});
  for (std::size_t i = 0; i < new_contacts.size(); ++i) {
    const ContactRecord& record = new_contacts[i];
    if (record.is_trigger()) continue;
    const std::uint32_t a = solver_body_of(record.body_a);
    const std::uint32_t b = solver_body_of(record.body_b);
    ContactConstraint& contact = constraints.emplace_back();
    contact.body_a = a;
    contact.body_b = b;
    contact.record = static_cast<std::uint32_t>(i);
    report.saturations += static_cast<std::uint32_t>(
        prepare_contact({bodies[record.body_a], bodies[record.body_b], solver_bodies[a],
                         solver_bodies[b], manifolds[i], record, surfaces[i]},
                        softness, contact));
    report.contact_points += static_cast<std::uint32_t>(contact.count);
  }
  report.contacts = static_cast<std::uint32_t>(constraints.size());
}

void World::Impl::run_substeps(StepReport& report) {
  const StageTimer timer(profiler, StepStage::solve);
  if (constraints.empty()) return;
  ContactSolver solver(solver_bodies, constraints, time_step);
  const std::span<SolverBody> moving = std::span(solver_bodies).subspan(1);
  for (int substep = 0; substep < time_step.substeps; ++substep) {
    for (SolverBody& body : moving)
      integrate_velocity(body);
    solver.warm_start();
    solver.solve(true);
    for (SolverBody& body : moving)
      integrate_position(body, time_step);
    solver.solve(false);
  }
  solver.apply_restitution();
  report.saturations += solver.saturations();
}

// The new records: what each point ended with, and whether the surfaces met.
void World::Impl::store_impulses() {
  const StageTimer timer(profiler, StepStage::store);
  for (const ContactConstraint& contact : constraints) {
    ContactRecord& record = new_contacts[contact.record];
    record.points = {};
    record.count = static_cast<std::uint16_t>(contact.count);
    bool touching = false;
    std::int32_t approach = 0;
    for (std::size_t i = 0; i < record.count; ++i) {
      const ContactPoint& point = contact.points[i];
      record.points[i] = {manifolds[contact.record].points[i].feature,
                          SolverVelocity::from_raw(point.normal.impulse),
                          SolverVelocity::from_raw(point.tangent[0].impulse),
                          SolverVelocity::from_raw(point.tangent[1].impulse)};
      touching = touching || point.separation <= 0 || point.largest_impulse > 0;
      approach = std::min(approach, point.approach);
    }
    approach_speeds[contact.record] = SolverVelocity::from_raw(-approach);
    record.flags = touching ? k_contact_touching : 0;
    record.tangent_axis = contact.tangent_axis;
  }
}

void World::Impl::move_bodies(StepReport& report) {
  const StageTimer timer(profiler, StepStage::move);
  moved.clear();
  for (std::uint32_t body = 0; body < header.body_limit; ++body) {
    if (!bodies[body].moves()) continue;
    starts[body] = {bodies[body].position, bodies[body].orientation};
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
  const std::uint32_t solver = solver_index[body];
  const InverseInertia inertia = solver != 0 ? solver_bodies[solver].inverse_inertia
                                             : inverse_inertia(record, rotations[body]);
  if (solver != 0) {
    end_substeps(record, solver_bodies[solver]);
  } else {
    fly(record, rotations[body], header.gravity, time_step, header.tick);
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
  header.contact_count = static_cast<std::uint32_t>(new_contacts.size());
}

}  // namespace lockstone
