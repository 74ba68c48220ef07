// Triangles beside which a shape lies are passed over: the contacts stay those of all triangles.
#include "core/geometry/mesh_contact/mesh_kernels.h"

#include <cmath>
#include <memory>

#include <gtest/gtest.h>

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/dispatch/polytope_kernels.h"
#include "tests/geometry/assets/asset_parts.h"
#include "tests/geometry/identical_manifolds.h"

namespace lockstone::test {
namespace {

using geometry::LocalBounds;
using geometry::MeshContactFrame;
using geometry::MeshManifolds;
using geometry::Part;
using geometry::TriangleContacts;

// Collides every triangle of the region.
class CollideAll final : public geometry::PartVisitor {
 public:
  CollideAll(const MeshContactFrame& frame, TriangleContacts& out)
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

// Shapes of any size and pose over, in and beside rough ground of cells of any size.
TEST(MeshKernels, FindTheContactsOfAllTriangles) {
  Dice dice;
  const auto found = std::make_unique<TriangleContacts>();
  int contacts = 0;
  for (int round = 0; round < 40; ++round) {
    const double cell = std::exp2(dice.uniform(-4, 4)), rough = cell * dice.uniform(0, 0.6);
    const auto mesh =
        Mesh::build(grid(9, 9, cell, [&](int, int) { return dice.uniform(-rough, rough); }).def())
            .mesh;
    for (int i = 0; i < 50; ++i) {
      const auto kind = static_cast<ShapeKind>(dice.between(0, 2));
      const Shape shape = dice.shape(kind, cell / 16, cell * 2);
      const Mat3 rotation = to_matrix(dice.orientation());
      const PosedShape posed{shape, to_matrix(dice.orientation())};
      const double high = std::exp2(dice.uniform(-3, 1)) * cell;
      const Vec3<Length> local = metres(dice.uniform(-1, 9) * cell, dice.uniform(-0.2, 1) * high,
                                        dice.uniform(-1, 9) * cell);
      const Vec3<Length> offset = saturated<Length>(lockstone::rotate(rotation, local));
      const Length margin = metres(dice.uniform(0, 0.1) * cell);
      const MeshContactFrame frame{rotation, posed, offset, margin};
      const Length reach = bounding_radius(shape) + margin + metres(0.001);
      const LocalBounds region{local - Vec3<Length>{reach, reach, reach},
                               local + Vec3<Length>{reach, reach, reach}};
      MeshManifolds expected, here;
      found->clear();
      CollideAll all(frame, *found);
      mesh->geometry().visit_parts(region, all);
      geometry::join_triangle_contacts(*found, frame, expected);
      geometry::mesh_kernels().collide(mesh->geometry(), frame, region, *found, here);
      ASSERT_TRUE(are_identical(here, expected)) << round << ", " << i;
      contacts += static_cast<int>(here.count);
    }
  }
  EXPECT_GT(contacts, 300);
}

}  // namespace
}  // namespace lockstone::test
