#include "core/geometry/shapes/shape_table.h"

namespace lockstone::geometry {
namespace {

/// By kind; null where a kind has no row.
constexpr std::array<const ShapeTraits*, 3> k_rows{&k_sphere, &k_capsule, &k_box};

}  // namespace

const ShapeTraits* find_traits(ShapeKind kind) {
  const auto row = static_cast<std::size_t>(kind);
  return row < k_rows.size() ? k_rows[row] : nullptr;
}

}  // namespace lockstone::geometry
