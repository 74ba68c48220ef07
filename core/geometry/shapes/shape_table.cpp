#include "core/geometry/shapes/shape_table.h"

namespace lockstone {
namespace {

constexpr std::size_t k_shape_kinds = static_cast<std::size_t>(k_last_shape_kind) + 1;

#define LKS_NAME(kind, name) , name
constexpr std::array<std::string_view, k_shape_kinds> k_shape_names{
    "sphere",     "capsule", "box",          "hull",
    "half-space", "mesh",    "height field", "compound" LKS_LATER_SHAPES(LKS_NAME)};
#undef LKS_NAME

/// By kind; null of kinds without a row, and of those that the program does not link.
#define LKS_ROW(kind, name) , &geometry::k_##kind
const std::array<const geometry::ShapeTraits*, k_shape_kinds> k_rows{
    &geometry::k_sphere,
    &geometry::k_capsule,
    &geometry::k_box,
    nullptr,
    nullptr,
    nullptr,
    nullptr,
    nullptr LKS_LATER_SHAPES(LKS_ROW)};
#undef LKS_ROW

}  // namespace

std::string_view to_string(ShapeKind kind) {
  const auto row = static_cast<std::size_t>(kind);
  return row < k_shape_kinds ? k_shape_names[row] : "unknown";
}

namespace geometry {

const ShapeTraits* find_traits(ShapeKind kind) {
  const auto row = static_cast<std::size_t>(kind);
  return row < k_shape_kinds ? k_rows[row] : nullptr;
}

}  // namespace geometry
}  // namespace lockstone
