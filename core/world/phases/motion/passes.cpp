// Triggers that something passes within a tick. Overlaps are found where a tick begins; a pair that
// overlaps neither there nor at the tick's end, but does in between, enters and exits in that tick.
// Nothing of it is remembered.

#include "core/world/phases/motion/passes.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/collision/continuous/first_impact.h"
#include "core/collision/continuous/relative_path.h"
#include "core/world/phases/motion/continuous.h"

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

TriggerPasses::TriggerPasses(WorldData& world, const TickContacts& found,
                             const ContinuousCollision& continuous, MovedBodies& moved)
    : world_(world), found_(found), continuous_(continuous), moved_(moved) {
  passes_.reserve(std::size_t{2} * world.def.body_capacity);
}

void TriggerPasses::begin() {
  passes_.clear();
  overflowed_ = false;
}

bool TriggerPasses::senses(std::uint32_t body, std::uint32_t other) const {
  const BodyRecord &a = world_.bodies[body], &b = world_.bodies[other];
  return a.is_trigger() != b.is_trigger() && should_collide(a.filter(), b.filter()) &&
         !world_.are_exempt(body, other);
}

// Notes each pair that touches while the body goes a fraction of its motion, which begins at `done`
// of the tick.
void TriggerPasses::note(std::uint32_t body, const Sweep& motion, Unit done, Unit fraction) {
  if (world_.triggers.count() == 0) return;
  const Sweep first = first_part(motion, fraction);
  const Bounds way = continuous_.bounds_on_way(body, first);
  moved_.note_look(body, body);
  const auto look_at = [&](std::uint32_t other) {
    if (other == body || !senses(body, other)) return;
    moved_.note_look(body, other);
    note_pair({body, other}, first, first_part(continuous_.motion_of(other, done), fraction));
  };
  // Each pair of movers once: a body that is followed looks for the sweepers itself.
  const bool sweeps = continuous_.is_sweeper(body);
  const auto looks_itself = [&](std::uint32_t other) {
    return world_.bodies[other].is_awake() &&
           (continuous_.marks(other) &
            (sweeps ? k_far_mover | k_swept_over | k_sweeper : k_sweeper)) != 0;
  };
  world_.broad_phase.traverse(
      k_every_category, [&](const Bounds& bounds) { return overlap(way, bounds); },
      [&](std::uint32_t other) {
        if (!looks_itself(other)) look_at(other);
      });
  for (const Sweeper& each : continuous_.sweepers())
    if ((!sweeps || body < each.body) && overlap(way, each.way)) look_at(each.body);
}

// A body that moves past the other by less than half its own thickness is seen where ticks begin.
void TriggerPasses::note_pair(const Pair& pair, const Sweep& a, const Sweep& b) {
  const auto is_short = [&](std::uint32_t body, const Sweep& motion, const Sweep& other) {
    const Length radius = bounding_radius(world_.bodies[body].shape(), world_.cache.asset(body));
    const Length inner = world_.cache.inner_radius(body);
    return relative_way(motion, other, radius > inner ? radius : Length{}) <=
           rounded<Position>(inner / 2);
  };
  if (is_short(pair.a, a, b)) return;
  const Pair key = world_.pair_of(pair.a, pair.b);
  const auto bodies_of = [](const ContactRecord& record) {
    return Pair{record.body_a, record.body_b};
  };
  if (std::ranges::binary_search(found_.records, key, {}, bodies_of)) return;
  const Shape shape_a = world_.bodies[pair.a].shape(), shape_b = world_.bodies[pair.b].shape();
  if (!touch_on_way({shape_a, world_.cache.asset(pair.a), a},
                    {shape_b, world_.cache.asset(pair.b), b}))
    return;
  if (passes_.size() == std::size_t{2} * world_.def.body_capacity) finish();
  passes_.push_back(key);
}

// The first pairs of all are kept, whatever the order in which the tree's shape lets them be found.
void TriggerPasses::finish() {
  std::ranges::sort(passes_);
  passes_.erase(std::unique(passes_.begin(), passes_.end()), passes_.end());
  if (passes_.size() <= world_.def.body_capacity) return;
  passes_.resize(world_.def.body_capacity);
  overflowed_ = true;
}

// An entry and an exit for each pair that is apart again, in the order of the pairs.
void TriggerPasses::add_events(std::vector<ContactEvent>& events) {
  LKS_ASSERT(std::ranges::is_sorted(passes_));
  std::erase_if(passes_, [&](const Pair& pair) {
    return bodies_overlap(world_.placed(pair.a), world_.placed(pair.b));
  });
  std::size_t from = events.size();
  std::size_t to = from + 2 * passes_.size();
  events.resize(to);
  for (std::size_t i = passes_.size(); i-- > 0;) {
    const Pair& pair = passes_[i];
    while (from > 0 && pair < Pair{events[from - 1].a.index, events[from - 1].b.index})
      events[--to] = events[--from];
    for (const EventKind kind : {EventKind::trigger_exit, EventKind::trigger_enter})
      events[--to] = {kind, world_.handle_of(pair.a),  world_.handle_of(pair.b),
                      {},   world_.bodies[pair.a].tag, world_.bodies[pair.b].tag};
  }
}

}  // namespace lockstone
