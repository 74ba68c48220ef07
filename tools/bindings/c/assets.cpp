// Sets of assets.
#include <memory>

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

}  // namespace

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
    if (count > k_max_path_points) throw invalid("count", "must be at most 4096");
    const lks_path_point* raw = array(points, count, "points");
    std::vector<PathPoint> list(count);
    for (std::size_t i = 0; i < count; ++i)
      list[i] = {vec<Length>(raw[i].position), vec<Unit>(raw[i].up)};
    const PathResult result = Path::build(list, flag(closed, "closed"));
    if (!result.ok()) throw invalid("points", to_string(result.fault));
    assets->list.push_back(result.path);
    *out = result.path->id().value;
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
