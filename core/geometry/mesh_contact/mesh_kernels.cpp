#include "core/geometry/mesh_contact/mesh_kernels.h"

#include "core/geometry/contact/feature/contact_feature.h"
#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/contact/polytope/polytope_edges.h"
#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/dispatch/polytope_kernels.h"
#include "core/geometry/mesh_contact/front_crossing_search.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// Finds triangles beside which the shape lies: a plane through an edge, square to the face, parts
/// both by more than the margin. About half of those within the shape's bounds are, and this costs
/// a tenth of finding that they have no contact.
class BesideTest {
 public:
  explicit BesideTest(const MeshContactFrame& frame)
      : frame_(frame),
        centre_(to_local(frame.rotation, frame.offset)),
        limit_(fine(frame.margin) + k_slack) {}

  [[nodiscard]] bool is_beside(const Polytope& triangle) const {
    for (std::size_t i = 0; i < 3; ++i)
      if (parts(triangle.vertices[i], triangle.vertices[(i + 1) % 3], triangle.faces[0].normal))
        return true;
    return false;
  }

 private:
  /// More than rounding, and than clipping moves a vertex: 2^-10 m.
  static constexpr Fine k_slack = Fine{1} << (k_fine_bits - 10);
  static_assert(k_slack > 2 * k_snap);

  [[nodiscard]] bool parts(const Vec3<Length>& from, const Vec3<Length>& to,
                           const Vec3<Unit>& normal) const {
    const RawVec outward = cross_narrow(raws_of(to - from), raws_of(normal));
    const RawVec way = centre_ - fine(from);
    if (!is_ahead(way, outward)) return false;
    const Vec3<Unit> out = direction_of(outward.x, outward.y, outward.z);
    const Vec3<Unit> towards = -unit_axis(lockstone::rotate(frame_.rotation, out));
    return dot(way, out) - reach_along(frame_.shape, towards) > limit_;
  }

  /// Whether two vectors point the same way, about.
  [[nodiscard]] static bool is_ahead(const RawVec& way, const RawVec& outward) {
    const auto product = [](Fine x, std::int64_t y) { return (x >> 32) * (y >> 32); };
    return product(way.x, outward.x) + product(way.y, outward.y) + product(way.z, outward.z) > 0;
  }

  const MeshContactFrame& frame_;
  RawVec centre_;  ///< of the shape, in the triangles' frame
  Fine limit_;
};

class Collect final : public PartVisitor {
 public:
  Collect(const MeshContactFrame& frame, TriangleContacts& out)
      : PartVisitor(true), frame_(frame), beside_(frame), out_(out) {}

  void visit(const Part& part) override {
    const PosedShape triangle{part.shape, frame_.rotation, part.polytope};
    out_.add(part, beside_.is_beside(*part.polytope)
                       ? Manifold{}
                       : part.polytope->kernels->collide(triangle, frame_.shape, frame_.offset,
                                                         frame_.margin, {}));
  }

 private:
  const MeshContactFrame& frame_;
  BesideTest beside_;
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
