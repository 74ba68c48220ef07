#include "core/world/phases/motion/fronts.h"

#include "core/collision/continuous/face_clamp.h"
#include "core/dynamics/body/motion.h"
#include "core/dynamics/state/one_way_bits.h"

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
FrontPush find_front(const WorldData& world, std::uint32_t body, const Vec3<Position>& start) {
  const BodyRecord& record = world.bodies[body];
  const geometry::AssetGeometry* asset = world.cache.asset(body);
  const Bounds way = bounds_of_way(start, record.position, bounding_radius(record.shape(), asset));
  FrontPush first;
  std::uint32_t body_of_first = 0;
  const auto look_at = [&](std::uint32_t other) {
    const geometry::AssetGeometry* mesh = world.cache.asset(other);
    if (mesh == nullptr || mesh->mesh_kernels() == nullptr || !world.is_obstacle(body, other) ||
        is_one_way(world.bodies[other]))
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

void clamp_to_fronts(WorldData& world, std::uint32_t body, const Vec3<Position>& start) {
  BodyRecord& record = world.bodies[body];
  if (!record.is_dynamic() || record.is_trigger()) return;
  for (int i = 1; i <= k_most_fronts; ++i) {
    const FrontPush front = find_front(world, body, start);
    if (!front.found) return;
    record.position += i < k_most_fronts ? front.by : front.back;
    (void)limit_position(record);
  }
}

}  // namespace

void clamp_to_fronts(WorldData& world, const MovedBodies& moved) {
  world.parallel.for_each(
      moved.pieces(), [&](std::uint32_t first, std::uint32_t end, std::uint32_t) {
        for (const std::uint32_t body : moved.bodies().subspan(first, end - first)) {
          if (world.cache.inner_radius(body) <= k_thin_radius)
            clamp_to_fronts(world, body, moved.start(body).position);
        }
      });
}

}  // namespace lockstone
