// Which cells of a height field a region or a ray meets.
#include "core/geometry/assets/height_editing.h"
#include "core/geometry/assets/height_field_geometry.h"
#include "core/geometry/assets/height_field_walk.h"
#include "core/geometry/mesh_contact/mesh_kernels.h"

namespace lockstone::geometry {

const MeshKernels* HeightFieldGeometry::mesh_kernels() const {
  return &geometry::mesh_kernels();
}

const HeightEditing* HeightFieldGeometry::height_editing() const {
  return &geometry::height_editing();
}

void HeightFieldGeometry::visit_parts(const LocalBounds& region, PartVisitor& visitor) const {
  visit_cells(data_, region, visitor);
}

void HeightFieldGeometry::visit_parts_on_way(const Vec3<Length>& origin,
                                             const Vec3<Length>& translation,
                                             const Vec3<Length>& reach,
                                             WayPartVisitor& visitor) const {
  visit_cells_on_way(data_, origin, translation, reach, visitor);
}

void HeightFieldGeometry::visit_parts_near(const Vec3<Length>& point, Length reach,
                                           NearPartVisitor& visitor) const {
  visit_cells_near(data_, point, reach, visitor);
}

}  // namespace lockstone::geometry
