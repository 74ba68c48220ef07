// Which cells of a height field a region or a ray meets.
#include "core/geometry/assets/height_field_walk.h"

namespace lockstone {

void HeightField::visit_parts(const geometry::LocalBounds& region,
                              geometry::PartVisitor& visitor) const {
  geometry::visit_cells(*data_, region, visitor);
}

void HeightField::visit_parts_on_way(const Vec3<Length>& origin, const Vec3<Length>& translation,
                                     const Vec3<Length>& reach,
                                     geometry::WayPartVisitor& visitor) const {
  geometry::visit_cells_on_way(*data_, origin, translation, reach, visitor);
}

void HeightField::visit_parts_near(const Vec3<Length>& point, Length reach,
                                   geometry::NearPartVisitor& visitor) const {
  geometry::visit_cells_near(*data_, point, reach, visitor);
}

}  // namespace lockstone
