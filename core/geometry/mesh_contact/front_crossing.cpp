#include "core/geometry/mesh_contact/front_crossing.h"

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/mesh_contact/face_plane.h"
#include "core/geometry/mesh_contact/front_crossing_search.h"
#include "core/geometry/numeric/ray_ratio.h"

namespace lockstone::geometry {
namespace {

constexpr Unit k_whole_way = Unit::from_integer(1);

// A crossing this far beside a triangle still counts.
constexpr Length k_beside = Length::from_raw(64);

class CrossingSearch final : public PartVisitor {
 public:
  explicit CrossingSearch(const PointWay& way) : from_(fine(way.from)), to_(fine(way.to)) {}

  void visit(const Part& part) override {
    const auto& v = part.polytope->vertices;
    const TriangleVertices triangle{v[0], v[1], v[2]};
    const Vec3<Unit>& normal = part.polytope->faces.front().normal;
    const FacePlane plane(triangle, normal);
    const Fine above = plane.height(from_), end = plane.height(to_);
    if (above < 0 || end >= fine(k_front_margin)) return;
    const Unit fraction = end < 0 ? rounded(RayRatio{above, above - end}) : k_whole_way;
    if (best_.found && fraction >= best_.fraction) return;
    if (!plane.has_beside(from_ + part_of_way(fraction))) return;
    best_ = {true, fraction, part.index, normal, end};
  }

  [[nodiscard]] const FrontCrossing& best() const { return best_; }

 private:
  [[nodiscard]] RawVec part_of_way(Unit fraction) const {
    const RawVec way = to_ - from_;
    return {scaled(way.x, fraction.raw), scaled(way.y, fraction.raw), scaled(way.z, fraction.raw)};
  }

  const RawVec from_;
  const RawVec to_;
  FrontCrossing best_;
};

}  // namespace

FrontCrossing first_front_crossing(const AssetGeometry& asset, const PointWay& way) {
  LocalBounds region;
  for (int i = 0; i < 3; ++i) {
    region.lower[i] = min(way.from[i], way.to[i]) - k_beside;
    region.upper[i] = max(way.from[i], way.to[i]) + k_beside;
  }
  CrossingSearch search(way);
  asset.visit_parts(region, search);
  return search.best();
}

}  // namespace lockstone::geometry
