// Keeps the centre of a thin body on the front side of one-sided triangles, so that they still meet
// it.

#include "core/collision/continuous/face_clamp.h"
#include "core/dynamics/body/motion.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// Fronts that a body is held by one after the other: a corner has three.
constexpr int k_most_fronts = 4;

PlacedShape moved_by(PlacedShape placed, const Vec3<Position>& way) {
  placed.origin += way;
  placed.centre += way;
  return placed;
}

// The first front that the body has passed on its way from `start`. Rotations are still those of
// the tick's beginning.
FrontPush find_front(const World::Impl& world, std::uint32_t body, const Vec3<Position>& start) {
  const BodyRecord& record = world.bodies[body];
  const Asset* asset = world.cache.asset(body);
  const Bounds way = bounds_of_way(start, record.position, bounding_radius(record.shape(), asset));
  FrontPush first;
  std::uint32_t body_of_first = 0;
  const auto look_at = [&](std::uint32_t other) {
    const Asset* mesh = world.cache.asset(other);
    if (mesh == nullptr || mesh->mesh_kernels() == nullptr || !world.is_obstacle(body, other))
      return;
    const PlacedWay gone{
        moved_by(world.placed(body), start - record.position),
        place(record.shape(), asset, record.position, to_matrix(record.orientation))};
    const FrontPush found = find_front_push(gone, world.placed(other));
    const bool sooner =
        found.found && (!first.found || found.fraction < first.fraction ||
                        (found.fraction == first.fraction && other < body_of_first));
    if (!sooner) return;
    first = found;
    body_of_first = other;
  };
  world.broad_phase.traverse_immovable([&](const Bounds& bounds) { return overlap(way, bounds); },
                                       look_at);
  return first;
}

}  // namespace

void World::Impl::hold_before_fronts() {
  if (narrow.scratch(0).triangles == nullptr) return;
  parallel.for_each(each_moved(), [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
    for (std::uint32_t i = first; i < end; ++i) {
      if (cache.inner_radius(moved[i]) <= k_thin_radius) hold_before_fronts(moved[i]);
    }
  });
}

void World::Impl::hold_before_fronts(std::uint32_t body) {
  BodyRecord& record = bodies[body];
  if (!record.is_dynamic() || record.is_trigger()) return;
  for (int i = 1; i <= k_most_fronts; ++i) {
    const FrontPush front = find_front(*this, body, starts[body].position);
    if (!front.found) return;
    record.position += i < k_most_fronts ? front.by : front.back;
    (void)limit_position(record);
  }
}

}  // namespace lockstone
