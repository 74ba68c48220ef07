// Sets of assets.
#include <algorithm>
#include <memory>
#include <optional>

#include <lockstone/compound.h>
#include <lockstone/fit.h>
#include <lockstone/hull.h>
#include <lockstone/load_asset.h>
#include <lockstone/path.h>
#include <lockstone/scaled_asset.h>
#include <lockstone/shape_pair.h>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

std::vector<Vec3<Length>> points_of(const lks_length3* points, std::size_t count) {
  if (count > k_max_hull_points) throw_invalid("count", "must be at most 65536");
  array(points, count, "points");
  std::vector<Vec3<Length>> result;
  result.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    result.push_back(vec<Length>(points[i]));
  return result;
}

std::vector<PathPoint> path_points(const lks_path_point* points, size_t count) {
  if (count > k_max_path_points) throw_invalid("count", "must be at most 4096");
  const lks_path_point* raw = array(points, count, "points");
  std::vector<PathPoint> list(count);
  for (std::size_t i = 0; i < count; ++i)
    list[i] = {vec<Length>(raw[i].position), vec<Unit>(raw[i].up)};
  return list;
}

void add_path(lks_assets& assets, std::span<const PathPoint> points, std::span<const Angle> banks,
              bool closed, uint64_t& name) {
  const PathResult result = Path::build(points, banks, closed);
  if (!result.ok()) throw_invalid("points", to_string(result.fault));
  assets.list.push_back(result.path);
  name = result.path->id().value;
}

// A place that is for the function to check.
Transform unchecked_pose(const lks_pose& pose) {
  return {vec<Position>(pose.position), quat_of(pose.orientation)};
}

const Asset& asset_of(const lks_assets& assets, AssetId id) {
  const auto found =
      std::ranges::find(assets.list, id, [](const AssetPtr& one) { return one->id(); });
  if (found == assets.list.end()) throw_status(LKS_NOT_FOUND, "the set has no such asset");
  return **found;
}

// A shape with its asset of the set, if it names one.
ShapeAt shape_at(const lks_assets* assets, const lks_placed_shape* raw, std::string_view field) {
  const lks_placed_shape& from = required(raw, field);
  ShapeAt at{shape_of(from.shape, field), unchecked_pose(from.pose), nullptr};
  if (!is_asset(at.shape.kind)) return at;
  if (assets == nullptr) throw_status(LKS_NOT_FOUND, "the set has no such asset");
  at.asset = &asset_of(*assets, at.shape.asset);
  return at;
}

AssetPtr scaled_copy(const Asset& asset, const Vec3<Number>& factors) {
  const auto of = [](const auto& copy, const auto& result) -> AssetPtr {
    if (!result.ok()) throw_invalid("factors", to_string(result.fault));
    return copy;
  };
  if (asset.kind() == ShapeKind::hull) {
    const HullResult copy = scaled(static_cast<const Hull&>(asset), factors);
    return of(copy.hull, copy);
  }
  if (asset.kind() == ShapeKind::mesh) {
    const MeshResult copy = scaled(static_cast<const Mesh&>(asset), factors);
    return of(copy.mesh, copy);
  }
  if (asset.kind() == ShapeKind::height_field) {
    const HeightFieldResult copy = scaled(static_cast<const HeightField&>(asset), factors);
    return of(copy.height_field, copy);
  }
  throw_invalid("asset", "is no hull, mesh or height field");
}

template <class Found>
const Found& found_in(const Result<Found>& result) {
  if (!result) throw_invalid("shapes", "a size, a place, a length or the pair is out of range");
  return result.value();
}

lks_shape_hit hit_of(const ShapeImpact& hit) {
  return {raw_of(hit.point_a), hit.fraction.raw,  raw_of(hit.normal),       hit.part_a,
          hit.part_b,          hit.hit ? 1u : 0u, hit.overlapping ? 1u : 0u};
}

}  // namespace

lks_status lks_shape_distance(const lks_assets* assets, const lks_placed_shape* a,
                              const lks_placed_shape* b, lks_length reach, lks_shape_gap* out) {
  return call([&] {
    required(out, "out");
    const Result<ShapeDistance> result =
        shape_distance(shape_at(assets, a, "a"), shape_at(assets, b, "b"), Length::from_raw(reach));
    const ShapeDistance& found = found_in(result);
    *out = {found.distance.raw,
            raw_of(found.point_a),
            raw_of(found.point_b),
            raw_of(found.normal),
            found.part_a,
            found.part_b,
            found.found ? 1u : 0u,
            found.overlapping ? 1u : 0u,
            0};
  });
}

lks_status lks_shape_cast(const lks_assets* assets, const lks_placed_shape* a,
                          const lks_placed_shape* b, const lks_length3* way, lks_shape_hit* out) {
  return call([&] {
    required(out, "out");
    const Result<ShapeImpact> result = shape_cast(
        shape_at(assets, a, "a"), shape_at(assets, b, "b"), vec<Length>(required(way, "way")));
    *out = hit_of(found_in(result));
  });
}

lks_status lks_shape_impact(const lks_assets* assets, const lks_placed_shape* a,
                            const lks_pose* end_a, const lks_placed_shape* b, const lks_pose* end_b,
                            lks_length gap, lks_shape_hit* out) {
  return call([&] {
    required(out, "out");
    const Result<ShapeImpact> result =
        shape_impact({shape_at(assets, a, "a"), unchecked_pose(required(end_a, "end_a"))},
                     {shape_at(assets, b, "b"), unchecked_pose(required(end_b, "end_b"))},
                     Length::from_raw(gap));
    *out = hit_of(found_in(result));
  });
}

lks_status lks_fit(uint32_t kind, const lks_length3* points, size_t count, lks_shape* shape,
                   lks_pose* pose) {
  return call([&] {
    required(shape, "shape");
    required(pose, "pose");
    const std::vector<Vec3<Length>> list = points_of(points, count);
    Result<FittedShape> fitted = Status::invalid_argument;
    if (kind == LKS_SPHERE) fitted = fit_sphere(list);
    if (kind == LKS_BOX) fitted = fit_box(list);
    if (kind == LKS_CAPSULE) fitted = fit_capsule(list);
    if (!fitted) throw_invalid("points", "need a sphere, box or capsule of at most 512 m");
    *shape = raw_of(fitted.value().shape);
    *pose =
        raw_of(Transform{rounded<Position>(fitted.value().position), fitted.value().orientation});
  });
}

lks_status lks_assets_create(lks_assets** out) {
  return call([&] {
    required(out, "out");
    *out = std::make_unique<lks_assets>().release();
  });
}

void lks_assets_destroy(lks_assets* assets) {
  delete assets;
}

lks_status lks_assets_add_hull(lks_assets* assets, const lks_length3* points, size_t count,
                               int32_t max_vertices, uint64_t* out) {
  return lks_assets_add_rounded_hull(assets, points, count, max_vertices, 0, out);
}

lks_status lks_assets_add_rounded_hull(lks_assets* assets, const lks_length3* points, size_t count,
                                       int32_t max_vertices, lks_length radius, uint64_t* out) {
  return call([&] {
    required(assets, "assets");
    required(out, "out");
    const HullOptions options = HullOptions::rounded(Length::from_raw(radius), max_vertices);
    HullResult result = Hull::build(points_of(points, count), options);
    if (!result.ok()) throw_invalid("points", to_string(result.fault));
    assets->list.push_back(result.hull);
    *out = result.hull->id().value;
  });
}

lks_status lks_assets_add_path(lks_assets* assets, const lks_path_point* points, size_t count,
                               uint32_t closed, uint64_t* out) {
  return call([&] {
    required(assets, "assets");
    required(out, "out");
    add_path(*assets, path_points(points, count), {}, flag(closed, "closed"), *out);
  });
}

lks_status lks_assets_add_banked_path(lks_assets* assets, const lks_path_point* points,
                                      const lks_angle* banks, size_t count, uint32_t closed,
                                      uint64_t* out) {
  return call([&] {
    required(assets, "assets");
    required(out, "out");
    const std::vector<PathPoint> list = path_points(points, count);
    const lks_angle* raw = array(banks, count, "banks");
    std::vector<Angle> angles(count);
    for (std::size_t i = 0; i < count; ++i)
      angles[i] = Angle::from_raw(raw[i]);
    add_path(*assets, list, angles, flag(closed, "closed"), *out);
  });
}

lks_status lks_assets_add_bytes(lks_assets* assets, const void* bytes, size_t count,
                                uint64_t* out) {
  return call([&] {
    required(assets, "assets");
    required(out, "out");
    const auto* data = static_cast<const std::byte*>(array(bytes, count, "bytes"));
    AssetPtr asset = value_of(load_asset({data, count}, AssetSet(assets->list)));
    *out = asset->id().value;
    assets->list.push_back(std::move(asset));
  });
}

lks_status lks_assets_find_part(const lks_assets* assets, uint64_t compound, uint32_t part,
                                uint32_t* child, uint32_t* triangle) {
  return call([&] {
    required(child, "child");
    required(triangle, "triangle");
    const Asset& asset = asset_of(required(assets, "assets"), AssetId{compound});
    if (asset.kind() != ShapeKind::compound)
      throw_status(LKS_NOT_FOUND, "the asset is no compound");
    const std::optional<CompoundPart> found = static_cast<const Compound&>(asset).find_part(part);
    if (!found) throw_status(LKS_NOT_FOUND, "the compound has no such part");
    *child = found->child;
    *triangle = found->triangle;
  });
}

lks_status lks_assets_add_scaled(lks_assets* assets, uint64_t asset, const lks_number3* factors,
                                 uint64_t* out) {
  return call([&] {
    lks_assets& set = required(assets, "assets");
    required(out, "out");
    const auto by = vec<Number>(required(factors, "factors"));
    AssetPtr copy = scaled_copy(asset_of(set, AssetId{asset}), by);
    *out = copy->id().value;
    set.list.push_back(std::move(copy));
  });
}
