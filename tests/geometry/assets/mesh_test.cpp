#include <algorithm>
#include <bit>

#include <gtest/gtest.h>

#include <lockstone/hash.h>

#include "core/geometry/convex/asset_geometry.h"
#include "tests/geometry/assets/asset_parts.h"

namespace lockstone::test {
namespace {

using geometry::LocalBounds;

std::shared_ptr<const Mesh> built(const MeshDef& def) {
  const MeshResult result = Mesh::build(def);
  EXPECT_TRUE(result.ok()) << to_string(result.fault);
  return result.mesh;
}

int count_active(const Mesh& mesh) {
  int active = 0;
  for (const SeenPart& part : all_parts(mesh))
    active += std::popcount(part.topology.active_edges);
  return active;
}

MeshFault mesh_fault_of(const MeshDef& def) {
  return Mesh::build(def).fault;
}

TEST(Mesh, MakesTheTwelveEdgesOfACubeActiveAndNotItsDiagonals) {
  const auto mesh = built(cube(1).def());
  EXPECT_EQ(mesh->triangle_count(), 12U);
  EXPECT_EQ(mesh->vertex_count(), 8U);
  EXPECT_EQ(count_active(*mesh), 24);  // each edge from both sides
  for (const SeenPart& part : all_parts(*mesh)) {
    EXPECT_EQ(std::popcount(part.topology.active_edges), 2);
    EXPECT_EQ(part.topology.active_vertices, 7);
    EXPECT_TRUE(part.topology.is_triangle);
  }
}

TEST(Mesh, HasNoActiveEdgeInsideACube) {
  EXPECT_EQ(count_active(*built(cube(1, true).def())), 0);
}

TEST(Mesh, MakesOnlyTheBorderOfAFlatGridActive) {
  const Triangles flat = grid(6, 5, 0.5, [](int, int) { return 0.0; });
  EXPECT_EQ(count_active(*built(flat.def())), 2 * (5 + 4));
}

TEST(Mesh, TakesConvexEdgesWithinTheFlatAngleAsFlat) {
  // A roof whose faces meet at 0.1 rad.
  const Triangles roof = grid(3, 2, 1, [](int i, int) { return i == 1 ? 0.05 : 0.0; });
  MeshDef def = roof.def();
  def.flat_angle = Angle::from_ratio(11, 100);
  const int flat = count_active(*built(def));
  def.flat_angle = Angle::from_ratio(9, 100);
  EXPECT_EQ(count_active(*built(def)), flat + 2);
  const Triangles valley = grid(3, 2, 1, [](int i, int) { return i == 1 ? -0.05 : 0.0; });
  MeshDef concave = valley.def();
  concave.flat_angle = {};
  EXPECT_EQ(count_active(*built(concave)), flat);
}

TEST(Mesh, MakesTheLeastConvexEdgeActiveWhenTheFlatAngleIsZero) {
  const auto with_middle = [](Length height) {
    Triangles roof = grid(3, 2, 1, [](int, int) { return 0.0; });
    for (Vec3<Length>& v : roof.vertices)
      if (v.x == metres(1)) v.y = height;
    MeshDef def = roof.def();
    def.flat_angle = {};
    return count_active(*built(def));
  };
  EXPECT_EQ(with_middle(Length::from_raw(1)), with_middle({}) + 2);
  EXPECT_EQ(with_middle(Length::from_raw(-1)), with_middle({}));
}

TEST(Mesh, MakesEdgesOfThreeTrianglesAndOfASheetActive) {
  Triangles fan;
  fan.vertices = {metres(0, 0, 0), metres(0, 0, 1), metres(1, 0, 0), metres(-1, 0, 0),
                  metres(0, 1, 0)};
  fan.triangles = {{0, 1, 2}, {1, 0, 3}, {0, 1, 4}};
  EXPECT_EQ(count_active(*built(fan.def())), 9);
  fan.triangles = {{0, 1, 2}, {0, 2, 1}};
  EXPECT_EQ(count_active(*built(fan.def())), 6);
  fan.triangles = {{0, 1, 2}, {0, 1, 3}};  // not turned the same way
  EXPECT_EQ(count_active(*built(fan.def())), 6);
}

TEST(Mesh, WeldsVerticesWithinTheTolerance) {
  Triangles soup = grid(4, 4, 1, [](int, int) { return 0.0; });
  Triangles loose;
  Dice dice;
  for (const TriangleIndices& t : soup.triangles) {
    const auto first = static_cast<std::uint32_t>(loose.vertices.size());
    for (const std::uint32_t v : {t.a, t.b, t.c}) {
      Vec3<Length> moved = soup.vertices[v];
      for (int axis = 0; axis < 3; ++axis)
        moved[axis].raw += static_cast<std::int32_t>(dice.between(0, 10));
      loose.vertices.push_back(moved);
    }
    loose.triangles.push_back({first, first + 1, first + 2});
  }
  MeshDef def = loose.def();
  def.weld_tolerance = Length::from_raw(10);
  MeshResult result = Mesh::build(def);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result.mesh->vertex_count(), 16U);
  EXPECT_EQ(result.welded_vertices, 54U - 16U);
  EXPECT_EQ(result.mesh->triangle_count(), 18U);
}

TEST(Mesh, LeavesNoTwoVerticesWithinTheTolerance) {
  Dice dice;
  Triangles soup = random_triangles(dice, 200, 1, 1);
  MeshDef def = soup.def();
  def.weld_tolerance = metres(0.1);
  const auto mesh = built(def);
  std::vector<Vec3<Length>> vertices;
  for (const SeenPart& part : all_parts(*mesh))
    vertices.insert(vertices.end(), part.vertices.begin(), part.vertices.end());
  ASSERT_FALSE(vertices.empty());
  for (const Vec3<Length>& a : vertices) {
    for (const Vec3<Length>& b : vertices) {
      const Vec3<Length> d = a - b;
      const Length apart = max(max(abs(d.x), abs(d.y)), abs(d.z));
      ASSERT_TRUE(a == b || apart > def.weld_tolerance);
    }
  }
}

TEST(Mesh, DropsAndCountsTrianglesWithoutAreaAndRepeats) {
  Triangles soup;
  soup.vertices = {metres(0, 0, 0), metres(1, 0, 0), metres(2, 0, 0), metres(0, 0, 1)};
  soup.triangles = {{0, 3, 1}, {0, 1, 2}, {3, 1, 0}, {1, 1, 2}, {0, 1, 3}};
  const MeshResult result = Mesh::build(soup.def());
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result.mesh->triangle_count(), 2U);  // one from either side
  EXPECT_EQ(result.degenerate_triangles, 2U);
  EXPECT_EQ(result.duplicate_triangles, 1U);
  soup.triangles = {{0, 1, 2}};
  EXPECT_EQ(mesh_fault_of(soup.def()), MeshFault::empty);
}

TEST(Mesh, KeepsATriangleOfTheLeastArea) {
  Triangles soup;
  soup.vertices = {metres(-512, 0, 0), metres(512, 0, 0), {{}, Length::from_raw(1), {}}};
  soup.triangles = {{0, 1, 2}};
  const auto mesh = built(soup.def());
  const auto parts = all_parts(*mesh);
  ASSERT_EQ(parts.size(), 1U);
}

TEST(Mesh, OfNothingIsRefused) {
  EXPECT_EQ(mesh_fault_of({}), MeshFault::empty);
}

TEST(Mesh, WithAnIndexOutOfRangeIsRefusedAndNamesTheTriangle) {
  Triangles bad = cube(1);
  bad.triangles[7].b = 8;
  const MeshResult result = Mesh::build(bad.def());
  EXPECT_FALSE(result.ok());
  EXPECT_EQ(result.fault, MeshFault::index_out_of_range);
  EXPECT_EQ(result.index, 7U);
}

TEST(Mesh, WithACoordinateOutOfRangeIsRefusedAndNamesTheVertex) {
  Triangles bad = cube(1);
  bad.vertices[3].z = k_max_asset_coordinate + Length::from_raw(1);
  const MeshResult result = Mesh::build(bad.def());
  EXPECT_EQ(result.fault, MeshFault::coordinate_out_of_range);
  EXPECT_EQ(result.index, 3U);
}

TEST(Mesh, WithAnInvalidOptionIsRefused) {
  const Triangles good = cube(1);
  MeshDef def = good.def();
  def.weld_tolerance = Length::from_raw(-1);
  EXPECT_EQ(mesh_fault_of(def), MeshFault::invalid_option);
  def = good.def();
  def.flat_angle = Angle::from_integer(2);
  EXPECT_EQ(mesh_fault_of(def), MeshFault::invalid_option);
}

TEST(Mesh, WithASurfaceOutOfRangeOrAnInvalidOneIsRefused) {
  const Triangles good = cube(1);
  const std::vector<std::uint8_t> indices(12, 1);
  const std::vector<Surface> one(1);
  MeshDef def = good.def();
  def.triangle_surfaces = indices;
  def.surfaces = one;
  EXPECT_EQ(mesh_fault_of(def), MeshFault::surface_out_of_range);
  const std::vector<Surface> slippery(2, Surface{Coefficient::from_raw(-1), {}});
  def.surfaces = slippery;
  EXPECT_EQ(mesh_fault_of(def), MeshFault::invalid_surface);
}

TEST(Mesh, WithTooManyTrianglesIsRefused) {
  const Triangles good = cube(1);
  const std::vector<TriangleIndices> many(k_max_mesh_triangles + 1);
  MeshDef def = good.def();
  def.triangles = many;
  EXPECT_EQ(mesh_fault_of(def), MeshFault::too_many);
  EXPECT_EQ(to_string(MeshFault::too_many), "too many triangles, vertices or surfaces");
}

TEST(Mesh, DoesNotDependOnTheOrderOfItsDefinition) {
  Dice dice;
  Triangles soup = random_triangles(dice, 300, 10, 1);
  std::vector<std::uint8_t> indices;
  for (int i = 0; i < 300; ++i)
    indices.push_back(static_cast<std::uint8_t>(dice.between(0, 2)));
  const std::vector<Surface> surfaces(3);
  const auto mesh_of = [&](const Triangles& t, const std::vector<std::uint8_t>& s) {
    MeshDef def = t.def();
    def.triangle_surfaces = s;
    def.surfaces = surfaces;
    return built(def);
  };
  const auto mesh = mesh_of(soup, indices);
  Triangles shuffled;
  shuffled.vertices.assign(soup.vertices.rbegin(), soup.vertices.rend());
  const auto last = static_cast<std::uint32_t>(soup.vertices.size()) - 1;
  for (auto t = soup.triangles.rbegin(); t != soup.triangles.rend(); ++t)
    shuffled.triangles.push_back({last - t->b, last - t->c, last - t->a});
  const auto other = mesh_of(shuffled, {indices.rbegin(), indices.rend()});
  EXPECT_EQ(mesh->id(), other->id());
  EXPECT_EQ(mesh->canonical_bytes(), other->canonical_bytes());
  const auto a = all_parts(*mesh);
  const auto b = all_parts(*other);
  ASSERT_EQ(a.size(), b.size());
  for (std::size_t i = 0; i < a.size(); ++i) {
    EXPECT_EQ(a[i].vertices, b[i].vertices);
    EXPECT_EQ(a[i].surface - b[i].surface, a[0].surface - b[0].surface);
  }
}

TEST(Mesh, ReturnsFromItsBytes) {
  Dice dice;
  Triangles soup = random_triangles(dice, 100, 10, 1);
  const std::vector<std::uint8_t> indices(100, 2);
  const std::vector<Surface> surfaces(3, Surface{Coefficient::from_ratio(1, 8), {}});
  MeshDef def = soup.def();
  def.triangle_surfaces = indices;
  def.surfaces = surfaces;
  const auto mesh = built(def);
  const auto bytes = mesh->canonical_bytes();
  EXPECT_EQ(mesh->id().value, hash64(bytes));
  const auto back = Mesh::from_bytes(bytes);
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(back.value()->id(), mesh->id());
  EXPECT_EQ(back.value()->canonical_bytes(), bytes);
  EXPECT_EQ(all_parts(*back.value())[5].surface->friction, Coefficient::from_ratio(1, 8));
  EXPECT_EQ(mesh->geometry().solid(), nullptr);
}

TEST(Mesh, AnswersBadBytesWithAnError) {
  Dice dice;
  const auto mesh = built(cube(1).def());
  const auto bytes = mesh->canonical_bytes();
  for (std::size_t size = 0; size < bytes.size(); ++size)
    ASSERT_EQ(Mesh::from_bytes(ByteView(bytes).first(size)).status(), Status::truncated);
  auto longer = bytes;
  longer.push_back({});
  EXPECT_EQ(Mesh::from_bytes(longer).status(), Status::malformed);
  int refused = 0;
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    auto bad = bytes;
    bad[bit / 8] ^= static_cast<std::byte>(1 << (bit % 8));
    const auto result = Mesh::from_bytes(bad);
    refused += result.ok() ? 0 : 1;
    if (result.ok()) {
      ASSERT_EQ(result.value()->canonical_bytes(), bad);
    }
  }
  EXPECT_GT(refused, 0);
  for (int i = 0; i < 2000; ++i) {
    auto bad = bytes;
    for (int k = 0; k < 4; ++k) {
      const auto at = dice.between(0, static_cast<std::int64_t>(bad.size()) - 1);
      bad[static_cast<std::size_t>(at)] = static_cast<std::byte>(dice.next());
    }
    (void)Mesh::from_bytes(bad);
  }
}

TEST(Mesh, ShowsThePartsOfARegionInOrder) {
  Dice dice;
  const auto mesh = built(random_triangles(dice, 500, 20, 2).def());
  const auto all = all_parts(*mesh);
  ASSERT_EQ(all.size(), mesh->triangle_count());
  for (int i = 0; i < 200; ++i) {
    const LocalBounds region = random_region(dice, 20, 10);
    CollectParts collect;
    mesh->geometry().visit_parts(region, collect);
    std::vector<std::uint32_t> expected;
    for (const SeenPart& part : all)
      if (overlap(geometry::bounds_of(part.vertices), region)) expected.push_back(part.index);
    ASSERT_EQ(collect.parts.size(), expected.size());
    for (std::size_t k = 0; k < expected.size(); ++k)
      ASSERT_EQ(collect.parts[k].index, expected[k]);
  }
}

TEST(Mesh, ShowsEveryPartWhoseBoundsARayMeets) {
  Dice dice;
  const auto mesh = built(random_triangles(dice, 500, 20, 2).def());
  const auto all = all_parts(*mesh);
  for (int i = 0; i < 300; ++i) {
    const Vec3<Length> origin = random_region(dice, 40, 1).lower;
    const Vec3<Length> way = random_region(dice, 60, 1).lower;
    CollectRayParts collect;
    mesh->geometry().visit_parts_on_way(origin, way, {}, collect);
    std::sort(collect.parts.begin(), collect.parts.end());
    for (const SeenPart& part : all) {
      const bool found = std::binary_search(collect.parts.begin(), collect.parts.end(), part.index);
      ASSERT_TRUE(found || !surely_meets(origin, way, geometry::bounds_of(part.vertices)));
    }
  }
}

// Calls `check` with the polytope of each triangle of a random mesh.
template <class Check>
void for_random_triangles(const Check& check) {
  struct Visitor final : geometry::PartVisitor {
    explicit Visitor(const Check& visited) : check(visited) {}
    void visit(const geometry::Part& part) override {
      EXPECT_EQ(part.shape.kind, ShapeKind::hull);
      check(*part.polytope);
    }
    const Check& check;
  } visitor(check);
  Dice dice;
  const auto mesh = built(random_triangles(dice, 200, 500, 10).def());
  mesh->geometry().visit_parts(mesh->geometry().bounds(), visitor);
}

TEST(Mesh, ShowsTrianglesAsPolytopesOfTwoFaces) {
  for_random_triangles([](const geometry::Polytope& p) {
    ASSERT_EQ(p.vertices.size(), 3U);
    ASSERT_EQ(p.faces.size(), 2U);
    ASSERT_EQ(p.edges.size(), 6U);
  });
}

TEST(Mesh, EdgesOfAShownTriangleHaveTheirTwinOnTheOtherFace) {
  for_random_triangles([](const geometry::Polytope& p) {
    for (std::uint16_t e = 0; e < 6; ++e) {
      const geometry::HalfEdge& edge = p.edges[e];
      const geometry::HalfEdge& twin = p.edges[edge.twin];
      EXPECT_EQ(twin.twin, e);
      EXPECT_NE(twin.face, edge.face);
      EXPECT_EQ(p.edges[next_edge(p, e)].origin, twin.origin);
    }
  });
}

TEST(Mesh, FacesOfAShownTriangleLieAsHighAsItsHighestVertex) {
  for_random_triangles([](const geometry::Polytope& p) {
    for (const geometry::PolytopeFace& face : p.faces) {
      std::int64_t greatest = std::numeric_limits<std::int64_t>::min();
      for (const Vec3<Length>& v : p.vertices)
        greatest = std::max(greatest, dot(face.normal, v).raw);
      EXPECT_EQ(face.offset, greatest);
    }
  });
}

TEST(Mesh, TheFirstFaceOfAShownTriangleHasItsNormal) {
  for_random_triangles([](const geometry::Polytope& p) {
    const RealVec a = real(p.vertices[0]);
    const RealVec n = cross(real(p.vertices[1]) - a, real(p.vertices[2]) - a);
    EXPECT_NEAR(static_cast<double>(norm(real(p.faces[0].normal) - n * (1 / norm(n)))), 0, 2e-9);
  });
}

}  // namespace
}  // namespace lockstone::test
