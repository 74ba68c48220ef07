#include <lockstone/shape.h>

#include "core/geometry/convex/shape_traits.h"

namespace lockstone {
namespace {

constexpr bool is_size(Length x) {
  return x >= k_min_shape_size && x <= k_max_shape_size;
}

}  // namespace

Status validate(const Shape& shape) {
  if (is_asset(shape.kind) == shape.asset.is_null()) return Status::invalid_argument;
  const geometry::ShapeTraits* traits = geometry::find_traits(shape.kind);
  if (traits == nullptr && is_primitive(shape.kind)) return Status::invalid_argument;
  const int used = traits == nullptr ? 0 : traits->size_count;
  for (int i = 0; i < 3; ++i) {
    const bool good = i < used ? is_size(shape.size[i]) : shape.size[i] == Length{};
    if (!good) return Status::invalid_argument;
  }
  return Status::ok;
}

}  // namespace lockstone
