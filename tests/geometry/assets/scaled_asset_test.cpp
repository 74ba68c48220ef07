// Scaled copies against assets that are built from scaled coordinates.
#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/literals.h>
#include <lockstone/scaled_asset.h>

#include "core/geometry/assets/height_field_geometry.h"
#include "core/geometry/assets/mesh_geometry.h"

namespace lockstone {
namespace {

using namespace literals;

constexpr Number k_one = Number::from_integer(1);

Vec3<Number> by(double x, double y, double z) {
  const auto raw = [](double f) {
    return Number::from_raw(static_cast<std::int32_t>(std::lround(f * (1 << 20))));
  };
  return {raw(x), raw(y), raw(z)};
}

// The product in floating point with 64 bits of precision, which holds it exactly; llround rounds
// ties away from zero.
Length reference(Length x, Number factor) {
  const long double product = static_cast<long double>(x.raw) * factor.raw / (1 << 20);
  return Length::from_raw(static_cast<std::int32_t>(std::llround(product)));
}

Vec3<Length> reference(const Vec3<Length>& v, const Vec3<Number>& factors) {
  return {reference(v.x, factors.x), reference(v.y, factors.y), reference(v.z, factors.z)};
}

std::vector<Vec3<Length>> box_points() {
  std::vector<Vec3<Length>> points;
  for (int i = 0; i < 8; ++i)
    points.push_back({Length::from_ratio(i & 1 ? 7 : -3, 7), Length::from_ratio(i & 2 ? 5 : -5, 3),
                      Length::from_ratio(i & 4 ? 1 : 0, 1)});
  return points;
}

// A tetrahedron whose fronts look outward, with two surfaces and two groups.
const std::vector<Vec3<Length>> k_corners{{}, {1_m, {}, {}}, {{}, 1_m, {}}, {{}, {}, 1_m}};
const std::vector<TriangleIndices> k_sides{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
const std::vector<std::uint8_t> k_side_surfaces{0, 1, 0, k_own_surface};
const std::vector<std::uint16_t> k_side_groups{0, 1, 1, 0};
const std::vector<Surface> k_surfaces(2);

MeshDef tetrahedron() {
  MeshDef def;
  def.vertices = k_corners;
  def.triangles = k_sides;
  def.triangle_surfaces = k_side_surfaces;
  def.surfaces = k_surfaces;
  def.triangle_groups = k_side_groups;
  return def;
}

// Six times the volume that the fronts surround, m³: negative where they look inward.
double six_volumes(const Mesh& mesh) {
  const geometry::MeshData& data = geometry::mesh_data(mesh.geometry());
  double sum = 0;
  for (std::uint32_t i = 0; i < mesh.triangle_count(); ++i) {
    const auto t = data.triangle(i);
    std::array<std::array<double, 3>, 3> p{};
    for (std::size_t k = 0; k < 3; ++k)
      for (int axis = 0; axis < 3; ++axis)
        p[k][static_cast<std::size_t>(axis)] = std::ldexp(t[k][axis].raw, -20);
    sum += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) -
           p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) +
           p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
  }
  return sum;
}

const std::vector<Length> k_heights{0.1_m, 0.7_m, -0.3_m, 1.1_m, 0.5_m, 0.9_m};
const std::vector<std::uint8_t> k_cell_surfaces{1, k_own_surface};
const std::vector<std::uint8_t> k_holes{0, 1};

HeightFieldDef hills() {
  HeightFieldDef def;
  def.columns = 3;
  def.rows = 2;
  def.origin = {-1_m, 2_m, 0.5_m};
  def.cell_x = 0.3_m;
  def.cell_z = 0.7_m;
  def.heights = k_heights;
  def.holes = k_holes;
  def.cell_surfaces = k_cell_surfaces;
  def.surfaces = k_surfaces;
  return def;
}

TEST(ScaledAsset, IsTheSameWithFactorsOfOne) {
  const Vec3<Number> same{k_one, k_one, k_one};
  HullOptions options = HullOptions::rounded(0.1_m, 8);
  options.tolerance = 0.01_m;
  const HullResult round = Hull::build(box_points(), options);
  const HullResult plain = Hull::build(box_points());
  ASSERT_TRUE(round.ok() && plain.ok());
  EXPECT_EQ(scaled(*round.hull, same).hull->id(), round.hull->id());
  EXPECT_EQ(scaled(*plain.hull, same).hull->id(), plain.hull->id());
  const MeshResult mesh = Mesh::build(tetrahedron());
  ASSERT_TRUE(mesh.ok());
  EXPECT_EQ(scaled(*mesh.mesh, same).mesh->id(), mesh.mesh->id());
  const HeightFieldResult field = HeightField::build(hills());
  ASSERT_TRUE(field.ok());
  EXPECT_EQ(scaled(*field.height_field, same).height_field->id(), field.height_field->id());
}

TEST(ScaledAsset, HasTheIdOfAHullOfScaledPoints) {
  const HullResult hull = Hull::build(box_points());
  for (const Vec3<Number>& factors :
       {by(2, 3, 5), by(0.1, 1.7, 33.3), by(-1, 1, 1), by(-0.37, -2.1, -0.9), by(0.0123, 100, 1)}) {
    std::vector<Vec3<Length>> points = box_points();
    for (Vec3<Length>& point : points)
      point = reference(point, factors);
    const HullResult copy = scaled(*hull.hull, factors), built = Hull::build(points);
    ASSERT_TRUE(copy.ok() && built.ok());
    EXPECT_EQ(copy.hull->id(), built.hull->id());
    const auto read = Hull::from_bytes(copy.hull->canonical_bytes());
    ASSERT_TRUE(read.ok());
    EXPECT_EQ(read.value()->id(), copy.hull->id());
  }
}

TEST(ScaledAsset, RoundsTiesAwayFromZero) {
  const Length odd = Length::from_raw(2001), half = Length::from_raw(1001);
  std::vector<Vec3<Length>> points;
  for (int i = 0; i < 8; ++i)
    points.push_back({i & 1 ? odd : -odd, i & 2 ? odd : -odd, i & 4 ? odd : -odd});
  const HullResult hull = Hull::build(points);
  ASSERT_TRUE(hull.ok());
  const HullResult copy = scaled(*hull.hull, by(0.5, 0.5, 0.5));
  ASSERT_TRUE(copy.ok());
  for (const Vec3<Length>& vertex : copy.hull->vertices())
    for (int axis = 0; axis < 3; ++axis)
      EXPECT_EQ(abs(vertex[axis]), half);
}

TEST(ScaledAsset, ScalesTheRadiusOfAHullByFactorsOfOneSize) {
  const HullResult hull = Hull::build(box_points(), HullOptions::rounded(0.1_m));
  ASSERT_TRUE(hull.ok());
  const HullResult copy = scaled(*hull.hull, by(-3, 3, 3));
  ASSERT_TRUE(copy.ok());
  EXPECT_EQ(copy.hull->radius(), reference(0.1_m, Number::from_integer(3)));
  EXPECT_EQ(scaled(*hull.hull, by(3, 3, 2)).fault, HullFault::invalid_options);
  // The radius falls below the least size.
  EXPECT_EQ(scaled(*hull.hull, by(0.005, 0.005, 0.005)).fault, HullFault::invalid_options);
}

TEST(ScaledAsset, KeepsTheFrontsOfAMirroredMesh) {
  const MeshResult mesh = Mesh::build(tetrahedron());
  ASSERT_GT(six_volumes(*mesh.mesh), 0.99);
  for (const Vec3<Number>& factors : {by(2, 3, 0.5), by(-2, 3, 0.5), by(2, -3, 0.5), by(2, 3, -0.5),
                                      by(-2, -3, 0.5), by(-2, -3, -0.5)}) {
    const MeshResult copy = scaled(*mesh.mesh, factors);
    ASSERT_TRUE(copy.ok());
    EXPECT_NEAR(six_volumes(*copy.mesh), 3, 1e-5);
    const bool mirrored = (factors.x.raw < 0) != ((factors.y.raw < 0) != (factors.z.raw < 0));
    MeshDef def = tetrahedron();
    std::vector<Vec3<Length>> corners = k_corners;
    for (Vec3<Length>& corner : corners)
      corner = reference(corner, factors);
    std::vector<TriangleIndices> sides = k_sides;
    for (TriangleIndices& side : sides)
      if (mirrored) std::swap(side.a, side.b);
    def.vertices = corners;
    def.triangles = sides;
    EXPECT_EQ(copy.mesh->id(), Mesh::build(def).mesh->id());
  }
}

TEST(ScaledAsset, CountsTrianglesThatRoundingTakesTheAreaOf) {
  const MeshResult mesh = Mesh::build(tetrahedron());
  const Number least = Number::from_raw(1);  // 1 m becomes one step
  EXPECT_EQ(scaled(*mesh.mesh, {least, least, least}).degenerate_triangles, 0U);
  std::vector<Vec3<Length>> corners = k_corners;
  corners.push_back({0.25_m, {}, {}});
  std::vector<TriangleIndices> sides = k_sides;
  sides.push_back({0, 4, 3});
  MeshDef def;
  def.vertices = corners;
  def.triangles = sides;
  const MeshResult finer = Mesh::build(def);
  ASSERT_EQ(finer.mesh->triangle_count(), 5U);
  const MeshResult copy = scaled(*finer.mesh, {least, least, least});
  ASSERT_TRUE(copy.ok());
  EXPECT_EQ(copy.welded_vertices, 1U);
  EXPECT_EQ(copy.degenerate_triangles, 1U);
  EXPECT_EQ(copy.mesh->triangle_count(), 4U);
}

TEST(ScaledAsset, RoundsEachHeightOfAField) {
  const HeightFieldResult field = HeightField::build(hills());
  const Vec3<Number> factors = by(1.3, 0.77, 2.9);
  const HeightFieldResult copy = scaled(*field.height_field, factors);
  ASSERT_TRUE(copy.ok());
  const auto& data = geometry::height_field_data(copy.height_field->geometry());
  for (std::size_t i = 0; i < k_heights.size(); ++i)
    EXPECT_EQ(data.heights[i], reference(2_m + k_heights[i], factors.y));
  EXPECT_EQ(data.origin_x, reference(-1_m, factors.x));
  EXPECT_EQ(data.origin_z, reference(0.5_m, factors.z));
  EXPECT_EQ(data.cell_x, reference(0.3_m, factors.x));
  EXPECT_EQ(data.cell_z, reference(0.7_m, factors.z));
  EXPECT_FALSE(data.is_void({0, 0}));
  EXPECT_TRUE(data.is_void({1, 0}));
  EXPECT_EQ(data.surface({0, 0}), &data.surfaces[1]);
}

TEST(ScaledAsset, RefusesFactorsOutOfRange) {
  const HullResult hull = Hull::build(box_points());
  const MeshResult mesh = Mesh::build(tetrahedron());
  const HeightFieldResult field = HeightField::build(hills());
  for (const Vec3<Number>& factors : {by(0, 1, 1), by(1, 0, 1), by(1, 1, 0)}) {
    EXPECT_EQ(scaled(*hull.hull, factors).fault, HullFault::invalid_options);
    EXPECT_EQ(scaled(*mesh.mesh, factors).fault, MeshFault::invalid_option);
    EXPECT_EQ(scaled(*field.height_field, factors).fault, HeightFieldFault::invalid_option);
  }
  for (const Vec3<Number>& factors : {by(-1, 1, 1), by(1, -1, 1), by(1, 1, -1)})
    EXPECT_EQ(scaled(*field.height_field, factors).fault, HeightFieldFault::invalid_option);
  // A cell of less than 0.98 mm.
  EXPECT_EQ(scaled(*field.height_field, by(0.003, 1, 1)).fault, HeightFieldFault::invalid_option);
  EXPECT_EQ(scaled(*hull.hull, by(1, 1, 2000)).fault, HullFault::coordinate_out_of_range);
  EXPECT_EQ(scaled(*mesh.mesh, by(1, 1, 2000)).fault, MeshFault::coordinate_out_of_range);
  EXPECT_EQ(scaled(*field.height_field, by(1, 2000, 1)).fault,
            HeightFieldFault::coordinate_out_of_range);
  EXPECT_EQ(scaled(*mesh.mesh, by(512, 1, 1)).fault, MeshFault::none);
  EXPECT_EQ(scaled(*mesh.mesh, by(512.0001, 1, 1)).fault, MeshFault::coordinate_out_of_range);
  EXPECT_EQ(scaled(*hull.hull, by(1, 1, 0.0001)).fault, HullFault::flat);
}

}  // namespace
}  // namespace lockstone
