// Triggers that something passes within a tick. Overlaps are found where a tick begins; a pair that
// overlaps neither there nor at the tick's end, but does in between, enters and exits in that tick.
// Nothing of it is remembered.

#include <algorithm>

#include "core/collision/continuous/first_impact.h"
#include "core/collision/continuous/relative_path.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

Sweep first_part(const Sweep& motion, Unit fraction) {
  Sweep first = motion;
  for (int i = 0; i < 3; ++i) {
    first.translation[i].raw = geometry::part(motion.translation[i].raw, fraction);
    first.rotation[i].raw = geometry::part(motion.rotation[i].raw, fraction);
  }
  return first;
}

}  // namespace

bool World::Impl::senses(std::uint32_t body, std::uint32_t other) const {
  const BodyRecord &a = bodies[body], &b = bodies[other];
  return a.is_trigger() != b.is_trigger() && should_collide(a.filter(), b.filter()) &&
         !are_joined(body, other);
}

// Notes each pair that touches while the body goes a fraction of its motion, which begins at `done`
// of the tick.
void World::Impl::note_passes(std::uint32_t body, const Sweep& motion, Unit done, Unit fraction) {
  if (triggers.count() == 0) return;
  const Sweep first = first_part(motion, fraction);
  const Bounds way = bounds_on_way(body, first);
  const auto look_at = [&](std::uint32_t other) {
    if (other == body || !senses(body, other)) return;
    note_pass({body, other}, first, first_part(motion_of(other, done), fraction));
  };
  // Each pair of movers once: a body that is followed looks for the sweepers itself.
  const bool sweeps = is_sweeper(body);
  const auto looks_itself = [&](std::uint32_t other) {
    return bodies[other].is_awake() &&
           (far_movers[other] & (sweeps ? k_far_mover | k_swept_over | k_sweeper : k_sweeper)) != 0;
  };
  broad_phase.traverse(
      k_every_category, [&](const Bounds& bounds) { return overlap(way, bounds); },
      [&](std::uint32_t other) {
        if (!looks_itself(other)) look_at(other);
      });
  for (const Sweeper& each : sweepers)
    if ((!sweeps || body < each.body) && overlap(way, each.way)) look_at(each.body);
}

// A body that moves past the other by less than half its own thickness is seen where ticks begin.
void World::Impl::note_pass(const Pair& pair, const Sweep& a, const Sweep& b) {
  const auto is_short = [&](std::uint32_t body, const Sweep& motion, const Sweep& other) {
    const Length radius = bounding_radius(bodies[body].shape(), cache.asset(body));
    const Length inner = cache.inner_radius(body);
    return relative_way(motion, other, radius > inner ? radius : Length{}) <=
           rounded<Position>(inner / 2);
  };
  if (is_short(pair.a, a, b)) return;
  const Pair key = pair_of(pair.a, pair.b);
  const auto bodies_of = [](const ContactRecord& record) {
    return Pair{record.body_a, record.body_b};
  };
  if (std::ranges::binary_search(new_contacts, key, {}, bodies_of)) return;
  const Shape shape_a = bodies[pair.a].shape(), shape_b = bodies[pair.b].shape();
  if (!touch_on_way({shape_a, cache.asset(pair.a), a}, {shape_b, cache.asset(pair.b), b})) return;
  if (passes.size() < def.body_capacity)
    passes.push_back(key);
  else
    passes_overflowed = true;
}

// An entry and an exit for each pair that is apart again, in the order of the pairs.
void World::Impl::add_passes() {
  std::ranges::sort(passes);
  passes.erase(std::unique(passes.begin(), passes.end()), passes.end());
  std::erase_if(passes,
                [&](const Pair& pair) { return bodies_overlap(placed(pair.a), placed(pair.b)); });
  std::size_t from = events.size();
  std::size_t to = from + 2 * passes.size();
  events.resize(to);
  for (std::size_t i = passes.size(); i-- > 0;) {
    const Pair& pair = passes[i];
    while (from > 0 && pair < Pair{events[from - 1].a.index, events[from - 1].b.index})
      events[--to] = events[--from];
    for (const EventKind kind : {EventKind::trigger_exit, EventKind::trigger_enter})
      events[--to] = {kind, handle_of(pair.a),  handle_of(pair.b),
                      {},   bodies[pair.a].tag, bodies[pair.b].tag};
  }
}

}  // namespace lockstone
