// Read-only queries. Results do not depend on the shape of the trees: ties go to the lower index.

#include <algorithm>

#include "core/collision/broad_phase/segment_probe.h"
#include "core/collision/query/cast_placed.h"
#include "core/dynamics/state/limits.h"
#include "core/world/derived/quantities.h"
#include "core/world/query/sorted_results.h"
#include "core/world/query/world_queries.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// Whether the list lets a body pass. Apart from `is_seen`: few filters have one.
[[gnu::noinline]] bool passes_list(BodyHandle body, const QueryFilter& filter) {
  if (filter.bodies.size() > k_max_filter_bodies)
    misused("a query of World: the filter lists more than k_max_filter_bodies, 64, bodies");
  return (std::ranges::find(filter.bodies, body) != filter.bodies.end()) == filter.only_listed;
}

// The mask is the broad phase's to check.
bool is_seen(const BodyRecord& body, std::uint32_t index, const QueryFilter& filter) {
  const BodyHandle handle{index, body.generation};
  return handle != filter.ignore && (filter.triggers || !body.is_trigger()) &&
         ((body.tag ^ filter.tag) & filter.tag_mask) == 0 &&
         ((filter.bodies.empty() && !filter.only_listed) || passes_list(handle, filter)) &&
         (filter.accept == nullptr || filter.accept(filter.context, handle));
}

Bounds bounds_of(const WorldBox& box) {
  return {{round_down(box.lower.x), round_down(box.lower.y), round_down(box.lower.z)},
          {round_up(box.upper.x), round_up(box.upper.y), round_up(box.upper.z)}};
}

constexpr bool is_in_reach(const Vec3<Length>& translation) {
  return is_within(translation, k_max_cast);
}

// Of rays and shapes: by fraction, then by index.
template <class Hit>
bool is_nearer(const Hit& a, const Hit& b) {
  return a.fraction != b.fraction ? a.fraction < b.fraction : a.body.index < b.body.index;
}

// A ray on its way through a world: calls `found(hit)` for each body that it meets within the
// fraction that `limit` still allows.
template <class Found>
void walk_ray(const WorldData& world, const Ray& ray, const QueryFilter& filter, const Unit& limit,
              Found&& found) {
  if (!is_in_reach(ray.translation))
    misused("World::cast_ray…: the translation is above k_max_cast, 512 m, along an axis");
  SegmentProbe probe(ray.origin, ray.translation, {});
  const auto test = [&](const Bounds& bounds) { return probe.meets(bounds); };
  const auto visit = [&](std::uint32_t index) {
    const BodyRecord& body = world.bodies[index];
    if (!is_seen(body, index, filter)) return;
    const PlacedRayHit hit = cast_ray(world.placed(index), ray.origin, ray.translation, limit);
    if (!hit.hit) return;
    const Unit before = limit;
    found(RayHit{{index, body.generation},
                 hit.fraction,
                 hit.normal,
                 along(ray.origin, ray.translation, hit.fraction),
                 hit.part});
    if (limit != before) probe.shorten(limit);
  };
  world.broad_phase.traverse(filter.mask, test, visit);
}

// A convex shape to ask with. One that is not, or that names an unknown asset, is a programmer's
// error.
PlacedShape placed_query(const WorldData& world, const Shape& shape, const Transform& pose) {
  if (validate(shape) != Status::ok)
    misused("a query of World: a size of the shape is out of range; ask validate(shape) first");
  const geometry::AssetGeometry* asset =
      is_asset(shape.kind) ? geometry::geometry_of(world.assets->find(shape.asset)) : nullptr;
  const bool convex =
      is_primitive(shape.kind) || (asset != nullptr && asset->polytope() != nullptr);
  if (!convex)
    misused("a query of World: the shape must be a primitive, or a hull of World::assets()");
  return {shape, asset, pose.position, to_matrix(normalized(pose.orientation)), pose.position};
}

// The same for a convex shape on its way.
template <class Found>
void walk_shape(const WorldData& world, const ShapeCast& cast, const QueryFilter& filter,
                const Unit& limit, Found&& found) {
  if (!is_in_reach(cast.translation))
    misused("World::cast_shape…: the translation is above k_max_cast, 512 m, along an axis");
  const PlacedShape shape = placed_query(world, cast.shape, cast.start);
  const WorldBox box = world_box(shape);
  Vec3<Length> reach;
  for (int i = 0; i < 3; ++i) {
    const Position far = max(box.upper[i] - shape.origin[i], shape.origin[i] - box.lower[i]);
    reach[i] = saturated<Length>(far) + Length::from_raw(1);
  }
  SegmentProbe probe(shape.origin, cast.translation, reach);
  const auto test = [&](const Bounds& bounds) { return probe.meets(bounds); };
  const auto visit = [&](std::uint32_t index) {
    const BodyRecord& body = world.bodies[index];
    if (!is_seen(body, index, filter)) return;
    const PlacedShapeHit hit = cast_shape(world.placed(index), shape, cast.translation, limit);
    if (!hit.hit) return;
    const Unit before = limit;
    found(ShapeHit{{index, body.generation}, hit.fraction, hit.normal, hit.point, hit.part});
    if (limit != before) probe.shorten(limit);
  };
  world.broad_phase.traverse(filter.mask, test, visit);
}

// The deepest point of a manifold, the first of equals, seen from the body.
ShapeContact to_contact(const PlacedShape& probe, BodyHandle handle, const BodyRecord& body,
                        const PartContact& contact) {
  const Manifold& manifold = contact.manifold;
  const auto points = std::span(manifold.points).first(static_cast<std::size_t>(manifold.count));
  const ManifoldPoint& deepest = *std::ranges::min_element(points, {}, &ManifoldPoint::separation);
  Vec3<Position> point = place_at(probe.centre, deepest.anchor_a);
  for (int i = 0; i < 3; ++i) {
    const std::int64_t apart = (manifold.normal[i] * deepest.separation).raw;  // 54 fraction bits
    if (deepest.separation.raw > 0) point[i] += Position::from_raw(raw::round_shift(apart, 22));
  }
  const Surface surface = contact.surface_b != nullptr ? *contact.surface_b : body.surface();
  return {handle, -manifold.normal, deepest.separation, point, contact.part_b, surface};
}

constexpr Unit k_whole_way = Unit::from_integer(1);

}  // namespace

RayHit first_hit(const WorldData& world, const Ray& ray, const QueryFilter& filter) {
  RayHit best;
  Unit limit = k_whole_way;
  walk_ray(world, ray, filter, limit, [&](const RayHit& hit) {
    if (!best.body.is_null() && !is_nearer(hit, best)) return;
    best = hit;
    limit = hit.fraction;
  });
  return best;
}

RayHit World::cast_ray(const Vec3<Position>& origin, const Vec3<Length>& translation,
                       const QueryFilter& filter) const {
  return first_hit(*impl_, Ray{origin, translation}, filter);
}

bool World::is_ray_blocked(const Vec3<Position>& origin, const Vec3<Length>& translation,
                           const QueryFilter& filter) const {
  bool blocked = false;
  Unit limit = k_whole_way;
  walk_ray(*impl_, {origin, translation}, filter, limit, [&](const RayHit&) {
    blocked = true;
    limit = {};
  });
  return blocked;
}

std::size_t World::cast_ray_all(const Vec3<Position>& origin, const Vec3<Length>& translation,
                                std::span<RayHit> out, const QueryFilter& filter) const {
  std::size_t count = 0;
  const Unit limit = k_whole_way;
  walk_ray(*impl_, {origin, translation}, filter, limit,
           [&](const RayHit& hit) { insert_sorted(hit, out, count, is_nearer<RayHit>); });
  return count;
}

void World::cast_rays(std::span<const Ray> rays, std::span<RayHit> out,
                      const QueryFilter& filter) const {
  if (rays.size() != out.size()) misused("World::cast_rays: `out` must be as long as `rays`");
  for (std::size_t i = 0; i < rays.size(); ++i)
    out[i] = cast_ray(rays[i].origin, rays[i].translation, filter);
}

ShapeHit first_hit(const WorldData& world, const ShapeCast& cast, const QueryFilter& filter) {
  ShapeHit best;
  Unit limit = k_whole_way;
  walk_shape(world, cast, filter, limit, [&](const ShapeHit& hit) {
    if (!best.body.is_null() && !is_nearer(hit, best)) return;
    best = hit;
    limit = hit.fraction;
  });
  return best;
}

ShapeHit World::cast_shape(const ShapeCast& cast, const QueryFilter& filter) const {
  return first_hit(*impl_, cast, filter);
}

std::size_t World::cast_shape_all(const ShapeCast& cast, std::span<ShapeHit> out,
                                  const QueryFilter& filter) const {
  std::size_t count = 0;
  const Unit limit = k_whole_way;
  walk_shape(*impl_, cast, filter, limit,
             [&](const ShapeHit& hit) { insert_sorted(hit, out, count, is_nearer<ShapeHit>); });
  return count;
}

void World::cast_shapes(std::span<const ShapeCast> casts, std::span<ShapeHit> out,
                        const QueryFilter& filter) const {
  if (casts.size() != out.size()) misused("World::cast_shapes: `out` must be as long as `casts`");
  for (std::size_t i = 0; i < casts.size(); ++i)
    out[i] = cast_shape(casts[i], filter);
}

std::size_t bodies_in_box(const World& world, const Vec3<Position>& lower,
                          const Vec3<Position>& upper, std::span<BodyHandle> out,
                          const QueryFilter& filter) {
  for (int i = 0; i < 3; ++i) {
    if (lower[i] > upper[i] || lower[i] < -k_world_limit || upper[i] > k_world_limit)
      misused("bodies_in_box: `lower` must not be above `upper`, both within k_world_limit");
  }
  const WorldData& data = *world.impl_;
  const Bounds box = bounds_of({lower, upper});
  std::size_t count = 0;
  const auto test = [&](const Bounds& bounds) { return overlap(box, bounds); };
  const auto visit = [&](std::uint32_t index) {
    const BodyRecord& body = data.bodies[index];
    if (!is_seen(body, index, filter)) return;
    // The broad phase has room for the motion of a tick besides.
    const WorldBox tight = world_box(data.placed(index));
    for (int i = 0; i < 3; ++i) {
      if (tight.upper[i] < lower[i] || tight.lower[i] > upper[i]) return;
    }
    insert_sorted(BodyHandle{index, body.generation}, out, count, std::less<>());
  };
  data.broad_phase.traverse(filter.mask, test, visit);
  return count;
}

std::size_t World::overlap_shape(const Shape& shape, const Transform& pose,
                                 std::span<BodyHandle> out, const QueryFilter& filter) const {
  const WorldData& world = *impl_;
  const PlacedShape probe = placed_query(world, shape, pose);
  const Bounds reach = bounds_of(world_box(probe));
  std::size_t count = 0;
  const auto test = [&](const Bounds& bounds) { return overlap(reach, bounds); };
  const auto visit = [&](std::uint32_t index) {
    const BodyRecord& body = world.bodies[index];
    const BodyHandle handle{index, body.generation};
    if (count == out.size() && (out.empty() || handle > out.back())) return;
    if (!is_seen(body, index, filter) || !bodies_overlap(probe, world.placed(index))) return;
    insert_sorted(handle, out, count, std::less<>());
  };
  world.broad_phase.traverse(filter.mask, test, visit);
  return count;
}

std::size_t World::contacts_of_shape(const Shape& shape, const Transform& pose, Length margin,
                                     std::span<ShapeContact> out, const QueryFilter& filter) const {
  const WorldData& world = *impl_;
  const PlacedShape probe = placed_query(world, shape, pose);
  WorldBox box = world_box(probe);
  for (int i = 0; i < 3; ++i) {
    box.lower[i] -= rounded<Position>(margin);
    box.upper[i] += rounded<Position>(margin);
  }
  const Bounds reach = bounds_of(box);
  std::size_t count = 0;
  const auto before = [](const ShapeContact& a, const ShapeContact& b) {
    return std::pair(a.body.index, a.part) < std::pair(b.body.index, b.part);
  };
  PartContacts found;  // large: filled once
  const auto test = [&](const Bounds& bounds) { return overlap(reach, bounds); };
  const auto visit = [&](std::uint32_t index) {
    const BodyRecord& body = world.bodies[index];
    if (!is_seen(body, index, filter)) return;
    collide_bodies(probe, world.placed(index), margin, found);
    for (const PartContact& contact : found)
      insert_sorted(to_contact(probe, {index, body.generation}, body, contact), out, count, before);
  };
  world.broad_phase.traverse(filter.mask, test, visit);
  return count;
}

std::size_t World::overlap_sphere(const Vec3<Position>& center, Length radius,
                                  std::span<BodyHandle> out, const QueryFilter& filter) const {
  return overlap_shape(Shape::sphere(radius), {center, {}}, out, filter);
}

std::size_t World::bodies_at(const Vec3<Position>& point, std::span<BodyHandle> out,
                             const QueryFilter& filter) const {
  std::size_t count = 0;
  const Unit limit = k_whole_way;
  // A ray without length meets the bodies that it starts in, or on.
  const auto before = [](BodyHandle a, BodyHandle b) { return a < b; };
  walk_ray(*impl_, {point, {}}, filter, limit,
           [&](const RayHit& hit) { insert_sorted(hit.body, out, count, before); });
  return count;
}

ClosestHit World::closest_point(const Vec3<Position>& point, Length reach,
                                const QueryFilter& filter) const {
  if (reach < Length{} || reach > k_max_cast)
    misused("World::closest_point: `reach` must be 0 … k_max_cast, 512 m");
  const WorldData& world = *impl_;
  ClosestHit best;
  best.distance = reach;
  const auto around = [&](Length r) {
    const Position wide = rounded<Position>(r);
    const Vec3<Position> span{wide, wide, wide};
    return bounds_of({point - span, point + span});
  };
  Bounds region = around(reach);
  const auto test = [&](const Bounds& bounds) { return overlap(region, bounds); };
  const auto visit = [&](std::uint32_t index) {
    const BodyRecord& body = world.bodies[index];
    if (!is_seen(body, index, filter)) return;
    const PlacedClosest found = lockstone::closest_point(world.placed(index), point, best.distance);
    const bool nearer = found.found && (best.body.is_null() || found.distance < best.distance ||
                                        index < best.body.index);
    if (!nearer) return;
    best = {{index, body.generation}, found.distance, found.point, found.part};
    region = around(found.distance);
  };
  world.broad_phase.traverse(filter.mask, test, visit);
  if (best.body.is_null()) best.distance = {};
  return best;
}

}  // namespace lockstone
