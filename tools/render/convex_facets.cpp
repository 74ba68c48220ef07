#include "tools/render/convex_facets.h"

#include <cmath>
#include <vector>

#include "core/geometry/convex/polytope_box.h"
#include "core/geometry/convex/rounded_facets.h"
#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/cores/convex_core.h"
#include "core/math/roots.h"

namespace lockstone::render {

std::shared_ptr<const Hull> hull_within(const geometry::Polytope& polytope) {
  if (polytope.radius == Length{}) return nullptr;
  std::vector<Vec3<Length>> points;
  const geometry::RoundedFacets facets(polytope, geometry::FacetReach::surface);
  facets.for_each([&](std::span<const geometry::RawVec> corners) {
    for (const geometry::RawVec& corner : corners)
      points.push_back(geometry::to_length(corner));
  });
  const HullResult built = Hull::build(points, {.max_vertices = 128});
  return built.ok() ? built.hull : nullptr;
}

std::shared_ptr<const Hull> hull_within(const Shape& shape) {
  if (shape.kind <= ShapeKind::box || !is_primitive(shape.kind)) return nullptr;
  if (shape.kind == ShapeKind::rounded_box) {
    const geometry::BoxPolytope box(shape.size, shape.fourth_size());
    return hull_within(box.view());
  }
  const Mat3 still;
  geometry::ConvexCore core;
  geometry::make_core({shape, still}, core);
  const bool tapered = core.rims.count == 0;
  const int sides = tapered ? 16 : 24;
  const std::vector<double> rises = tapered
                                        ? std::vector<double>{-8, -2, -0.8, -0.3, 0.3, 0.8, 2, 8}
                                        : std::vector<double>{-4, -0.5, 0.5, 4};
  std::vector<Vec3<Length>> points;
  for (int i = 0; i < sides; ++i) {
    const double angle = 2 * M_PI * i / sides;
    for (const double rise : rises) {
      const auto lane = [](double x) { return static_cast<std::int64_t>(std::ldexp(x, 28)); };
      const geometry::RawVec direction{lane(std::cos(angle)), lane(rise), lane(std::sin(angle))};
      const Vec3<Unit> outward = direction_of(direction.x, direction.y, direction.z);
      const geometry::RawVec point =
          tapered ? geometry::farthest_point(core, outward)
                  : geometry::vertex_of(core, geometry::farthest_vertex(core, direction));
      points.push_back(geometry::to_length(point + geometry::along(outward, core.radius)));
    }
  }
  const HullResult built = Hull::build(points, {.max_vertices = 128});
  return built.ok() ? built.hull : nullptr;
}

}  // namespace lockstone::render
