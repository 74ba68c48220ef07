#include "core/world/phases/motion/body_mover.h"

#include <atomic>

#include "core/dynamics/body/damping.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/step/contact_solver.h"

namespace lockstone {

// Bounces run before all other bodies move, so that their obstacles are where the tick began.
void BodyMover::run(StepReport& report) {
  const StageTimer timer(world_.profiler, StepStage::move);
  moved_.list_awake(left_out_.still.bodies());
  report.moving_bodies = static_cast<std::uint32_t>(moved_.bodies().size());
  report.still_bodies = static_cast<std::uint32_t>(left_out_.still.bodies().size());
  left_out_.bounces.run();
  std::atomic<std::uint32_t> free_bodies{0}, axis_turns{0}, saturations{0};
  world_.parallel.for_each(
      moved_.pieces(), [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
        Counts counts;
        for (const std::uint32_t body : moved_.bodies().subspan(first, end - first)) {
          move(body, counts);
          continuous_.note_far_mover(body);
        }
        const auto add = [](std::atomic<std::uint32_t>& sum, std::uint32_t count) {
          if (count != 0) sum.fetch_add(count, std::memory_order_relaxed);
        };
        add(free_bodies, counts.free_bodies);
        add(axis_turns, counts.axis_turns);
        add(saturations, counts.saturations);
      });
  solver_.limit_bounces(world_.bodies, world_.def.speed_limit);
  report.free_bodies = free_bodies;
  report.axis_turns += axis_turns;
  report.saturations += saturations;
}

void BodyMover::move(std::uint32_t body, Counts& counts) {
  BodyRecord& record = world_.bodies[body];
  const Mat3& rotation = world_.cache.rotation(body);
  const bool bounced = left_out_.bounces.has_moved(body);
  if (!bounced) moved_.note_start(body);
  const SolverBody* solved = solver_.find(body);
  if (solved != nullptr) {
    counts.axis_turns += solver_.move(*solved, rotation, record);
    if (record.is_dynamic()) damp_velocity(record, world_.time_step);
  } else if (bounced) {
    damp_velocity(record, world_.time_step);
    ++counts.free_bodies;
  } else if (left_out_.pendulums.has(body)) {
    counts.axis_turns += left_out_.pendulums.run(body);
    damp_velocity(record, world_.time_step);
    ++counts.free_bodies;
  } else {
    counts.axis_turns +=
        fly(record, rotation, world_.header.gravity, world_.time_step, world_.header.tick);
    ++counts.free_bodies;
  }
  const IslandTally* island = solver_.island_of(body);
  record.loose_time =
      island == nullptr
          ? 0
          : EffortPolicy::loose_time(*island, record, world_.time_step, world_.header.tick);
  damp_spin(record, world_.time_step);
  apply_axis_locks(record);
  const InverseInertia inertia = inertia_of(body, solved);
  counts.saturations += limit_speed(record, inertia, world_.def.speed_limit) ? 1U : 0U;
  counts.saturations += limit_position(record) ? 1U : 0U;
  if (record.is_pushed()) end_pushes(record, rest_rules_);
  if (solved != nullptr)
    solver_.note_motion(body, record, left_out_.still.motion_since(moved_.start(body), record));
}

// The inverse inertia by which its spin is limited. A body without spin needs none.
InverseInertia BodyMover::inertia_of(std::uint32_t body, const SolverBody* solved) const {
  if (world_.bodies[body].spin == Vec3<Velocity>{}) return {};
  return solved != nullptr ? solved->inverse_inertia
                           : inverse_inertia(world_.bodies[body], world_.cache.rotation(body));
}

// Only in islands that iterations solve may a body move away from its recycling pose: the residual
// motion of converged contacts is finer.
void BodyMover::end() {
  world_.parallel.for_each(
      moved_.pieces(), [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
        for (const std::uint32_t body : moved_.bodies().subspan(first, end - first)) {
          BodyRecord& record = world_.bodies[body];
          const IslandTally* island = solver_.island_of(body);
          if (!ContactSolver::keeps_recycling_pose(island, record, world_.cache.inner_radius(body)))
            world_.cache.renew_recycling_pose(body, record);
          record.still_ticks = left_out_.still.count_of(island, record);
        }
      });
}

}  // namespace lockstone
