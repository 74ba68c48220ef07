// Fast kinematic bodies, and fast triggers, sweep over others in a tick. Each dynamic body near
// such a way is followed, however slowly it moves itself; a sleeping one that will be hit wakes
// before the tick.

#include <algorithm>

#include "core/collision/continuous/first_impact.h"
#include "core/dynamics/body/motion.h"
#include "core/world/world_impl.h"

namespace lockstone {

// Of awake bodies, which have moved in this tick: the mark of another may be old.
bool World::Impl::is_sweeper(std::uint32_t body) const {
  return (far_movers[body] & k_sweeper) != 0 && bodies[body].is_awake();
}

Bounds World::Impl::bounds_on_way(std::uint32_t body, const Sweep& motion) const {
  const Vec3<Position>& from = motion.start.position;
  return bounds_of_way(from, from + motion.translation,
                       bounding_radius(bodies[body].shape(), cache.asset(body)));
}

// After everything moved. The broad phase still knows bodies where the tick began, so that
// sweepers are looked for in the list and not there.
void World::Impl::list_sweepers() {
  sweepers.clear();
  for (const std::uint32_t body : moved)
    if ((far_movers[body] & k_sweeper) != 0)
      sweepers.push_back({body, bounds_on_way(body, motion_in_tick(body))});
  for (const Sweeper& each : sweepers) {
    if (bodies[each.body].is_trigger()) continue;
    broad_phase.traverse(
        k_every_category, [&](const Bounds& bounds) { return overlap(each.way, bounds); },
        [&](std::uint32_t other) {
          const BodyRecord& record = bodies[other];
          if (record.is_dynamic() && record.is_awake() && !record.is_trigger())
            far_movers[other] |= k_swept_over;
        });
  }
}

// Lists the sleepers that kinematic bodies will run into in the coming tick. How those move is
// known before it.
void World::Impl::wake_struck() {
  struck.clear();
  for (const std::uint32_t body : awake.list()) {
    const BodyRecord& record = bodies[body];
    if (!record.is_dynamic() && !record.is_trigger()) find_struck(body);
  }
  for (const std::uint32_t body : struck)
    list_to_wake(body);
}

void World::Impl::find_struck(std::uint32_t sweeper) {
  BodyRecord end = bodies[sweeper];
  const Transform start{end.position, end.orientation};
  (void)fly(end, cache.rotation(sweeper), header.gravity, time_step, header.tick);
  if (!goes_far(sweeper, start, end)) return;
  const Sweep motion{
      start, end.position - start.position,
      turn_since(start.orientation, cache.rotation(sweeper), end, time_step, k_whole_tick)};
  const Bounds way = bounds_on_way(sweeper, motion);
  const Shape shape = end.shape();
  broad_phase.traverse(
      k_every_category, [&](const Bounds& bounds) { return overlap(way, bounds); },
      [&](std::uint32_t other) {
        const BodyRecord& record = bodies[other];
        const bool sleeps = record.is_dynamic() && record.is_asleep() && !record.is_trigger();
        if (!sleeps || !is_obstacle(other, sweeper) || struck.size() == def.body_capacity) return;
        const Shape shape_of_other = record.shape();
        const Sweep still{{record.position, record.orientation}, {}, {}};
        const bool hit = first_impact({shape_of_other, cache.asset(other), still},
                                      {shape, cache.asset(sweeper), motion})
                             .hit;
        if (hit) struck.push_back(other);
      });
}

// Whether a body that has had all its impacts is taken along, or the other would leave it behind.
bool World::Impl::carries(std::uint32_t body) const {
  return is_sweeper(body) && !bodies[body].is_dynamic();
}

// Moves bodies that joints connect as far as the sweeper takes the centre of the one that it hit.
// Nothing moves if a joint holds one of them to a body that nothing pushes.
void World::Impl::carry_joined(std::uint32_t body, const Sweep& by) {
  for (const std::uint32_t each : joined_movers)
    for (const std::uint32_t other : joint_graph.neighbours(each))
      if (!bodies[other].is_dynamic()) return;
  const BodyRecord& hit = bodies[body];
  const Vec3<Position> way = carried({hit.position, hit.orientation}, by).position - hit.position;
  for (const std::uint32_t each : joined_movers) {
    bodies[each].position += way;
    (void)limit_position(bodies[each]);
  }
}

}  // namespace lockstone
