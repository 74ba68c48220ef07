// The tick.

#include "core/dynamics/step/contact_solver.h"
#include "core/world/phases/fluids.h"
#include "core/world/phases/pair_filter.h"
#include "core/world/phases/vehicle/vehicle_phase.h"
#include "core/world/world_impl.h"

namespace lockstone {

StepReport World::Impl::step(PairFilter* only) {
  StepReport report;
  trace.begin_step();
  moved.forget_looks();
  if (header.vehicle_count != 0) vehicle_phase->drive(*this);
  find_pairs(report, only);
  if (header.fluid_limit != 0) fluid_phase->push(*this);
  narrow.run(pairs, report);
  left_out.find();
  solve_contacts(report);
  mover.run(report);
  if (header.fluid_limit != 0) fluid_phase->end(*this);
  continuous.run(report);
  mover.end();
  refresh_moved();
  find_events();
  joint_registry.advance();
  joint_registry.mark_awake();
  joint_registry.break_overloaded();
  island_sleep.run(report);
  sleep_flags.add_events(events.list());
  profiler.count_step();
  ++header.tick;
  return report;
}

// Sleeping bodies that will be met wake first: then there are more pairs.
void World::Impl::find_pairs(StepReport& report, PairFilter* only) {
  const StageTimer timer(profiler, StepStage::find_pairs);
  do {
    waking.wake_joined();
    list_awake_joints();
    pairs = broad_phase.find_pairs(parallel);
    if (only != nullptr) pairs = only->take_pairs(pairs);
  } while (wake_met());
  report.pairs = static_cast<std::uint32_t>(pairs.size());
  if (broad_phase.overflowed()) report.status = Status::capacity_exhausted;
}

// Wakes the bodies that awake bodies are about to touch, and stirs still ones that kinematic bodies
// may run into. Returns whether any woke.
bool World::Impl::wake_met() {
  if (sleep_flags.asleep_count() == 0) {
    continuous.wake_struck();
    return false;
  }
  for (const Pair& pair : pairs) {
    const bool a_awake = awake.has(pair.a), b_awake = awake.has(pair.b);
    if (a_awake && b_awake) continue;
    const std::uint32_t sleeper = a_awake ? pair.b : pair.a;
    if (bodies[sleeper].is_dynamic() && narrow.meet(pair)) waking.list(sleeper);
  }
  continuous.wake_struck();
  return waking.wake_listed();
}

// The new records hold each contact's final impulses, and whether the surfaces met.
void World::Impl::solve_contacts(StepReport& report) {
  const std::span<const JointLink> links = left_out.pendulums.joints_to_solve();
  events.hits().begin();
  {
    const StageTimer timer(profiler, StepStage::prepare);
    solver->prepare({std::span(bodies).first(header.body_limit), cache.rotations(),
                     found.manifold_ids, found.manifolds, found.surfaces, found.records,
                     std::span(joints).first(header.joint_limit), links, assets.get(),
                     header.gravity, header.tick, events.hits().watched()},
                    parallel);
  }
  {
    const StageTimer timer(profiler, StepStage::solve);
    solver->run(parallel);
  }
  {
    const StageTimer timer(profiler, StepStage::store);
    solver->store(found.manifolds, found.records, found.approach_speeds, parallel);
    solver->store_joints(links, joints, parallel);
    events.hits().add_solved(solver->totals());
  }
  const SolverCounts counts = solver->counts();
  const Bounces& bounces = left_out.bounces;
  report.still_contacts = left_out.still.contacts();
  report.contacts = counts.contacts + static_cast<std::uint32_t>(bounces.contacts().size()) +
                    report.still_contacts;
  report.contact_points = counts.points + left_out.still.points();
  for (const BouncingContact& each : bounces.contacts())
    report.contact_points += static_cast<std::uint32_t>(found.manifold_of(each.contact).count);
  report.colors = counts.colors;
  report.overflow_contacts = counts.overflow_contacts;
  report.saturations += counts.saturations;
  report.energy_limits = counts.energy_limits;
}

// Still bodies do not move, but may lose a velocity or get one, and their bounds depend on it.
void World::Impl::refresh_moved() {
  const StageTimer timer(profiler, StepStage::refresh);
  moved.refresh();
  for (const std::uint32_t body : left_out.still.stopped())
    refresh_bounds(body);
  for (const std::uint32_t body : continuous.stops().still)
    if (left_out.still.has(body)) refresh_bounds(body);
}

// Makes the contacts of the tick those of the state; manifolds have other ids from then on.
void World::Impl::find_events() {
  const StageTimer timer(profiler, StepStage::events);
  events.hits().add_bounced(left_out.bounces.contacts(), left_out.bounces.totals());
  events.find();
  passes.add_events(events.list());
  const Stops& stops = continuous.stops();
  events.list().insert(events.list().end(), stops.impacts.begin(), stops.impacts.end());
  events.hits().finish(stops.hits);
}

}  // namespace lockstone
