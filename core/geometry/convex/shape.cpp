#include <algorithm>

#include <lockstone/shape.h>

#include "core/geometry/convex/shape_traits.h"

namespace lockstone {
namespace {

constexpr bool is_size(Length x, Length least) {
  return x >= least && x <= k_max_shape_size;
}

}  // namespace

Status validate(const Shape& shape) {
  if (!has_fourth_size(shape.kind) && is_asset(shape.kind) == shape.asset.is_null())
    return Status::invalid_argument;
  const geometry::ShapeTraits* traits = geometry::find_traits(shape.kind);
  if (traits == nullptr && is_primitive(shape.kind)) return Status::invalid_argument;
  const int used = traits == nullptr ? 0 : std::min(traits->size_count, 3);
  for (int i = 0; i < 3; ++i) {
    const Length size = shape.size[i];
    const bool good = i < used ? is_size(size, least_size(shape)) : size == Length{};
    if (!good) return Status::invalid_argument;
  }
  if (!has_fourth_size(shape.kind)) return Status::ok;
  const Length most = k_max_shape_size - max(max(shape.size.x, shape.size.y), shape.size.z);
  const Length fourth = shape.fourth_size();
  if (!is_size(fourth, k_min_shape_size) || fourth > most) return Status::invalid_argument;
  return Status::ok;
}

}  // namespace lockstone
