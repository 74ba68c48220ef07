// Queries. Arguments that the core would assert on are checked here and refused.
#include <array>
#include <vector>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

// Before it had tags and a list of bodies.
template <>
inline constexpr std::size_t lockstone::c::k_first_size<lks_query_filter> = 24;

namespace {

using namespace lockstone;
using namespace lockstone::c;

lks_query_filter default_filter() {
  lks_query_filter filter{};
  filter.size = sizeof(lks_query_filter);
  filter.mask = 0xffffffff;
  return filter;
}

// A filter with its list.
struct ListedFilter {
  QueryFilter filter;
  std::array<BodyHandle, LKS_FILTER_BODIES> listed;

  [[gnu::noinline]] explicit ListedFilter(const lks_query_filter* from) {
    const lks_query_filter raw =
        from == nullptr ? default_filter() : take(from, default_filter(), "filter");
    if (raw.reserved != 0) throw_invalid("filter.reserved", "must be 0");
    if (raw.listed_count > LKS_FILTER_BODIES)
      throw_invalid("filter.listed_count", "must be 0 … 16");
    for (std::size_t i = 0; i < raw.listed_count; ++i)
      listed[i] = handle_of<BodyHandle>(raw.listed[i]);
    filter.mask = raw.mask;
    filter.ignore = handle_of<BodyHandle>(raw.ignore);
    filter.triggers = flag(raw.triggers, "filter.triggers");
    filter.tag_mask = raw.tag_mask;
    filter.tag = raw.tag;
    filter.bodies = std::span(listed).first(raw.listed_count);
    filter.only_listed = flag(raw.only_listed, "filter.only_listed");
  }
  ListedFilter(const ListedFilter&) = delete;  // the filter refers to the list
  ListedFilter& operator=(const ListedFilter&) = delete;

  operator const QueryFilter&() const { return filter; }  // NOLINT(google-explicit-constructor)
};

Vec3<Length> way_of(const lks_length3* way) {
  const auto result = vec<Length>(required(way, "way"));
  for (int i = 0; i < 3; ++i) {
    if (result[i] > k_max_cast || result[i] < -k_max_cast)
      throw_invalid("way", "must be within ±512 m along each axis");
  }
  return result;
}

Ray ray_of(const lks_position3* origin, const lks_length3* way) {
  return {place_of(origin, "origin"), way_of(way)};
}

// A convex shape whose hull the world knows.
Shape query_shape(const World& world, const lks_shape* raw) {
  const Shape shape = shape_of(required(raw, "shape"), "shape.kind");
  if (validate(shape) != Status::ok) throw_invalid("shape", "a size is out of range");
  if (is_primitive(shape.kind)) return shape;
  if (shape.kind != ShapeKind::hull)
    throw_invalid("shape.kind", "must be sphere, capsule, box or hull");
  const Asset* asset = world.assets()->find(shape.asset);
  if (asset == nullptr) throw_status(LKS_NOT_FOUND, "shape.asset: the world has no such asset");
  if (asset->kind() != ShapeKind::hull) throw_invalid("shape.asset", "is no hull");
  return shape;
}

Transform pose_of(const lks_pose* raw) {
  const lks_pose& pose = required(raw, "pose");
  return {place_of(&pose.position, "pose.position"), quat_of(pose.orientation)};
}

template <class Hit>
lks_hit hit_of(const Hit& hit) {
  return {id_of(hit.body), hit.fraction.raw, raw_of(hit.normal), raw_of(hit.point), hit.part, 0};
}

// Calls ask(room) for as many results as there can be, and gives them converted.
template <class Found, class Raw, class Ask, class Convert>
void give_all(const World& world, Raw* out, std::size_t capacity, std::size_t* count, Ask&& ask,
              Convert&& convert) {
  required(count, "count");
  array(out, capacity, "out");
  std::vector<Found> room(std::min<std::size_t>(capacity, world.body_limit()));
  const std::size_t found = ask(std::span(room));
  for (std::size_t i = 0; i < found; ++i)
    out[i] = convert(room[i]);
  *count = found;
}

}  // namespace

lks_status lks_query_filter_init(lks_query_filter* filter, size_t size) {
  return call([&] { give(default_filter(), filter, size, "filter"); });
}

lks_status lks_cast_ray(const lks_world* world, const lks_position3* origin, const lks_length3* way,
                        const lks_query_filter* filter, lks_hit* out) {
  return call([&] {
    const World& source = read(world);
    const Ray ray = ray_of(origin, way);
    required(out, "out") =
        hit_of(source.cast_ray(ray.origin, ray.translation, ListedFilter(filter)));
  });
}

lks_status lks_cast_ray_all(const lks_world* world, const lks_position3* origin,
                            const lks_length3* way, const lks_query_filter* filter, lks_hit* out,
                            size_t capacity, size_t* count) {
  return call([&] {
    const World& source = read(world);
    const Ray ray = ray_of(origin, way);
    const ListedFilter seen(filter);
    give_all<RayHit>(
        source, out, capacity, count,
        [&](auto room) { return source.cast_ray_all(ray.origin, ray.translation, room, seen); },
        hit_of<RayHit>);
  });
}

lks_status lks_is_ray_blocked(const lks_world* world, const lks_position3* origin,
                              const lks_length3* way, const lks_query_filter* filter,
                              uint32_t* out) {
  return call([&] {
    const World& source = read(world);
    const Ray ray = ray_of(origin, way);
    required(out, "out") = source.is_ray_blocked(ray.origin, ray.translation, ListedFilter(filter));
  });
}

lks_status lks_cast_shape(const lks_world* world, const lks_shape* shape, const lks_pose* start,
                          const lks_length3* way, const lks_query_filter* filter, lks_hit* out) {
  return call([&] {
    const World& source = read(world);
    const ShapeCast cast{query_shape(source, shape), pose_of(start), way_of(way)};
    required(out, "out") = hit_of(source.cast_shape(cast, ListedFilter(filter)));
  });
}

lks_status lks_overlap_sphere(const lks_world* world, const lks_position3* centre,
                              lks_length radius, const lks_query_filter* filter, lks_body* out,
                              size_t capacity, size_t* count) {
  const lks_shape sphere = lks_sphere(radius);
  if (centre == nullptr) return remember(LKS_NULL_ARGUMENT, "centre is null");
  const lks_pose pose{*centre, lks_quat_identity()};
  return lks_overlap_shape(world, &sphere, &pose, filter, out, capacity, count);
}

lks_status lks_overlap_shape(const lks_world* world, const lks_shape* shape, const lks_pose* pose,
                             const lks_query_filter* filter, lks_body* out, size_t capacity,
                             size_t* count) {
  return call([&] {
    const World& source = read(world);
    const Shape probe = query_shape(source, shape);
    const Transform place = pose_of(pose);
    const ListedFilter seen(filter);
    give_all<BodyHandle>(
        source, out, capacity, count,
        [&](auto room) { return source.overlap_shape(probe, place, room, seen); },
        id_of<BodyHandle>);
  });
}

lks_status lks_bodies_in_box(const lks_world* world, const lks_position3* lower,
                             const lks_position3* upper, const lks_query_filter* filter,
                             lks_body* out, size_t capacity, size_t* count) {
  return call([&] {
    const World& source = read(world);
    const Vec3<Position> low = place_of(lower, "lower"), high = place_of(upper, "upper");
    for (int i = 0; i < 3; ++i) {
      if (low[i] > high[i]) throw_invalid("lower", "must not be above `upper`");
    }
    const ListedFilter seen(filter);
    give_all<BodyHandle>(
        source, out, capacity, count,
        [&](auto room) { return bodies_in_box(source, low, high, room, seen); }, id_of<BodyHandle>);
  });
}

lks_status lks_closest_point(const lks_world* world, const lks_position3* point, lks_length reach,
                             const lks_query_filter* filter, lks_closest* out) {
  return call([&] {
    const World& source = read(world);
    const Vec3<Position> place = place_of(point, "point");
    if (reach < 0 || reach > k_max_cast.raw) throw_invalid("reach", "must be 0 … 512 m");
    const ClosestHit hit =
        source.closest_point(place, Length::from_raw(reach), ListedFilter(filter));
    required(out, "out") = {id_of(hit.body), raw_of(hit.point), hit.distance.raw, hit.part};
  });
}
