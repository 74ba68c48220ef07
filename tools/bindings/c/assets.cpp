// Sets of assets.
#include <memory>

#include <lockstone/fit.h>
#include <lockstone/hull.h>
#include <lockstone/load_asset.h>
#include <lockstone/path.h>

#include "tools/bindings/c/convert.h"
#include "tools/bindings/c/handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

std::vector<Vec3<Length>> points_of(const lks_length3* points, std::size_t count) {
  if (count > k_max_hull_points) throw invalid("count", "must be at most 65536");
  array(points, count, "points");
  std::vector<Vec3<Length>> result;
  result.reserve(count);
  for (std::size_t i = 0; i < count; ++i)
    result.push_back(vec<Length>(points[i]));
  return result;
}

std::vector<PathPoint> path_points(const lks_path_point* points, size_t count) {
  if (count > k_max_path_points) throw invalid("count", "must be at most 4096");
  const lks_path_point* raw = array(points, count, "points");
  std::vector<PathPoint> list(count);
  for (std::size_t i = 0; i < count; ++i)
    list[i] = {vec<Length>(raw[i].position), vec<Unit>(raw[i].up)};
  return list;
}

void add_path(lks_assets& assets, std::span<const PathPoint> points, std::span<const Angle> banks,
              bool closed, uint64_t& name) {
  const PathResult result = Path::build(points, banks, closed);
  if (!result.ok()) throw invalid("points", to_string(result.fault));
  assets.list.push_back(result.path);
  name = result.path->id().value;
}

}  // namespace

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
    if (!fitted) throw invalid("points", "need a sphere, box or capsule of at most 512 m");
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
    if (!result.ok()) throw invalid("points", to_string(result.fault));
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
