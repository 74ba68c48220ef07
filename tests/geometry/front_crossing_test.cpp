// Ways through the fronts of triangles.
#include <gtest/gtest.h>

#include <lockstone/mesh.h>

#include "core/geometry/mesh_contact/front_crossing_search.h"
#include "tests/geometry/assets/asset_parts.h"

namespace lockstone::geometry {
namespace {

using test::Dice;
using test::metres;

double bumps(int i, int j) {
  return 0.3 * ((i * 7 + j * 5) % 4) + 1e-5 * ((i * 13 + j) % 7);
}

AssetPtr bumpy_mesh() {
  return Mesh::build(test::grid(13, 13, 0.5, bumps).def()).mesh;
}

Vec3<Length> somewhere(Dice& dice, double low, double high) {
  return metres(dice.uniform(0.2, 5.8), dice.uniform(low, high), dice.uniform(0.2, 5.8));
}

// No way from above the surface to below it is missed, wherever it passes an edge or a corner.
TEST(FrontCrossing, IsFoundOnEveryWayThrough) {
  const AssetPtr mesh = bumpy_mesh();
  Dice dice;
  for (int run = 0; run < 20'000; ++run) {
    const Vec3<Length> from = somewhere(dice, 1.0, 3.0), to = somewhere(dice, -3.0, -0.01);
    const FrontCrossing crossing = first_front_crossing(mesh->geometry(), {from, to});
    ASSERT_TRUE(crossing.found) << run;
    ASSERT_LT(crossing.height, 0);
    const Vec3<Length> below = {from.x, to.y, from.z};
    ASSERT_FALSE(first_front_crossing(mesh->geometry(), {below, from}).found) << run;
  }
}

TEST(FrontCrossing, IsFoundAtCorners) {
  const AssetPtr mesh = bumpy_mesh();
  Dice dice;
  for (int run = 0; run < 5'000; ++run) {
    const auto i = static_cast<int>(dice.between(1, 11));
    const auto j = static_cast<int>(dice.between(1, 11));
    const Vec3<Length> corner = metres(0.5 * i, bumps(i, j), 0.5 * j);
    Vec3<Length> way = metres(dice.uniform(-1, 1), 0, dice.uniform(-1, 1));
    way.y = metres(-3);
    ASSERT_TRUE(first_front_crossing(mesh->geometry(), {corner - way, corner + way}).found) << run;
  }
}

// Pushed as far as it says it stays before the front.
TEST(FrontCrossing, NothingNearerThanTheGuardIsLeft) {
  const AssetPtr mesh = Mesh::build(test::grid(3, 3, 1.0, [](int, int) { return 0.0; }).def()).mesh;
  Vec3<Length> from = metres(0.7, 0.1, 0.4), to = metres(0.9, 0, 1.3);
  to.y = k_front_margin;
  EXPECT_FALSE(first_front_crossing(mesh->geometry(), {from, to}).found);
  to.y = k_front_margin - Length::from_raw(1);
  const FrontCrossing crossing = first_front_crossing(mesh->geometry(), {from, to});
  EXPECT_TRUE(crossing.found);
  EXPECT_EQ(crossing.height, fine(to.y));
  from.y = -Length::from_raw(1);
  EXPECT_FALSE(first_front_crossing(mesh->geometry(), {from, to}).found);  // from behind
}

TEST(FrontCrossing, IsTheFirstOfSeveral) {
  test::Triangles sheets = test::grid(2, 2, 1.0, [](int, int) { return 0.0; });
  const auto count = static_cast<std::uint32_t>(sheets.vertices.size());
  for (std::uint32_t i = 0; i < count; ++i) {
    Vec3<Length> v = sheets.vertices[i];
    v.y = metres(1);
    sheets.vertices.push_back(v);
  }
  for (std::size_t i = 0; i < 2; ++i) {
    const TriangleIndices t = sheets.triangles[i];
    sheets.triangles.push_back({t.a + count, t.b + count, t.c + count});
  }
  const AssetPtr mesh = Mesh::build(sheets.def()).mesh;
  const FrontCrossing crossing =
      first_front_crossing(mesh->geometry(), {metres(0.6, 3, 0.3), metres(0.6, -1, 0.3)});
  ASSERT_TRUE(crossing.found);
  EXPECT_EQ(crossing.fraction, Unit::from_ratio(1, 2));
}

}  // namespace
}  // namespace lockstone::geometry
