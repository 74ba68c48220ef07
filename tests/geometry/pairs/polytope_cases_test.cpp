// Polytopes against each other by construction: boxes as polytopes, flat and one-sided ones,
// degenerate positions, extreme sizes.
#include "core/geometry/contact/manifold/contact_tolerances.h"
#include "core/geometry/contact/manifold/manifold_reduction.h"
#include "core/geometry/convex/polytope_box.h"
#include "tests/geometry/pairs/clipped_face.h"
#include "tests/geometry/pairs/polytope_scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

using geometry::BoxPolytope;
using geometry::Polytope;

Shape hull(std::uint64_t id) {
  return {ShapeKind::hull, {}, {id}};
}

/// A box's polytope with the kernels of a hull.
struct HullBox {
  explicit HullBox(const Vec3<Length>& half) : box(half), view(box.view()) {
    view.kernels = &geometry::polytope_kernels();
  }
  BoxPolytope box;
  Polytope view;
};

TEST(BoxPolytope, HasClosedFacesThatTouchTheirVertices) {
  const HullBox box(metres(1, 2, 3));
  for (int edge = 0; edge < 24; ++edge) {
    const auto& half = box.view.edges[static_cast<std::size_t>(edge)];
    EXPECT_EQ(box.view.edges[half.twin].twin, edge);
    EXPECT_NE(box.view.edges[half.twin].face, half.face);
    const auto after = geometry::next_edge(box.view, static_cast<std::uint16_t>(edge));
    EXPECT_EQ(box.view.edges[after].origin, box.view.edges[half.twin].origin);
    const auto& face = box.view.faces[half.face];
    EXPECT_EQ(dot(geometry::start_of(box.view, edge), face.normal).raw, face.offset);
    const RealVec turn = cross(real(geometry::edge_vector(box.view, edge)),
                               real(geometry::edge_vector(box.view, after)));
    EXPECT_GT(static_cast<double>(dot(turn, real(face.normal))), 0);
  }
}

struct DepthRange {
  Real least = 1e30L;
  Real greatest = -1e30L;

  [[nodiscard]] bool is_empty() const { return greatest < least; }
};

/// Takes in the faces of `own` that have the normal: the deepest point of the other's face within
/// the sides, and that within k_snap of them.
void add_faces(DepthRange& range, const Placed& own, const Placed& other, const RealVec& normal) {
  for (int axis = 0; axis < 3; ++axis) {
    if (std::fabs(dot(own.axes[static_cast<std::size_t>(axis)], normal)) < 1 - 1e-8L) continue;
    const Real snap = std::ldexp(Real{geometry::k_snap}, -geometry::k_fine_bits);
    range.least = std::min(range.least, deepest_within(own, axis, normal, other, snap));
    range.greatest = std::max(range.greatest, deepest_within(own, axis, normal, other, 0));
  }
}

/// Between these heights is the deepest point of a manifold that two boxes have on a face. A vertex
/// beyond a side by less than k_snap may count as on it, and four points may leave out k_deeper of
/// the depth. A box leaves such a vertex in its place where the face is not steep across that side.
/// A polytope moves it onto the side where the face is not steep across any, and so raises or
/// lowers it by at most k_snap / 16 for each of two sides. Where the face is steep across one side
/// only, a box keeps a vertex that a polytope cuts off.
DepthRange depths_of(const Scene& scene, const RealVec& normal) {
  constexpr geometry::Fine lift = 2 * geometry::k_snap / 16;
  DepthRange range;
  add_faces(range, scene.placed_a(), scene.placed_b(), normal);
  add_faces(range, scene.placed_b(), scene.placed_a(), normal * -1);
  range.least -= std::ldexp(Real{lift}, -geometry::k_fine_bits);
  range.greatest += std::ldexp(Real{lift + geometry::k_deeper}, -geometry::k_fine_bits);
  return range;
}

TEST(CollidePolytope, ABoxAsAPolytopeAgreesWithTheBox) {
  int compared = 0, clipped = 0;
  for_random_scenes(600, [&](Dice&, const Scene& scene) {
    if (scene.a.kind != ShapeKind::box) return;
    const HullBox box(scene.a.size);
    const PosedShape a{hull(1), scene.rotation_a, &box.view};
    const Manifold m = scene.collide();
    const Manifold p = collide(a, scene.posed_b(), scene.offset, scene.margin);
    const Real truth = signed_distance(scene.placed_a(), scene.placed_b());
    const Real limit = 2 * k_micrometre + 4e-9L * scene.scale();
    const Real rim = std::fabs(truth) / 1000 + scene.placed_b().radius() / 1000;
    if (std::fabs(truth - real(scene.margin)) < 32 * k_micrometre + limit + rim) return;
    ASSERT_EQ(m.count > 0, p.count > 0) << static_cast<double>(truth);
    if (m.count == 0 || truth < -127) return;
    ++compared;
    // Overlapping, either may prefer its axis by a tenth, a 1/32 and 0.74 mm.
    const Real choice =
        truth > 0 ? 32 * k_micrometre + rim : 0.00074L + 0.15L * std::fabs(truth) + rim;
    EXPECT_NEAR(static_cast<double>(deepest(m)), static_cast<double>(deepest(p)),
                static_cast<double>(limit + choice));
    if (m.normal != p.normal || scene.b.kind != ShapeKind::box) return;
    const DepthRange range = depths_of(scene, real(m.normal));
    if (range.is_empty()) {  // edges that cross
      EXPECT_NEAR(static_cast<double>(deepest(m)), static_cast<double>(deepest(p)),
                  static_cast<double>(limit));
      return;
    }
    if (m.count < 2 || p.count < 2 || range.greatest > 1e29L) return;  // not between the sides
    if (range.least < -127) return;                                    // separations saturate
    ++clipped;
    for (const Manifold& manifold : {m, p}) {
      EXPECT_GE(static_cast<double>(deepest(manifold)), static_cast<double>(range.least - limit));
      EXPECT_LE(static_cast<double>(deepest(manifold)),
                static_cast<double>(range.greatest + limit));
    }
  });
  EXPECT_GT(compared, 700);
  EXPECT_GT(clipped, 100);
}

TEST(CollidePolytope, RestingFlatGivesFourPointsWithTheSameFeaturesWhileItTrembles) {
  const HullBox ground(metres(50, 1, 50));
  const TestPolytope prism(prism_points(6, 0.5, 0.5));
  const HullBox cube(metres(0.5, 0.5, 0.5));
  Dice dice;
  for (const Polytope* upper : {&prism.view(), static_cast<const Polytope*>(&cube.view)}) {
    for (const Polytope* lower : {static_cast<const Polytope*>(&ground.view), upper}) {
      const double height = (lower == &ground.view ? 1 : 0.5) + 0.5 - 0.0005;
      const PosedShape below{hull(2), k_identity, lower};
      const Manifold rest =
          collide(below, {hull(1), k_identity, upper}, metres(0, height, 0), metres(0.05));
      ASSERT_EQ(rest.count, 4);
      EXPECT_EQ(rest.normal, (Vec3<Unit>{{}, Unit::from_integer(1), {}}));
      for (int i = 0; i < 300; ++i) {
        const auto jitter = [&dice] { return dice.uniform(-1e-6, 1e-6); };
        const Mat3 turn = turned(jitter(), 1, jitter(), 4 * jitter());
        const Manifold m = collide(below, {hull(1), turn, upper},
                                   metres(jitter(), height + jitter(), jitter()), metres(0.05));
        ASSERT_EQ(features_of(m), features_of(rest));
      }
    }
  }
}

TEST(CollidePolytope, CrossingEdgesMeetInOnePointSquareToBoth) {
  // Two roofs, one upside down and turned, ridge on ridge.
  const std::vector roof{metres(-1, -1, -1), metres(1, -1, -1), metres(-1, -1, 1),
                         metres(1, -1, 1),   metres(-1, 0, 0),  metres(1, 0, 0)};
  const TestPolytope lower(roof);
  const Mat3 over = turned(1, 0, 0, 3.14159265358979);
  const Mat3 quarter = turned(0, 1, 0, 1.2);
  const Mat3 turn{rotate(quarter, over.x), rotate(quarter, over.y), rotate(quarter, over.z)};
  for (const double gap : {0.01, 0.0, -0.01}) {
    const Manifold m = collide({hull(2), k_identity, &lower.view()}, {hull(1), turn, &lower.view()},
                               metres(0, gap, 0), metres(0.05));
    ASSERT_EQ(m.count, 1);
    EXPECT_NEAR(static_cast<double>(real(m.normal.y)), 1, 1e-8);
    EXPECT_NEAR(static_cast<double>(deepest(m)), gap, 2e-6);
  }
}

TEST(CollidePolytope, AVertexOnAFaceTouchesIt) {
  const TestPolytope octahedron(std::vector{metres(1, 0, 0), metres(-1, 0, 0), metres(0, 1, 0),
                                            metres(0, -1, 0), metres(0, 0, 1), metres(0, 0, -1)});
  const HullBox ground(metres(5, 1, 5));
  const Manifold m = collide({hull(2), k_identity, &ground.view},
                             {hull(1), k_identity, &octahedron.view()}, metres(0.3, 2, 0.2), {});
  ASSERT_EQ(m.count, 1);
  EXPECT_EQ(m.points[0].separation.raw, 0);
  EXPECT_EQ(m.points[0].anchor_a, metres(0.3, 1, 0.2));
}

TEST(CollidePolytope, ConcentricAndNestedOnesTouch) {
  Dice dice;
  for (int i = 0; i < 300; ++i) {
    const auto outer = random_polytope(dice, dice.uniform(1, 900));
    const auto inner = random_polytope(dice, dice.uniform(0.01, 1));
    if (geometry::is_flat(outer->view())) continue;
    const PosedShape a{hull(2), to_matrix(dice.orientation()), &outer->view()};
    const Mat3 turn = to_matrix(dice.orientation());
    for (const Body& b : {Body{hull(1), turn, &inner->view()}, Body{hull(2), turn, &outer->view()},
                          Body{Shape::box(metres(0.1), metres(0.2), metres(0.3)), turn},
                          Body{Shape::capsule(metres(0.1), metres(0.2)), turn},
                          Body{Shape::sphere(metres(0.3)), turn}}) {
      const Vec3<Length> middle = rotate(a.rotation, outer->view().interior);
      Vec3<Length> offset = middle;
      if (b.polytope != nullptr) offset -= rotate(b.rotation, b.polytope->interior);
      const Manifold m = collide(a, b.posed(), offset, {});
      ASSERT_GT(m.count, 0);
      EXPECT_LE(static_cast<double>(deepest(m)), 0);
    }
  }
}

TEST(CollidePolytope, HugeAndTinyOnesFarApartStayInRange) {
  Dice dice;
  for (int i = 0; i < 400; ++i) {
    const auto huge = std::make_unique<TestPolytope>(
        dice.chance(2) ? box_points(1000, 1000, 1000) : cloud(dice, 9, 1000, 1000, 1000));
    const auto other = dice.chance(2)
                           ? random_polytope(dice, 0.002)
                           : std::make_unique<TestPolytope>(box_points(1000, 1000, 1000));
    const auto coordinate = [&dice] { return dice.uniform(-2000, 2000); };
    const Vec3<Length> offset = dice.chance(3) ? metres(2000, dice.chance(2) ? 2000 : -2000, 2000)
                                               : metres(coordinate(), coordinate(), coordinate());
    const PosedShape a{hull(2), to_matrix(dice.orientation()), &huge->view()};
    const Mat3 turn = to_matrix(dice.orientation());
    const Length margin = metres(64);
    for (const Body& body :
         {Body{hull(1), turn, &other->view()}, Body{Shape::sphere(metres(512)), turn},
          Body{Shape::capsule(metres(512), metres(512)), turn},
          Body{Shape::box(metres(512), metres(512), metres(0.001)), turn}}) {
      const PosedShape second = body.posed();
      const Manifold m = collide(a, second, offset, margin);
      EXPECT_LE(m.count, k_max_manifold_points);
      const RealSolid solid_a = real_solid(a, {});
      const Real truth = signed_distance(solid_a, real_solid(second, real(offset)));
      if (std::fabs(truth) > 1e-4L && std::fabs(truth - 64) > 1) {
        ASSERT_EQ(m.count > 0, truth < 64) << static_cast<double>(truth);
      }
    }
  }
}

// Triangles of meshes
// -------------------------------------------------------------------------------------------------

class OneSided : public ::testing::Test {
 protected:
  /// Counter-clockwise seen from above.
  TestPolytopePtr triangle_ =
      TestPolytope::flat({metres(-4, 0, 4), metres(4, 0, 4), metres(0, 0, -4)}, true);
  Body ground_body_{hull(0), k_identity, &triangle_->view()};
  PosedShape ground_ = ground_body_.posed();
  TestPolytope wedge_{std::vector{metres(-0.5, -0.5, -0.5), metres(0.5, -0.5, -0.5),
                                  metres(-0.5, -0.5, 0.5), metres(0.5, -0.5, 0.5),
                                  metres(-0.5, 0.5, 0), metres(0.5, 0.5, 0)}};
  std::vector<Body> bodies_{{Shape::sphere(metres(0.5)), k_identity},
                            {Shape::capsule(metres(0.25), metres(0.25)), k_identity},
                            {Shape::box(metres(0.5), metres(0.5), metres(0.5)), k_identity},
                            {hull(9), k_identity, &wedge_.view()}};
};

TEST_F(OneSided, PushesToTheFrontHoweverDeepUpToTheCentre) {
  for (const Body& body : bodies_) {
    for (const double height : {0.52, 0.5, 0.45, 0.3, 0.2}) {
      const Manifold m = collide(ground_, body.posed(), metres(0, height, 0), metres(0.05));
      ASSERT_GT(m.count, 0) << height;
      EXPECT_EQ(m.normal, (Vec3<Unit>{{}, Unit::from_integer(1), {}})) << height;
      EXPECT_NEAR(static_cast<double>(deepest(m)), height - 0.5, 2e-6);
    }
  }
}

TEST_F(OneSided, IgnoresBodiesWithTheirCentreBehind) {
  for (const Body& body : bodies_)
    for (const double height : {-0.6, -0.45, -0.2, -0.2 - 1e-6}) {
      EXPECT_EQ(collide(ground_, body.posed(), metres(0, height, 0), metres(0.05)).count, 0);
      EXPECT_EQ(collide(body.posed(), ground_, metres(0, -height, 0), metres(0.05)).count, 0);
    }
}

TEST_F(OneSided, NeverPushesBackward) {
  Dice dice;
  int met = 0;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const auto triangle = random_triangle(dice, 2, true);
    const PosedShape skin{hull(0), to_matrix(dice.orientation()), &triangle->view()};
    const Body& body = bodies_[static_cast<std::size_t>(i) % bodies_.size()];
    const Mat3 turn = to_matrix(dice.orientation());
    const PosedShape turned_body{body.shape, turn, body.polytope};
    const Vec3<Length> offset = metres(dice.direction() * dice.uniform(0, 2.5));
    const Manifold m = collide(skin, turned_body, offset, metres(0.05));
    if (m.count == 0) continue;
    ++met;
    const RealVec n = real(rotate(skin.rotation, triangle->view().faces[0].normal));
    ASSERT_GE(static_cast<double>(dot(n, real(m.normal))), -0.001);
    const Real truth = signed_distance(real_solid(skin, {}), real_solid(turned_body, real(offset)));
    ASSERT_LT(static_cast<double>(truth), 0.0501);
    if (m.points[0].separation.raw < 0 && truth > 0) {
      ASSERT_LT(static_cast<double>(truth), 1e-5);
    }
  }
  EXPECT_GT(met, test::share_of(1000));
}

TEST_F(OneSided, ATwoSidedOnePushesToEitherSide) {
  const auto both = TestPolytope::flat({metres(-4, 0, 4), metres(4, 0, 4), metres(0, 0, -4)});
  const PosedShape plate{hull(0), k_identity, &both->view()};
  for (const Body& body : bodies_) {
    const Manifold m = collide(plate, body.posed(), metres(0, -0.45, 0), metres(0.05));
    ASSERT_GT(m.count, 0);
    EXPECT_EQ(m.normal.y, -Unit::from_integer(1));
  }
}

}  // namespace
}  // namespace lockstone::test
