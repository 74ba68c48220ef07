// The tick.

#include <algorithm>
#include <atomic>

#include "core/dynamics/body/motion.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/kernels/rotations/rotations.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

constexpr std::uint32_t k_body_grain = 32;

// How far a body goes in one tick, along one axis.
Position travel(Velocity v, const TimeStep& step) {
  return Position::from_raw(step.tick.times(v.raw));
}

}  // namespace

void World::Impl::refresh(std::uint32_t body) {
  cache.refresh(body, bodies[body]);
  refresh_bounds(body);
}

void World::Impl::refresh_bounds(std::uint32_t body) {
  const BodyRecord& record = bodies[body];
  cache.refresh_shape(body, record);
  if (triggers.has(body) != record.is_trigger()) triggers.flip(body);
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
  continuous.run(report);
  follow_with_contacts();
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
    wake_joined();
    find_active_joints();
    pairs = broad_phase.find_pairs(parallel);
  } while (wake_met());
  report.pairs = static_cast<std::uint32_t>(pairs.size());
  if (broad_phase.overflowed()) report.status = Status::capacity_exhausted;
}

void World::Impl::solve_contacts(StepReport& report) {
  bounces.find();
  pendulums.find();
  prepare_contacts();
  run_substeps();
  store_impulses();
  report.contacts = solver.contacts();
  report.contact_points = solver.points();
  report.contacts += static_cast<std::uint32_t>(bounces.contacts().size());
  for (const BouncingContact& each : bounces.contacts()) {
    const Manifold& manifold = manifolds[slots[each.contact]];
    report.contact_points += static_cast<std::uint32_t>(manifold.count);
  }
  report.colors = solver.colors();
  report.overflow_contacts = solver.overflow();
  report.saturations += solver.saturations();
  report.energy_limits = solver.energy_limits();
}

void World::Impl::prepare_contacts() {
  const StageTimer timer(profiler, StepStage::prepare);
  solver.prepare({std::span(bodies).first(header.body_limit), cache.rotations(), slots, manifolds,
                  surfaces, new_contacts, std::span(joints).first(header.joint_limit),
                  pendulums.joints_to_solve(), header.gravity, header.tick},
                 parallel);
}

void World::Impl::run_substeps() {
  const StageTimer timer(profiler, StepStage::solve);
  solver.run(parallel);
}

// The new records: each contact's final impulses, and whether the surfaces met.
void World::Impl::store_impulses() {
  const StageTimer timer(profiler, StepStage::store);
  solver.store(manifolds, new_contacts, approach_speeds, parallel);
  solver.store_joints(pendulums.joints_to_solve(), joints, parallel);
}

// Joints of awake bodies may have changed.
void World::Impl::mark_joints() {
  for (const JointLink& joint : joint_graph.awake_links())
    joint_hashes.mark(joint.joint);
}

void World::Impl::move_bodies(StepReport& report) {
  const StageTimer timer(profiler, StepStage::move);
  const std::span<const std::uint32_t> all = awake.list();
  moved.assign(all.begin(), all.end());
  for (const std::uint32_t body : all)
    body_hashes.mark(body);
  report.moving_bodies = static_cast<std::uint32_t>(moved.size());
  bounces.run();
  std::atomic<std::uint32_t> free_bodies{0}, axis_turns{0}, saturations{0};
  parallel.for_each(each_moved(), [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
    MoveCounts counts;
    for (std::uint32_t i = first; i < end; ++i) {
      move_body(moved[i], counts);
      continuous.note_far_mover(moved[i]);
    }
    const auto add = [](std::atomic<std::uint32_t>& sum, std::uint32_t count) {
      if (count != 0) sum.fetch_add(count, std::memory_order_relaxed);
    };
    add(free_bodies, counts.free_bodies);
    add(axis_turns, counts.axis_turns);
    add(saturations, counts.saturations);
  });
  solver.limit_bounces(bodies, def.speed_limit);
  report.free_bodies = free_bodies;
  report.axis_turns += axis_turns;
  report.saturations += saturations;
}

Loop World::Impl::each_moved() const {
  return {static_cast<std::uint32_t>(moved.size()), k_body_grain};
}

// A body that left its contact pose takes another. Only in islands that iterations solve may a body
// drift from its pose: the residual motion of converged contacts is finer.
void World::Impl::follow_with_contacts() {
  parallel.for_each(each_moved(), [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
    for (std::uint32_t i = first; i < end; ++i)
      if (!solver.keeps_contact_pose(moved[i], bodies[moved[i]]))
        cache.take_contact_pose(moved[i], bodies[moved[i]]);
  });
}

// As `refresh` does for each, with the rotations all at once. Only a body that leaves its fat box
// changes more of the broad phase than its own bounds.
void World::Impl::refresh_moved() {
  const StageTimer timer(profiler, StepStage::refresh);
  std::atomic<bool> changed{false};
  parallel.for_each(each_moved(), [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
    const lanes::QuatField orientations{&bodies.front().orientation, sizeof(BodyRecord)};
    lanes::compute_rotations(orientations, std::span(moved).subspan(first, end - first),
                             cache.rotations_out());
    bool any = false;
    for (std::uint32_t i = first; i < end; ++i) {
      cache.refresh_turned(moved[i], bodies[moved[i]]);
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

// The inverse inertia by which its spin is limited. A body without spin needs none.
InverseInertia World::Impl::inertia_of(std::uint32_t body, const SolverBody* solved) const {
  if (bodies[body].spin == Vec3<Velocity>{}) return {};
  return solved != nullptr ? solved->inverse_inertia
                           : inverse_inertia(bodies[body], cache.rotation(body));
}

void World::Impl::move_body(std::uint32_t body, MoveCounts& counts) {
  BodyRecord& record = bodies[body];
  const bool bounced = bounces.has_moved(body);
  if (!bounced) starts[body] = {record.position, record.orientation};
  const SolverBody* solved = solver.find(body);
  if (solved != nullptr) {
    counts.axis_turns += solver.move(*solved, cache.rotation(body), record);
    if (record.is_dynamic()) damp_velocity(record, time_step);
  } else if (bounced) {
    damp_velocity(record, time_step);
    ++counts.free_bodies;
  } else if (pendulums.has(body)) {
    counts.axis_turns += pendulums.run(body);
    damp_velocity(record, time_step);
    ++counts.free_bodies;
  } else {
    counts.axis_turns += fly(record, cache.rotation(body), header.gravity, time_step, header.tick);
    ++counts.free_bodies;
  }
  damp_spin(record, time_step);
  hold_axes(record);
  counts.saturations += limit_speed(record, inertia_of(body, solved), def.speed_limit) ? 1U : 0U;
  counts.saturations += limit_position(record) ? 1U : 0U;
  if (record.is_pushed()) end_pushes(record, rest_rules);
}

}  // namespace lockstone
