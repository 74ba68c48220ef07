#include "tools/render/convex_facets.h"

#include <cmath>
#include <vector>

#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/cores/convex_core.h"
#include "core/math/roots.h"

namespace lockstone::render {

std::shared_ptr<const Hull> hull_within(const Shape& shape) {
  constexpr int k_sides = 24;
  if (shape.kind <= ShapeKind::box || !is_primitive(shape.kind)) return nullptr;
  const Mat3 still;
  geometry::ConvexCore core;
  geometry::make_core({shape, still}, core);
  std::vector<Vec3<Length>> points;
  for (int i = 0; i < k_sides; ++i) {
    const double angle = 2 * M_PI * i / k_sides;
    for (const double rise : {-4.0, -0.5, 0.5, 4.0}) {
      const auto lane = [](double x) { return static_cast<std::int64_t>(std::ldexp(x, 28)); };
      const geometry::RawVec direction{lane(std::cos(angle)), lane(rise), lane(std::sin(angle))};
      const int vertex = geometry::farthest_vertex(core, direction);
      const Vec3<Unit> outward = direction_of(direction.x, direction.y, direction.z);
      points.push_back(geometry::to_length(geometry::vertex_of(core, vertex) +
                                           geometry::along(outward, core.radius)));
    }
  }
  const HullResult built = Hull::build(points, {.max_vertices = 128});
  return built.ok() ? built.hull : nullptr;
}

}  // namespace lockstone::render
