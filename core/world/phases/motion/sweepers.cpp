// Fast kinematic bodies, and fast triggers, sweep over others in a tick. Each dynamic body near
// such a way is followed, however slowly it moves itself; a sleeping one that will be hit wakes
// before the tick.

#include <algorithm>

#include <lockstone/assert.h>

#include "core/collision/continuous/first_impact.h"
#include "core/dynamics/body/motion.h"
#include "core/world/phases/motion/continuous.h"

namespace lockstone {

// Of awake bodies, which have moved in this tick: the mark of another may be old.
bool ContinuousCollision::is_sweeper(std::uint32_t body) const {
  return (far_movers_[body] & k_sweeper) != 0 && world_.bodies[body].is_awake();
}

Bounds ContinuousCollision::bounds_on_way(std::uint32_t body, const Sweep& motion) const {
  const Vec3<Position>& from = motion.start.position;
  return bounds_of_way(from, from + motion.translation,
                       bounding_radius(world_.bodies[body].shape(), world_.cache.asset(body)));
}

// After everything moved. The broad phase still knows bodies where the tick began, so that
// sweepers are looked for in the list and not there.
void ContinuousCollision::list_sweepers() {
  sweepers_.clear();
  for (const std::uint32_t body : moved_.bodies()) {
    if ((far_movers_[body] & k_sweeper) == 0) continue;
    const Sweep motion = motion_in_tick(body);
    sweepers_.push_back({body, motion.rotation, bounds_on_way(body, motion)});
  }
  LKS_ASSERT(std::ranges::is_sorted(sweepers_, {}, &Sweeper::body));
  for (const Sweeper& each : sweepers_) {
    moved_.note_look(each.body, each.body);
    if (world_.bodies[each.body].is_trigger()) continue;
    world_.broad_phase.traverse(
        k_every_category, [&](const Bounds& bounds) { return overlap(each.way, bounds); },
        [&](std::uint32_t other) {
          const BodyRecord& record = world_.bodies[other];
          if (!record.is_dynamic() || !record.is_awake() || record.is_trigger()) return;
          moved_.note_look(each.body, other);
          far_movers_[other] |= k_swept_over;
        });
  }
}

// Lists the sleepers that kinematic bodies will run into in the coming tick, and stirs the still
// bodies near their ways and those of triggers. How those move is known before it.
void ContinuousCollision::wake_struck() {
  struck_.clear();
  for (const std::uint32_t body : world_.awake.list()) {
    const BodyRecord& record = world_.bodies[body];
    if (has_motion(record) && (!record.is_dynamic() || record.is_trigger())) find_struck(body);
  }
  for (const std::uint32_t body : struck_)
    waking_.list(body);
}

void ContinuousCollision::find_struck(std::uint32_t sweeper) {
  BodyRecord end = world_.bodies[sweeper];
  const Transform start{end.position, end.orientation};
  (void)fly(end, world_.cache.rotation(sweeper), world_.header.gravity, world_.time_step,
            world_.header.tick);
  if (!goes_far(sweeper, start, end)) return;
  const Sweep motion{start, end.position - start.position,
                     turn_since(start.orientation, world_.cache.rotation(sweeper), end,
                                world_.time_step, k_whole_tick)};
  const Bounds way = bounds_on_way(sweeper, motion);
  const Shape shape = end.shape();
  if (!end.is_trigger()) moved_.note_look(sweeper, sweeper);
  world_.broad_phase.traverse(
      k_every_category, [&](const Bounds& bounds) { return overlap(way, bounds); },
      [&](std::uint32_t other) {
        waking_.stir(other);
        const BodyRecord& record = world_.bodies[other];
        const bool sleeps = record.is_dynamic() && record.is_asleep() && !record.is_trigger();
        if (end.is_trigger() || !sleeps || !world_.is_obstacle(other, sweeper) ||
            struck_.size() == world_.def.body_capacity)
          return;
        moved_.note_look(sweeper, other);
        const Shape shape_of_other = record.shape();
        const Sweep still{{record.position, record.orientation}, {}, {}};
        const bool hit = first_impact({shape_of_other, world_.cache.asset(other), still},
                                      {shape, world_.cache.asset(sweeper), motion})
                             .hit;
        if (hit) struck_.push_back(other);
      });
}

// Whether a body that has had all its impacts is taken along, or the other would leave it behind.
bool ContinuousCollision::carries(std::uint32_t body) const {
  return is_sweeper(body) && !world_.bodies[body].is_dynamic();
}

// Moves bodies that joints connect as far as the sweeper takes the centre of the one that it hit.
// Nothing moves if a joint holds one of them to a body that nothing pushes.
void ContinuousCollision::carry_joined(std::uint32_t body, const Sweep& by) {
  for (const std::uint32_t each : joined_movers_)
    for (const std::uint32_t other : world_.joint_graph.neighbours(each))
      if (!world_.bodies[other].is_dynamic()) return;
  const BodyRecord& hit = world_.bodies[body];
  const Vec3<Position> way = carried({hit.position, hit.orientation}, by).position - hit.position;
  for (const std::uint32_t each : joined_movers_) {
    world_.bodies[each].position += way;
    (void)limit_position(world_.bodies[each]);
  }
}

}  // namespace lockstone
