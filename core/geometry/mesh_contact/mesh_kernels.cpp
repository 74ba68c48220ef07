#include "core/geometry/mesh_contact/mesh_kernels.h"

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/dispatch/polytope_kernels.h"
#include "core/geometry/mesh_contact/front_crossing_search.h"

namespace lockstone::geometry {
namespace {

class Collect final : public PartVisitor {
 public:
  Collect(const MeshContactFrame& frame, TriangleContacts& out)
      : PartVisitor(true), frame_(frame), out_(out) {}

  void visit(const Part& part) override {
    const PosedShape triangle{part.shape, frame_.rotation, part.polytope};
    out_.add(part, part.polytope->kernels->collide(triangle, frame_.shape, frame_.offset,
                                                   frame_.margin, {}));
  }

 private:
  const MeshContactFrame& frame_;
  TriangleContacts& out_;
};

void collide_triangles(const AssetGeometry& asset, const MeshContactFrame& frame,
                       const LocalBounds& region, TriangleContacts& scratch, MeshManifolds& out) {
  scratch.clear();
  Collect collect(frame, scratch);
  asset.visit_parts(region, collect);
  join_triangle_contacts(scratch, frame, out);
}

}  // namespace

const MeshKernels& mesh_kernels() {
  static constexpr MeshKernels k_kernels{collide_triangles, first_front_crossing};
  return k_kernels;
}

}  // namespace lockstone::geometry
