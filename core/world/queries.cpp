// Read-only queries. Results do not depend on the shape of the trees: ties go to the lower index.

#include <algorithm>

#include "core/geometry/manifold.h"
#include "core/geometry/raycast.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

bool is_seen(const BodyRecord& body, std::uint32_t index, const QueryFilter& filter) {
  const bool ignored = !filter.ignore.is_null() && filter.ignore.index == index &&
                       filter.ignore.generation == body.generation;
  return !ignored && (body.category & filter.mask) != 0 && (filter.triggers || !body.is_trigger());
}

Bounds bounds_of(const Vec3<Position>& a, const Vec3<Position>& b) {
  return {{round_down(min(a.x, b.x)), round_down(min(a.y, b.y)), round_down(min(a.z, b.z))},
          {round_up(max(a.x, b.x)), round_up(max(a.y, b.y)), round_up(max(a.z, b.z))}};
}

Vec3<Position> along(const Vec3<Position>& origin, const Vec3<Length>& translation, Unit part) {
  const auto go = [&](Position start, Length step) {
    return start + Position::from_raw(raw::round_shift((step * part).raw, 18));
  };
  return {go(origin.x, translation.x), go(origin.y, translation.y), go(origin.z, translation.z)};
}

Vec3<Position> widened(const Vec3<Length>& v) {
  return {rounded<Position>(v.x), rounded<Position>(v.y), rounded<Position>(v.z)};
}

constexpr Length k_ray_limit = Length::from_integer(512);

}  // namespace

RayHit World::cast_ray(const Vec3<Position>& origin, const Vec3<Length>& translation,
                       const QueryFilter& filter) const {
  LKS_CHECK(abs(translation.x) <= k_ray_limit && abs(translation.y) <= k_ray_limit &&
            abs(translation.z) <= k_ray_limit);
  const Impl& world = *impl_;
  const Bounds reach = bounds_of(origin, origin + widened(translation));
  RayHit best;
  best.fraction = Unit::max();
  const auto test = [&](const Bounds& bounds) { return overlap(reach, bounds); };
  const auto visit = [&](std::uint32_t index) {
    const BodyRecord& body = world.bodies[index];
    if (!is_seen(body, index, filter)) return;
    const ShapeRayHit hit =
        lockstone::cast_ray(body.shape(), world.rotations[index],
                            saturated<Length>(origin - body.position), translation);
    const bool nearer =
        hit.fraction < best.fraction || (hit.fraction == best.fraction && index < best.body.index);
    if (hit.hit && nearer) best = {{index, body.generation}, hit.fraction, hit.normal, {}};
  };
  world.broad_phase.traverse(test, visit);
  if (best.body.is_null()) return {};
  best.point = along(origin, translation, best.fraction);
  return best;
}

std::size_t World::overlap_sphere(const Vec3<Position>& center, Length radius,
                                  std::span<BodyHandle> out, const QueryFilter& filter) const {
  const Shape ball = Shape::sphere(radius);
  LKS_CHECK(validate(ball) == Status::ok);
  const Impl& world = *impl_;
  const Mat3 identity;
  const Vec3<Position> r = widened({radius, radius, radius});
  const Bounds reach = bounds_of(center - r, center + r);
  std::size_t count = 0;
  const auto test = [&](const Bounds& bounds) { return overlap(reach, bounds); };
  const auto visit = [&](std::uint32_t index) {
    const BodyRecord& body = world.bodies[index];
    if (!is_seen(body, index, filter) || out.empty()) return;
    if (count == out.size() && index > out.back().index) return;
    const Shape shape = body.shape();
    if (!overlaps({shape, world.rotations[index]}, {ball, identity},
                  saturated<Length>(center - body.position))) {
      return;
    }
    // Keeps the lowest indices, sorted, whatever the order of visits.
    const std::size_t last = count < out.size() ? count++ : count - 1;
    out[last] = {index, body.generation};
    for (std::size_t i = last; i > 0 && out[i] < out[i - 1]; --i)
      std::swap(out[i], out[i - 1]);
  };
  world.broad_phase.traverse(test, visit);
  return count;
}

}  // namespace lockstone
