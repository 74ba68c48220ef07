#include <lockstone/shape.h>

namespace lockstone {
namespace {

constexpr bool is_size(Length x) {
  return x >= k_min_shape_size && x <= k_max_shape_size;
}

}  // namespace

Status validate(const Shape& shape) {
  const auto& [x, y, z] = shape.size;
  constexpr Length none{};
  bool good = false;
  switch (shape.kind) {
    case ShapeKind::sphere:
      good = is_size(x) && y == none && z == none;
      break;
    case ShapeKind::capsule:
      good = is_size(x) && is_size(y) && z == none;
      break;
    case ShapeKind::box:
      good = is_size(x) && is_size(y) && is_size(z);
      break;
    case ShapeKind::half_space:
    case ShapeKind::hull:
    case ShapeKind::mesh:
    case ShapeKind::height_field:
    case ShapeKind::compound:
      good = shape.size == Vec3<Length>{};
      break;
  }
  if (is_asset(shape.kind) == shape.asset.is_null()) return Status::invalid_argument;
  return good ? Status::ok : Status::invalid_argument;
}

}  // namespace lockstone
