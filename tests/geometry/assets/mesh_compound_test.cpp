// Compounds with meshes: joined triangles, numbers of parts, bytes, refusals.
#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/load_asset.h>
#include <lockstone/shape_pair.h>

#include "core/geometry/convex/solid.h"
#include "tests/geometry/assets/asset_parts.h"
#include "tests/support/random.h"
#include "tests/support/sample_level.h"

namespace lockstone {
namespace {

using namespace literals;
using geometry::TriangleVertices;

CompoundFault fault_of(std::span<const CompoundChild> children) {
  return Compound::build(children).fault;
}

/// By index of part.
class CollectKinds final : public geometry::PartVisitor {
 public:
  CollectKinds() : PartVisitor(true) {}

  std::vector<std::pair<std::uint32_t, bool>> parts;  ///< number, whether it is a triangle
  void visit(const geometry::Part& part) override {
    parts.emplace_back(part.index, part.triangle.is_triangle);
  }
};

TriangleVertices from_lowest(TriangleVertices t) {
  const auto key = [](const Vec3<Length>& v) { return std::tuple(v.x, v.y, v.z); };
  std::rotate(t.begin(), std::ranges::min_element(t, {}, key), t.end());
  return t;
}

TEST(MeshCompound, NumbersConvexChildrenThenTriangles) {
  const auto level = test::sample_level();
  ASSERT_NE(level, nullptr);
  CollectKinds seen;
  level->geometry().visit_parts(level->geometry().bounds(), seen);
  std::vector<std::pair<std::uint32_t, bool>> expected{{1, false}, {3, false}};
  for (std::uint32_t i = 0; i < 8; ++i)
    expected.emplace_back(k_first_compound_triangle + i, true);
  EXPECT_EQ(seen.parts, expected);
}

// Each triangle of a child's mesh is there once, where the child's frame puts it.
TEST(MeshCompound, FindsTheChildAndTheTriangleOfEachPart) {
  const auto level = test::sample_level();
  const AssetPtr panels = test::sample_panels();
  const std::vector<test::SeenPart> of_mesh = test::all_parts(*panels);
  std::vector<CompoundPart> found;
  test::CollectParts seen;
  const geometry::AssetGeometry& joined = *level->geometry().triangles();
  joined.visit_parts(joined.bounds(), seen);
  for (const test::SeenPart& part : seen.parts) {
    const std::optional<CompoundPart> origin = level->find_part(part.index);
    ASSERT_TRUE(origin);
    found.push_back(*origin);
    TriangleVertices own = of_mesh[origin->triangle].vertices;
    if (origin->child == 2) {
      for (Vec3<Length>& v : own)
        v = {4_m - v.x, v.y, 1_m - v.z};
    }
    EXPECT_EQ(from_lowest(own), from_lowest(part.vertices)) << part.index;
  }
  std::ranges::sort(found, {},
                    [](const CompoundPart& p) { return std::pair(p.child, p.triangle); });
  std::vector<CompoundPart> all;
  for (const std::uint32_t child : {0U, 2U})
    for (std::uint32_t i = 0; i < 4; ++i)
      all.push_back({child, i});
  EXPECT_EQ(found, all);
  EXPECT_EQ(level->find_part(1), (CompoundPart{1, 0}));
  EXPECT_EQ(level->find_part(0), std::nullopt);  // a mesh: its triangles are parts
  EXPECT_EQ(level->find_part(4), std::nullopt);
  EXPECT_EQ(level->find_part(k_first_compound_triangle + 8), std::nullopt);
}

TEST(MeshCompound, OfConvexChildrenFindsThem) {
  const AssetPtr asset = test::sample_compound();
  const auto& compound = static_cast<const Compound&>(*asset);
  EXPECT_EQ(compound.find_part(1), (CompoundPart{1, 0}));
  EXPECT_EQ(compound.find_part(2), std::nullopt);
  EXPECT_EQ(compound.find_part(k_first_compound_triangle), std::nullopt);
}

// Flat edges between the two meshes are no edges; the rims are.
TEST(MeshCompound, JoinsMeshesThatMeet) {
  const auto edges = [](const Compound& compound) {
    int count = 0;
    test::CollectParts seen;
    const geometry::AssetGeometry& joined = *compound.geometry().triangles();
    joined.visit_parts(joined.bounds(), seen);
    for (const test::SeenPart& part : seen.parts)
      count += std::popcount(part.topology.active_edges);
    return count;
  };
  EXPECT_EQ(edges(*test::sample_level()), 2 * 4 + 2);  // the outline of four panels in a row
  auto apart = test::sample_level_children();
  apart[2].position.y = 1_m;
  EXPECT_EQ(edges(*Compound::build(apart).compound), 2 * (2 * 2 + 2));
}

TEST(MeshCompound, HasRepeatedTrianglesOnce) {
  const std::array<CompoundChild, 2> twice{test::child_of(test::sample_panels()),
                                           test::child_of(test::sample_panels())};
  const CompoundResult built = Compound::build(twice);
  ASSERT_TRUE(built.ok());
  test::CollectParts seen;
  built.compound->geometry().visit_parts(built.compound->geometry().bounds(), seen);
  EXPECT_EQ(seen.parts.size(), 4U);
  for (const test::SeenPart& part : seen.parts)
    EXPECT_EQ(built.compound->find_part(part.index)->child, 0U);
}

TEST(MeshCompound, GivesItsSurfaceToTrianglesWithoutOne) {
  const AssetPtr mesh = test::sample_mesh();  // surfaces 0, own, 0
  std::array<CompoundChild, 1> children{test::child_of(mesh)};
  children[0].surface = Surface{0.25_r, {}};
  const CompoundResult built = Compound::build(children);
  ASSERT_TRUE(built.ok());
  test::CollectParts seen;
  built.compound->geometry().visit_parts(built.compound->geometry().bounds(), seen);
  const std::vector<test::SeenPart> own = test::all_parts(*mesh);
  ASSERT_EQ(seen.parts.size(), own.size());
  for (const test::SeenPart& part : seen.parts) {
    const Surface* of_mesh = own[built.compound->find_part(part.index)->triangle].surface;
    EXPECT_EQ(*part.surface, of_mesh == nullptr ? *children[0].surface : *of_mesh);
  }
}

TEST(MeshCompound, HasNoMass) {
  EXPECT_EQ(test::sample_level()->geometry().solid(), nullptr);
  EXPECT_NE(test::sample_compound()->geometry().solid(), nullptr);
}

TEST(MeshCompound, ComesBackFromItsBytes) {
  const auto level = test::sample_level();
  const std::vector<std::byte> bytes = level->canonical_bytes();
  const AssetSet known({test::sample_panels()});
  const Result<AssetPtr> loaded = load_asset(bytes, known);
  ASSERT_TRUE(loaded.ok());
  EXPECT_EQ(loaded.value()->id(), level->id());
  EXPECT_EQ(loaded.value()->canonical_bytes(), bytes);
  EXPECT_EQ(load_asset(bytes).status(), Status::not_found);
  test::Random random(20261127);
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::vector<std::byte> flipped = bytes;
    flipped[i] ^= static_cast<std::byte>(1 << random.between(0, 7));
    const Result<AssetPtr> other = load_asset(flipped, known);
    if (other.ok()) {
      EXPECT_EQ(other.value()->canonical_bytes(), flipped) << i;
    }
  }
}

TEST(MeshCompound, IsRefusedWithTheReason) {
  const AssetPtr panels = test::sample_panels();
  std::array<CompoundChild, 1> one{test::child_of(panels)};
  one[0].asset = nullptr;
  EXPECT_EQ(fault_of(one), CompoundFault::missing_asset);
  one[0] = test::child_of(panels);
  one[0].shape.kind = ShapeKind::hull;
  EXPECT_EQ(fault_of(one), CompoundFault::missing_asset);
  one[0] = test::child_of(test::sample_height_field());
  EXPECT_EQ(fault_of(one), CompoundFault::invalid_shape);
  one[0] = test::child_of(test::sample_level());
  EXPECT_EQ(fault_of(one), CompoundFault::invalid_shape);
  one[0] = test::child_of(panels, {511_m, {}, {}});
  EXPECT_EQ(fault_of(one), CompoundFault::coordinate_out_of_range);
  EXPECT_EQ(fault_of(test::sample_level_children()), CompoundFault::none);
}

TEST(MeshCompound, IsRefusedWhereTheTrianglesVanish) {
  const std::array<Vec3<Length>, 3> sliver{
      Vec3<Length>{}, {1_m, {}, {}}, {1_m, Length::from_raw(1), {}}};
  const std::array<TriangleIndices, 1> triangle{TriangleIndices{0, 1, 2}};
  MeshDef def;
  def.vertices = sliver;
  def.triangles = triangle;
  std::array<CompoundChild, 1> one{test::child_of(Mesh::build(def).mesh)};
  EXPECT_EQ(fault_of(one), CompoundFault::none);
  test::Random random(20261127);
  int vanished = 0;
  for (int i = 0; i < 400; ++i) {
    for (Unit* c : {&one[0].orientation.x, &one[0].orientation.y, &one[0].orientation.z,
                    &one[0].orientation.w})
      c->raw = static_cast<std::int32_t>(random.between(-(1 << 30), 1 << 30));
    const CompoundFault fault = fault_of(one);
    EXPECT_TRUE(fault == CompoundFault::none || fault == CompoundFault::no_triangles);
    if (fault == CompoundFault::no_triangles) ++vanished;
  }
  EXPECT_GT(vanished, 0);
  EXPECT_LT(vanished, 400);
}

// Surfaces that are equal are one; more than 255 different ones are too many.
TEST(MeshCompound, IsRefusedWithTooManySurfaces) {
  const auto with_surfaces = [](int first, int count) {
    std::vector<Surface> surfaces;
    test::Triangles strip;
    std::vector<std::uint8_t> of_triangles;
    for (int i = 0; i < count; ++i) {
      Surface surface;
      surface.tag = static_cast<std::uint32_t>(first + i);
      surfaces.push_back(surface);
      const auto base = static_cast<std::uint32_t>(strip.vertices.size());
      strip.vertices.push_back({Length::from_integer(i), {}, {}});
      strip.vertices.push_back({Length::from_integer(i), {}, 1_m});
      strip.vertices.push_back({Length::from_integer(i + 1), {}, {}});
      strip.triangles.push_back({base, base + 1, base + 2});
      of_triangles.push_back(static_cast<std::uint8_t>(i));
    }
    MeshDef def = strip.def();
    def.surfaces = surfaces;
    def.triangle_surfaces = of_triangles;
    return Mesh::build(def).mesh;
  };
  std::array<CompoundChild, 2> two{test::child_of(with_surfaces(0, 200)),
                                   test::child_of(with_surfaces(0, 200), {{}, 1_m, {}})};
  EXPECT_EQ(fault_of(two), CompoundFault::none);
  two[1] = test::child_of(with_surfaces(145, 110), {{}, 1_m, {}});  // 0 … 254
  EXPECT_EQ(fault_of(two), CompoundFault::none);
  two[1] = test::child_of(with_surfaces(146, 110), {{}, 1_m, {}});  // 0 … 255
  const CompoundResult refused = Compound::build(two);
  EXPECT_EQ(refused.fault, CompoundFault::too_many_surfaces);
  EXPECT_EQ(refused.child, 1U);
}

// One without an inside is the second shape of a pair, and moves in none.
TEST(MeshCompound, TakesPartInPairsOfShapesAsAMeshDoes) {
  const auto level = test::sample_level();
  const ShapeAt here{level->shape(), {}, level.get()};
  const ShapeAt ball{Shape::sphere(0.25_m), {{2.5_m, 1_m, 0.5_m}, {}}, nullptr};
  const Result<ShapeDistance> gap = shape_distance(here, ball, 2_m);
  ASSERT_TRUE(gap.ok());
  EXPECT_NEAR(static_cast<double>(gap.value().distance.raw) / 4294967296.0, 0.75, 1e-5);
  EXPECT_EQ(level->find_part(gap.value().part_a)->child, 2U);
  EXPECT_FALSE(shape_distance(here, here, 2_m).ok());
  EXPECT_FALSE(shape_impact({here, {}}, {ball, {}}, 0.01_m).ok());
  const Result<ShapeImpact> hit = shape_cast(here, ball, {{}, -2_m, {}});
  ASSERT_TRUE(hit.ok());
  EXPECT_TRUE(hit.value().hit);
  std::array<ShapeManifold, 4> manifolds;
  const Result<std::size_t> count = shape_contacts(here, ball, 1_m, manifolds);
  ASSERT_TRUE(count.ok());
  ASSERT_EQ(count.value(), 1U);
  EXPECT_GT(manifolds[0].normal.y, 0.99_r);
}

}  // namespace
}  // namespace lockstone
