#include "core/geometry/mesh_contact/mesh_contacts.h"

#include <algorithm>

#include <gtest/gtest.h>

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/dispatch/polytope_kernels.h"
#include "core/geometry/distance/contact_point.h"
#include "tests/geometry/assets/asset_parts.h"
#include "tests/geometry/identical_manifolds.h"

namespace lockstone::test {
namespace {

using geometry::LocalBounds;
using geometry::MeshContactFrame;
using geometry::MeshManifold;
using geometry::MeshManifolds;
using geometry::Part;
using geometry::TriangleContact;
using geometry::TriangleContacts;
using geometry::TriangleVertices;

RealVec turned_by(const Mat3& m, const RealVec& v) {
  return real(m.x) * v.x + real(m.y) * v.y + real(m.z) * v.z;
}

RealVec closest_on_segment(const RealVec& p, const RealVec& a, const RealVec& b) {
  const RealVec d = b - a;
  const Real t = std::clamp<Real>(dot(p - a, d) / dot(d, d), 0, 1);
  return a + d * t;
}

RealVec closest_on_triangle(const RealVec& p, const std::array<RealVec, 3>& t) {
  const RealVec n = cross(t[1] - t[0], t[2] - t[0]);
  bool inside = true;
  RealVec best = t[0];
  for (std::size_t i = 0; i < 3; ++i) {
    const RealVec& a = t[i];
    const RealVec& b = t[(i + 1) % 3];
    inside = inside && dot(cross(n, b - a), p - a) >= 0;
    const RealVec q = closest_on_segment(p, a, b);
    if (norm(p - q) < norm(p - best)) best = q;
  }
  return inside ? p - n * (dot(p - t[0], n) / dot(n, n)) : best;
}

geometry::RawVec fine_of(const RealVec& v) {
  const auto lane = [](Real x) {
    return static_cast<std::int64_t>(std::llround(std::ldexp(x, 50)));
  };
  return {lane(v.x), lane(v.y), lane(v.z)};
}

Vec3<Unit> unit_of(const RealVec& v) {
  const auto lane = [](Real x) { return unit(static_cast<double>(x)); };
  return {lane(v.x), lane(v.y), lane(v.z)};
}

/// A pose of a convex shape near a mesh whose frame is turned by `rotation` about its origin.
struct Pose {
  Shape shape;
  Mat3 turn{};        ///< of the shape
  Vec3<Length> at{};  ///< its centre, from the mesh's origin, world axes
  Mat3 rotation{};    ///< of the mesh
  Length margin = metres(0.05);

  [[nodiscard]] PosedShape posed() const { return {shape, turn}; }
};

/// A sphere against the front of a triangle, in long double.
Manifold collide_sphere_front(const TriangleVertices& vertices, const Pose& pose) {
  std::array<RealVec, 3> t;
  for (std::size_t i = 0; i < 3; ++i)
    t[i] = turned_by(pose.rotation, real(vertices[i]));
  const RealVec centre = real(pose.at);
  const RealVec n = cross(t[1] - t[0], t[2] - t[0]);
  Manifold manifold;
  if (dot(centre - t[0], n) < 0) return manifold;
  const RealVec q = closest_on_triangle(centre, t);
  const RealVec gap = centre - q;
  const Real distance = norm(gap);
  const RealVec outward = distance < 1e-9L ? n * (1 / norm(n)) : gap * (1 / distance);
  manifold.normal = unit_of(outward);
  const Real radius = real(pose.shape.size.x);
  geometry::add_round_point(manifold, {fine_of(q), fine_of(centre - outward * radius)}, pose.at,
                            fine_of({distance - radius, 0, 0}).x, pose.margin, 7);
  return manifold;
}

TriangleContact contact_with(std::uint32_t part, const TriangleVertices& vertices,
                             std::uint8_t active_edges, const Surface* surface = nullptr) {
  TriangleContact contact;
  contact.part = part;
  contact.vertices = vertices;
  contact.face_normal = geometry::triangle_normal(vertices);
  contact.active_edges = active_edges;
  contact.surface = surface;
  return contact;
}

class CollectContacts final : public geometry::PartVisitor {
 public:
  CollectContacts(const Pose& pose, std::vector<TriangleContact>& out)
      : PartVisitor(true), pose_(pose), out_(out) {}

  void visit(const Part& part) override {
    const auto& v = part.polytope->vertices;
    const TriangleVertices vertices{v[0], v[1], v[2]};
    const bool is_sphere = pose_.shape.kind == ShapeKind::sphere;
    const PosedShape triangle{part.shape, pose_.rotation, part.polytope};
    const Manifold manifold = is_sphere ? collide_sphere_front(vertices, pose_)
                                        : part.polytope->kernels->collide(
                                              triangle, pose_.posed(), pose_.at, pose_.margin, {});
    TriangleContact contact =
        contact_with(part.index, vertices, part.triangle.active_edges, part.surface);
    contact.manifold = manifold;
    out_.push_back(contact);
  }

 private:
  const Pose& pose_;
  std::vector<TriangleContact>& out_;
};

std::vector<TriangleContact> contacts_of(const Asset& mesh, const Pose& pose) {
  const Length reach = bounding_radius(pose.shape) + pose.margin + Length::from_raw(4);
  const Vec3<Length> local = rotate_inverse(pose.rotation, pose.at);
  const Vec3<Length> around{reach, reach, reach};
  std::vector<TriangleContact> contacts;
  CollectContacts collect(pose, contacts);
  mesh.geometry().visit_parts({local - around, local + around}, collect);
  return contacts;
}

MeshManifolds joined(const std::vector<TriangleContact>& contacts, const Pose& pose) {
  static TriangleContacts list;
  list.clear();
  for (const TriangleContact& contact : contacts)
    list.add(contact);
  MeshManifolds result;
  const PosedShape posed = pose.posed();
  join_triangle_contacts(list, {pose.rotation, posed, pose.at, pose.margin}, result);
  return result;
}

MeshManifolds joined(const Asset& mesh, const Pose& pose) {
  return joined(contacts_of(mesh, pose), pose);
}

std::shared_ptr<const Mesh> built(const Triangles& triangles) {
  const MeshResult result = Mesh::build(triangles.def());
  EXPECT_TRUE(result.ok());
  return result.mesh;
}

std::shared_ptr<const Mesh> flat_grid(int cells, double cell) {
  Triangles flat = grid(cells + 1, cells + 1, cell, [](int, int) { return 0.0; });
  for (Vec3<Length>& v : flat.vertices) {
    v.x -= metres(cells * cell / 2);
    v.z -= metres(cells * cell / 2);
  }
  return built(flat);
}

Real micrometres(Real x) {
  return x * 1e6L;
}

/// Every point of every manifold is one of a plane with this normal through the origin.
void expect_plane_only(const MeshManifolds& result, const Pose& pose, const RealVec& plane) {
  for (std::size_t i = 0; i < result.count; ++i) {
    const Manifold& manifold = result.manifolds[i].manifold;
    ASSERT_LT(norm(real(manifold.normal) - plane), std::ldexp(1.0L, -20));
    for (int k = 0; k < manifold.count; ++k) {
      const ManifoldPoint& point = manifold.points[static_cast<std::size_t>(k)];
      const geometry::RawVec on_b = geometry::witness_on_b(manifold, point, pose.shape, pose.at);
      const auto lane = [](std::int64_t x) { return std::ldexp(static_cast<Real>(x), -50); };
      const RealVec witness{lane(on_b.x), lane(on_b.y), lane(on_b.z)};
      ASSERT_NEAR(static_cast<double>(micrometres(real(point.separation))),
                  static_cast<double>(micrometres(dot(witness, plane))), 2);
    }
  }
}

Real least(const MeshManifolds& result) {
  Real least = 1e9L;
  for (std::size_t i = 0; i < result.count; ++i)
    least = std::min(least, real(geometry::least_separation(result.manifolds[i].manifold)));
  return least;
}

Mat3 random_turn(Dice& dice) {
  return dice.chance(3) ? Mat3{} : to_matrix(dice.orientation());
}

/// Places the shape so that its lowest point is `height` above a plane through the origin with the
/// normal `up`, at coordinates across that often lie on edges and vertices.
void place_over_plane(Dice& dice, Pose& pose, double spread, double cell, double height) {
  const auto across = [&] {
    const double x = dice.uniform(-spread, spread);
    return dice.chance(2) ? x : std::round(x / cell) * cell + (dice.chance(2) ? 0 : 1e-6);
  };
  const RealVec up = turned_by(pose.rotation, {0, 1, 0});
  const Placed placed{pose.posed(), {}};
  const auto reach = static_cast<double>(placed.reach(up * Real{-1}));
  const RealVec at = turned_by(pose.rotation, {across(), reach + height, across()});
  pose.at = metres(static_cast<double>(at.x), static_cast<double>(at.y), static_cast<double>(at.z));
}

/// The analytic separation of the shape and the plane.
Real plane_separation(const Pose& pose, const RealVec& up) {
  const Placed placed{pose.posed(), {}};
  return dot(real(pose.at), up) - placed.reach(up * Real{-1});
}

void expect_flat_grid_is_a_plane(ShapeKind kind, int rounds) {
  Dice dice;
  const auto mesh = flat_grid(24, 0.25);
  for (int i = 0; i < rounds && !::testing::Test::HasFailure(); ++i) {
    Pose pose{dice.shape(kind, 0.05, 0.6)};
    pose.rotation = random_turn(dice);
    pose.turn = to_matrix(dice.orientation());
    place_over_plane(dice, pose, 1.5, 0.25, dice.uniform(-0.03, 0.04));
    const RealVec up = turned_by(pose.rotation, {0, 1, 0});
    const MeshManifolds result = joined(*mesh, pose);
    SCOPED_TRACE(describe(pose.shape) + " at " + std::to_string(i));
    ASSERT_EQ(result.count, 1U);
    expect_plane_only(result, pose, up);
    ASSERT_NEAR(static_cast<double>(micrometres(least(result))),
                static_cast<double>(micrometres(plane_separation(pose, up))), 3);
  }
}

TEST(MeshContacts, AFlatGridIsAPlaneToSpheres) {
  expect_flat_grid_is_a_plane(ShapeKind::sphere, 1000);
}

TEST(MeshContacts, AFlatGridIsAPlaneToCapsules) {
  expect_flat_grid_is_a_plane(ShapeKind::capsule, 1000);
}

TEST(MeshContacts, AFlatGridIsAPlaneToBoxes) {
  expect_flat_grid_is_a_plane(ShapeKind::box, 1000);
}

TEST(MeshContacts, WithoutTheRemovalAFlatGridHasGhosts) {
  const auto mesh = flat_grid(8, 0.25);
  Pose pose{Shape::sphere(metres(0.5)), {}, metres(0.1, 0.49, 0.06)};
  const auto contacts = contacts_of(*mesh, pose);
  MeshManifolds result;
  const PosedShape posed = pose.posed();
  geometry::merge_planes(contacts, {pose.rotation, posed, pose.at, pose.margin}, result);
  EXPECT_GT(result.count, 1U);
  EXPECT_EQ(joined(contacts, pose).count, 1U);
}

/// The contacts of a box that stands flat on a grid.
MeshManifold standing_box(const Asset& mesh, double x, double z) {
  const Pose pose{Shape::box(metres(0.4), metres(0.3), metres(0.5)), turned(0, 1, 0, 0.3),
                  metres(x, 0.299, z)};
  const MeshManifolds result = joined(mesh, pose);
  EXPECT_EQ(result.count, 1U);
  return result.manifolds[0];
}

TEST(MeshContacts, ABoxKeepsItsFourFeaturesAsItSlidesOverAGrid) {
  const auto mesh = flat_grid(24, 0.25);
  const MeshManifold first = standing_box(*mesh, 0, 0);
  ASSERT_EQ(first.manifold.count, 4);
  for (int step = 1; step < 300; ++step) {
    const MeshManifold next = standing_box(*mesh, 0.00371 * step, 0.0029 * step);
    ASSERT_EQ(next.key, first.key);
    ASSERT_EQ(next.manifold.count, 4);
    for (std::size_t i = 0; i < 4; ++i) {
      ASSERT_EQ(next.manifold.points[i].feature, first.manifold.points[i].feature);
      ASSERT_LT(next.manifold.points[i].feature, 8U);
    }
  }
}

/// A floor of cells and a wall that rises from its edge at x = 0.
Triangles corner(int cells, double cell) {
  Triangles corner = grid(cells + 1, cells + 1, cell, [](int, int) { return 0.0; });
  const auto floor_vertices = static_cast<std::uint32_t>(corner.vertices.size());
  const Triangles wall = grid(cells + 1, cells + 1, cell, [](int, int) { return 0.0; });
  for (const Vec3<Length>& v : wall.vertices)
    corner.vertices.push_back({{}, v.x, v.z});
  for (const TriangleIndices& t : wall.triangles) {
    corner.triangles.push_back({floor_vertices + t.a, floor_vertices + t.c, floor_vertices + t.b});
  }
  return corner;
}

TEST(MeshContacts, InACornerOnlyTheTwoPlanesPush) {
  Dice dice;
  const auto mesh = built(corner(12, 0.25));
  for (int i = 0; i < 500; ++i) {
    const double r = dice.uniform(0.1, 0.6);
    Pose pose{Shape::sphere(metres(r))};
    const double gap_x = dice.chance(2) ? dice.uniform(-0.05, 0.0499) : dice.uniform(0.0501, 0.1);
    const double gap_y = dice.chance(2) ? dice.uniform(-0.05, 0.0499) : dice.uniform(0.0501, 0.1);
    pose.at = metres(r + gap_x, r + gap_y, dice.uniform(1, 2));
    const MeshManifolds result = joined(*mesh, pose);
    ASSERT_EQ(result.count, (gap_x < 0.05 ? 1U : 0U) + (gap_y < 0.05 ? 1U : 0U));
    for (std::size_t k = 0; k < result.count; ++k) {
      const Vec3<Unit> n = result.manifolds[k].manifold.normal;
      const bool floor = n.y.raw > n.x.raw;
      ASSERT_EQ(n, floor ? (Vec3<Unit>{{}, unit(1), {}}) : (Vec3<Unit>{unit(1), {}, {}}));
      const Displacement separation = geometry::least_separation(result.manifolds[k].manifold);
      ASSERT_NEAR(static_cast<double>(real(separation)), floor ? gap_y : gap_x, 2e-6);
    }
  }
}

TEST(MeshContacts, ABoxThatRunsIntoAWallFeelsTheFloorAndTheWall) {
  const auto mesh = built(corner(12, 0.25));
  for (int i = 0; i < 100; ++i) {
    const Pose pose{Shape::box(metres(0.4), metres(0.3), metres(0.5)),
                    {},
                    metres(0.4 - 0.0001 * i, 0.2995, 1.5 + 0.003 * i)};
    const MeshManifolds result = joined(*mesh, pose);
    ASSERT_EQ(result.count, 2U) << i;
    ASSERT_EQ(result.manifolds[0].manifold.normal, (Vec3<Unit>{{}, unit(1), {}}));
    ASSERT_EQ(result.manifolds[1].manifold.normal, (Vec3<Unit>{unit(1), {}, {}}));
  }
}

TEST(MeshContacts, AnEdgeOfACubePushesAlongTheWholeAngleBetweenItsFaces) {
  Dice dice;
  const auto mesh = built(cube(1));
  for (int i = 0; i < 200; ++i) {
    const double angle = dice.uniform(0.02, 1.55);
    const double distance = dice.uniform(0.25, 0.32);
    Pose pose{Shape::sphere(metres(0.3))};
    pose.at = metres(1 + distance * std::sin(angle), 1 + distance * std::cos(angle),
                     dice.uniform(-0.7, 0.7));
    const MeshManifolds result = joined(*mesh, pose);
    ASSERT_EQ(result.count, 1U);
    ASSERT_EQ(result.manifolds[0].manifold.count, 1);
    const Vec3<Unit> n = result.manifolds[0].manifold.normal;
    ASSERT_NEAR(static_cast<double>(real(n.x)), std::sin(angle), 2e-5);
    ASSERT_NEAR(static_cast<double>(real(n.y)), std::cos(angle), 2e-5);
  }
}

/// Every normal that is left is the direction to a nearest point of the surface around it, and the
/// nearest of all is among them.
TEST(MeshContacts, KeepTheNearestPointOfARoughSurface) {
  Dice dice;
  for (int round = 0; round < 8; ++round) {
    const double rough = round % 2 == 0 ? 0.01 : 0.2;
    const auto mesh =
        built(grid(13, 13, 0.25, [&](int, int) { return dice.uniform(-rough, rough); }));
    const auto parts = all_parts(*mesh);
    for (int i = 0; i < 25; ++i) {
      Pose pose{Shape::sphere(metres(dice.uniform(0.05, 0.5)))};
      pose.at = metres(dice.uniform(1, 2), 3, dice.uniform(1, 2));
      Real nearest = 1e9L;
      const auto height_over = [&] {
        nearest = 1e9L;
        for (const SeenPart& part : parts) {
          std::array<RealVec, 3> t;
          for (std::size_t k = 0; k < 3; ++k)
            t[k] = real(part.vertices[k]);
          nearest = std::min(nearest, norm(real(pose.at) - closest_on_triangle(real(pose.at), t)));
        }
        return nearest - real(pose.shape.size.x);
      };
      for (int step = 0; step < 6; ++step)
        pose.at.y -= metres(static_cast<double>(height_over()));
      const Real expected = height_over();
      const MeshManifolds result = joined(*mesh, pose);
      ASSERT_GE(result.count, 1U);
      ASSERT_NEAR(static_cast<double>(least(result)), static_cast<double>(expected), 3e-6);
    }
  }
}

TEST(MeshContacts, DoNotDependOnTheOrderOfArrivalEvenBeyondTheCapacity) {
  Dice dice;
  for (const double cell : {0.25, 0.02}) {
    const auto mesh = built(grid(60, 60, cell, [&](int, int) { return dice.uniform(0, 0.03); }));
    Pose pose{Shape::sphere(metres(0.4)), {}, metres(30 * cell, 0.41, 30 * cell)};
    auto contacts = contacts_of(*mesh, pose);
    EXPECT_EQ(contacts.size() > TriangleContacts::k_capacity, cell < 0.1);
    const MeshManifolds first = joined(contacts, pose);
    EXPECT_GT(first.count, 0U);
    for (int i = 0; i < 20; ++i) {
      for (std::size_t k = contacts.size() - 1; k > 0; --k)
        std::swap(
            contacts[k],
            contacts[static_cast<std::size_t>(dice.between(0, static_cast<std::int64_t>(k)))]);
      ASSERT_TRUE(are_identical(joined(contacts, pose), first));
    }
  }
}

TEST(MeshContacts, KeepSurfacesApart) {
  Triangles soup = grid(3, 2, 1, [](int, int) { return 0.0; });
  const std::vector<std::uint8_t> indices{0, 0, 1, k_own_surface};
  const std::vector<Surface> surfaces{Surface{{}, {}}, Surface{unit(1), {}}};
  MeshDef def = soup.def();
  def.triangle_surfaces = indices;
  def.surfaces = surfaces;
  const auto mesh = Mesh::build(def).mesh;
  // Four contacts at will: one a triangle.
  const Pose pose{Shape::box(metres(1), metres(0.5), metres(0.5)), {}, metres(1, 0.5, 0.5)};
  std::vector<TriangleContact> contacts;
  for (const SeenPart& part : all_parts(*mesh)) {
    TriangleContact contact =
        contact_with(part.index, part.vertices, part.topology.active_edges, part.surface);
    contact.manifold.normal = {{}, unit(1), {}};
    const RealVec centre =
        (real(part.vertices[0]) + real(part.vertices[1]) + real(part.vertices[2])) * (Real{1} / 3);
    geometry::add_point(contact.manifold, {fine_of(centre), fine_of(centre)}, pose.at, -1000,
                        pose.margin, 1);
    contacts.push_back(contact);
  }
  const MeshManifolds result = joined(contacts, pose);
  ASSERT_EQ(result.count, 3U);
  EXPECT_EQ(result.manifolds[0].surface, nullptr);
  EXPECT_NE(result.manifolds[1].key, result.manifolds[2].key);
  EXPECT_NE(result.manifolds[1].surface->friction, result.manifolds[2].surface->friction);
}

TEST(MeshContacts, KeepTheDeepestGroupsBeyondTheCapacity) {
  // Spikes around a point: every face its own plane.
  std::vector<TriangleContact> contacts;
  const Pose pose{Shape::sphere(metres(1))};
  for (std::uint32_t i = 0; i < 20; ++i) {
    const double angle = 0.3 * i;
    const RealVec n{std::cos(angle), std::sin(angle), 0};
    const RealVec side{-n.y, n.x, 0};
    const auto vertex = [&](Real along, Real up) {
      const RealVec v = n * Real{-0.9} + side * along + RealVec{0, 0, up};
      return metres(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
    };
    TriangleContact contact =
        contact_with(i, {vertex(-0.1L, 0), vertex(0.1L, 0), vertex(0, 0.1L)}, 7);
    contact.manifold = collide_sphere_front(contact.vertices, pose);
    ASSERT_EQ(contact.manifold.count, 1);
    contact.manifold.points[0].separation =
        Displacement::from_raw(-1000 * static_cast<std::int32_t>((i * 7) % 20));
    contacts.push_back(contact);
  }
  const MeshManifolds result = joined(contacts, pose);
  ASSERT_EQ(result.count, MeshManifolds::k_capacity);
  EXPECT_EQ(result.left_out, 20 - MeshManifolds::k_capacity);
  for (std::size_t i = 0; i < result.count; ++i) {
    EXPECT_LE(geometry::least_separation(result.manifolds[i].manifold),
              Displacement::from_raw(-12000));
    if (i > 0) {
      EXPECT_LT(result.manifolds[i - 1].key, result.manifolds[i].key);
    }
  }
}

TEST(MeshContacts, OverlappingGhostsAloneLeaveTheDeepest) {
  // An inner edge whose neighbour is not in the list.
  TriangleContact contact = contact_with(3, {metres(0, 0, 0), metres(0, 0, 1), metres(1, 0, 1)}, 0);
  const Pose pose{Shape::sphere(metres(0.3)), {}, metres(-0.2, 0.1, 0.5)};
  contact.manifold = collide_sphere_front(contact.vertices, pose);
  ASSERT_EQ(contact.manifold.count, 1);
  const MeshManifolds result = joined({contact}, pose);
  ASSERT_EQ(result.count, 1U);
  EXPECT_EQ(result.manifolds[0].manifold.normal, contact.manifold.normal);
  Pose apart = pose;
  apart.at = metres(-0.3, 0.1, 0.5);
  contact.manifold = collide_sphere_front(contact.vertices, apart);
  ASSERT_EQ(contact.manifold.count, 1);
  EXPECT_EQ(joined({contact}, apart).count, 0U);
}

}  // namespace
}  // namespace lockstone::test
