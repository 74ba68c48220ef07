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

Vec3<Length> offset_between(const Vec3<Position>& from, const Vec3<Position>& to) {
  return saturated<Length>(to - from);
}

}  // namespace

void World::Impl::refresh(std::uint32_t body) {
  rotations[body] = to_matrix(bodies[body].orientation);
  refresh_bounds(body);
}

void World::Impl::refresh_bounds(std::uint32_t body) {
  const BodyRecord& record = bodies[body];
  inner_radii[body] = inner_radius(record.shape());
  const Vec3<Length> half = world_half_extents(record.shape(), rotations[body]);
  Bounds bounds;
  for (int i = 0; i < 3; ++i) {
    const Position reach = rounded<Position>(half[i]) + rounded<Position>(k_contact_margin / 2);
    const Position swept = travel(record.velocity[i], time_step);
    bounds.lower[i] = round_down(record.position[i] - reach + min(swept, Position{}));
    bounds.upper[i] = round_up(record.position[i] + reach + max(swept, Position{}));
  }
  broad_phase.set_bounds(body, bounds, record.moves());
}

StepReport World::Impl::step() {
  StepReport report;
  find_pairs(report);
  collide_pairs(report);
  prepare_contacts(report);
  run_substeps(report);
  store_impulses();
  move_bodies(report);
  refresh_moved();
  find_events();
  ++header.tick;
  return report;
}

void World::Impl::find_pairs(StepReport& report) {
  const auto accept = [this](std::uint32_t i, std::uint32_t j) {
    const BodyRecord& a = bodies[i];
    const BodyRecord& b = bodies[j];
    const bool can_push = a.is_dynamic() || b.is_dynamic();
    const bool senses = a.is_trigger() != b.is_trigger();
    return (can_push || senses) && !(a.is_trigger() && b.is_trigger()) &&
           should_collide(a.filter(), b.filter());
  };
  pairs = broad_phase.find_pairs(header.body_limit, accept);
  report.pairs = static_cast<std::uint32_t>(pairs.size());
  if (broad_phase.overflowed()) report.status = Status::capacity_exhausted;
}

// Both contact lists are sorted by pair, so that one pass carries records over.
void World::Impl::collide_pairs(StepReport& report) {
  new_contacts.clear();
  manifolds.clear();
  std::size_t old = 0;
  for (const Pair& pair : pairs) {
    const std::span<const ContactRecord> before = contacts();
    while (old < before.size() && Pair{before[old].body_a, before[old].body_b} < pair)
      ++old;
    const bool known = old < before.size() && Pair{before[old].body_a, before[old].body_b} == pair;
    ContactRecord record;
    if (known) record = before[old];
    Manifold manifold;
    if (!collide_pair(pair, record, manifold)) continue;
    if (new_contacts.size() == def.contact_capacity) {
      report.status = Status::capacity_exhausted;
      return;
    }
    new_contacts.push_back(record);
    manifolds.push_back(manifold);
  }
}

// Answers whether the pair touches or may do so within the tick. `record` keeps the impulses and
// the touching flag of the tick before.
bool World::Impl::collide_pair(const Pair& pair, ContactRecord& record, Manifold& manifold) const {
  const BodyRecord& a = bodies[pair.a];
  const BodyRecord& b = bodies[pair.b];
  const Shape shape_a = a.shape(), shape_b = b.shape();
  const PosedShape posed_a{shape_a, rotations[pair.a]};
  const PosedShape posed_b{shape_b, rotations[pair.b]};
  const Vec3<Length> offset = offset_between(a.position, b.position);
  record.body_a = pair.a;
  record.body_b = pair.b;
  if (a.is_trigger() || b.is_trigger()) {
    record.flags = static_cast<std::uint8_t>(record.flags | k_contact_trigger);
    return overlaps(posed_a, posed_b, offset);
  }
  const Length thickness = max(inner_radii[pair.a], inner_radii[pair.b]);
  const Length margin = speculative_distance(a, b, thickness, time_step);
  manifold = collide(posed_a, posed_b, offset, margin);
  return manifold.count > 0;
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
                         solver_bodies[b], manifolds[i], record},
                        softness, contact));
    report.contact_points += static_cast<std::uint32_t>(contact.count);
  }
  report.contacts = static_cast<std::uint32_t>(constraints.size());
}

void World::Impl::run_substeps(StepReport& report) {
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
  moved.clear();
  for (std::uint32_t body = 0; body < header.body_limit; ++body) {
    if (!bodies[body].moves()) continue;
    move_body(body, report);
    moved.push_back(body);
  }
}

// As `refresh` does for each, with the rotations all at once.
void World::Impl::refresh_moved() {
  if (moved.empty()) return;
  const lanes::QuatField orientations{&bodies.front().orientation, sizeof(BodyRecord)};
  lanes::compute_rotations(orientations, moved, rotations.data());
  for (const std::uint32_t body : moved)
    refresh_bounds(body);
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

void World::Impl::add_event(EventKind kind, const ContactRecord& record, std::size_t index) {
  const Velocity approach =
      kind == EventKind::contact_begin ? rounded<Velocity>(approach_speeds[index]) : Velocity{};
  events.push_back({kind,
                    {record.body_a, bodies[record.body_a].generation},
                    {record.body_b, bodies[record.body_b].generation},
                    approach});
}

// Merges the old and the new contacts, both sorted by pair, and makes the new ones the state.
void World::Impl::find_events() {
  events.clear();
  const std::span<ContactRecord> before = contacts();
  std::size_t i = 0, j = 0;
  while (i < before.size() || j < new_contacts.size()) {
    const auto key = [](const ContactRecord& r) { return Pair{r.body_a, r.body_b}; };
    const bool old_first =
        j == new_contacts.size() || (i < before.size() && key(before[i]) < key(new_contacts[j]));
    const bool both = !old_first && i < before.size() && key(before[i]) == key(new_contacts[j]);
    const ContactRecord& record = old_first ? before[i] : new_contacts[j];
    const bool was = (old_first || both) && (before[i].is_touching() || before[i].is_trigger());
    const bool is = !old_first && (record.is_touching() || record.is_trigger());
    if (record.is_trigger()) {
      add_event(!is   ? EventKind::trigger_exit
                : was ? EventKind::trigger_stay
                      : EventKind::trigger_enter,
                record, j);
    } else if (was != is) {
      add_event(is ? EventKind::contact_begin : EventKind::contact_end, record, j);
    }
    i += old_first || both ? 1 : 0;
    j += old_first ? 0 : 1;
  }
  std::copy(new_contacts.begin(), new_contacts.end(), contact_store.begin());
  header.contact_count = static_cast<std::uint32_t>(new_contacts.size());
}

}  // namespace lockstone
