#include <algorithm>
#include <map>

#include <gtest/gtest.h>

#include <lockstone/hash.h>
#include <lockstone/height_field.h>

#include "core/geometry/convex/asset_geometry.h"
#include "tests/geometry/assets/asset_parts.h"

namespace lockstone::test {
namespace {

using geometry::LocalBounds;

struct Terrain {
  int columns = 0;
  int rows = 0;
  std::vector<Length> heights;
  std::vector<std::uint8_t> holes;
  std::vector<std::uint8_t> surfaces;
  std::vector<Surface> palette = std::vector<Surface>(3);

  [[nodiscard]] HeightFieldDef def() const {
    HeightFieldDef def;
    def.columns = static_cast<std::uint32_t>(columns);
    def.rows = static_cast<std::uint32_t>(rows);
    def.heights = heights;
    def.holes = holes;
    def.cell_surfaces = surfaces;
    def.surfaces = palette;
    def.cell_x = metres(0.75);
    def.cell_z = metres(1.25);
    def.origin = metres(-7, 1, -3);
    return def;
  }
};

Terrain random_terrain(Dice& dice, int columns, int rows) {
  Terrain terrain{columns, rows, {}, {}, {}};
  for (int i = 0; i < columns * rows; ++i)
    terrain.heights.push_back(metres(dice.chance(3) ? 0 : dice.uniform(-2, 2)));
  for (int i = 0; i < (columns - 1) * (rows - 1); ++i) {
    terrain.holes.push_back(dice.chance(6) ? 1 : 0);
    terrain.surfaces.push_back(
        static_cast<std::uint8_t>(dice.chance(2) ? 255 : dice.between(0, 2)));
  }
  return terrain;
}

std::shared_ptr<const HeightField> built(const HeightFieldDef& def) {
  const HeightFieldResult result = HeightField::build(def);
  EXPECT_TRUE(result.ok()) << to_string(result.fault);
  return result.height_field;
}

/// The same triangles as a mesh.
std::shared_ptr<const Mesh> as_mesh(const HeightField& field) {
  Triangles soup;
  for (const SeenPart& part : all_parts(field)) {
    const auto first = static_cast<std::uint32_t>(soup.vertices.size());
    soup.vertices.insert(soup.vertices.end(), part.vertices.begin(), part.vertices.end());
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  const MeshResult result = Mesh::build(soup.def());
  EXPECT_EQ(result.mesh->triangle_count(), soup.triangles.size());
  return result.mesh;
}

/// A triangle that begins with its lowest vertex, and its active edges turned likewise.
using Key = std::array<std::int32_t, 9>;

std::pair<Key, unsigned> canonical(const SeenPart& part) {
  std::pair<Key, unsigned> best{};
  for (std::size_t start = 0; start < 3; ++start) {
    Key key{};
    unsigned active = 0;
    for (std::size_t k = 0; k < 3; ++k) {
      const std::size_t from = (start + k) % 3;
      for (int axis = 0; axis < 3; ++axis)
        key[3 * k + static_cast<std::size_t>(axis)] = part.vertices[from][axis].raw;
      active |= ((part.topology.active_edges >> from) & 1U) << k;
    }
    if (start == 0 || key < best.first) best = {key, active};
  }
  return best;
}

std::map<Key, unsigned> triangles_in(const Asset& asset, const LocalBounds& region) {
  CollectParts collect;
  asset.geometry().visit_parts(region, collect);
  std::map<Key, unsigned> result;
  for (const SeenPart& part : collect.parts)
    result.insert(canonical(part));
  EXPECT_EQ(result.size(), collect.parts.size());
  return result;
}

TEST(HeightField, ShowsTheTrianglesAndEdgesOfTheSameSurfaceAsAMesh) {
  Dice dice;
  for (const auto& [columns, rows] : {std::pair{2, 2}, {9, 6}, {21, 34}}) {
    const Terrain terrain = random_terrain(dice, columns, rows);
    const HeightFieldResult result = HeightField::build(terrain.def());
    if (result.fault == HeightFieldFault::empty) continue;
    const HeightField& field = *result.height_field;
    const auto mesh = as_mesh(field);
    EXPECT_EQ(triangles_in(field, field.geometry().bounds()),
              triangles_in(*mesh, field.geometry().bounds()));
    for (int i = 0; i < 200; ++i) {
      const LocalBounds region = random_region(dice, 15, 4);
      ASSERT_EQ(triangles_in(field, region), triangles_in(*mesh, region));
    }
  }
}

TEST(HeightField, ShowsPartsInAscendingOrder) {
  Dice dice;
  const auto field = built(random_terrain(dice, 30, 20).def());
  for (int i = 0; i < 50; ++i) {
    CollectParts collect;
    field->geometry().visit_parts(random_region(dice, 15, 15), collect);
    for (std::size_t k = 1; k < collect.parts.size(); ++k)
      ASSERT_LT(collect.parts[k - 1].index, collect.parts[k].index);
  }
}

TEST(HeightField, NumbersTwoPartsACellThatFaceUp) {
  Terrain terrain{3, 3, std::vector<Length>(9), {}, {}};
  const auto parts = all_parts(*built(terrain.def()));
  ASSERT_EQ(parts.size(), 8U);
  for (std::uint32_t i = 0; i < 8; ++i) {
    EXPECT_EQ(parts[i].index, i);
    EXPECT_EQ(geometry::triangle_normal(parts[i].vertices), (Vec3<Unit>{{}, unit(1), {}}));
  }
  EXPECT_EQ(parts[0].vertices[0], metres(-7, 1, -3));
  EXPECT_EQ(parts[0].vertices[1], metres(-7, 1, -1.75));
  EXPECT_EQ(parts[0].vertices[2], metres(-6.25, 1, -1.75));
}

TEST(HeightField, LeavesHolesOutAndMakesTheirRimActive) {
  Terrain terrain{4, 4, std::vector<Length>(16), std::vector<std::uint8_t>(9), {}};
  terrain.holes[4] = 7;
  const auto parts = all_parts(*built(terrain.def()));
  EXPECT_EQ(parts.size(), 16U);
  int active = 0;
  for (const SeenPart& part : parts)
    active += std::popcount(part.topology.active_edges);
  EXPECT_EQ(active, 12 + 4);
}

TEST(HeightField, MissesNoPartThatARayMeets) {
  Dice dice;
  const auto field = built(random_terrain(dice, 40, 25).def());
  const auto all = all_parts(*field);
  std::size_t met = 0;
  for (int i = 0; i < 300; ++i) {
    const Vec3<Length> origin = random_region(dice, 30, 1).lower;
    Vec3<Length> way =
        metres(dice.uniform(-7, 20), dice.uniform(-2, 3), dice.uniform(-3, 25)) - origin;
    if (dice.chance(5)) way = {{}, way.y, {}};
    CollectRayParts collect;
    field->geometry().visit_parts_on_way(origin, way, {}, collect);
    std::sort(collect.parts.begin(), collect.parts.end());
    met += collect.parts.size();
    for (const SeenPart& part : all) {
      const bool found = std::binary_search(collect.parts.begin(), collect.parts.end(), part.index);
      ASSERT_TRUE(found || !surely_meets(origin, way, geometry::bounds_of(part.vertices)));
    }
  }
  EXPECT_GT(met, 100U);
}

TEST(HeightField, AsksForNothingFarBeyondAShortenedRay) {
  class First final : public geometry::WayPartVisitor {
   public:
    int visits = 0;
    Unit visit(const geometry::Part&) override {
      ++visits;
      return {};
    }
  } first;
  Terrain terrain{400, 5, std::vector<Length>(2000), {}, {}};
  built(terrain.def())
      ->geometry()
      .visit_parts_on_way(metres(-8, 1, 0), metres(400, 0, 0), {}, first);
  EXPECT_GT(first.visits, 0);
  EXPECT_LE(first.visits, 4);
}

TEST(HeightField, TakesSamplesAsStepsAboveItsOrigin) {
  const std::vector<std::uint16_t> samples{0, 1, 2, 65535, 4, 5};
  HeightFieldDef def;
  def.columns = 3;
  def.rows = 2;
  def.samples = samples;
  def.sample_step = Length::from_raw(1000);
  def.origin.y = metres(-30);
  const auto field = built(def);
  EXPECT_EQ(field->geometry().bounds().lower.y, metres(-30));
  EXPECT_EQ(field->geometry().bounds().upper.y.raw, metres(-30).raw + 65535000);
  def.sample_step = metres(1);
  const HeightFieldResult refused = HeightField::build(def);
  EXPECT_EQ(refused.fault, HeightFieldFault::coordinate_out_of_range);
  EXPECT_EQ(refused.index, 3U);
}

TEST(HeightField, RefusesWithAReason) {
  const Terrain good{3, 3, std::vector<Length>(9), {}, {}};
  const auto fault = [](const HeightFieldDef& def) { return HeightField::build(def).fault; };
  EXPECT_EQ(fault(good.def()), HeightFieldFault::none);
  HeightFieldDef def = good.def();
  def.rows = 4;
  EXPECT_EQ(fault(def), HeightFieldFault::size_mismatch);
  def = good.def();
  def.columns = 1;
  EXPECT_EQ(fault(def), HeightFieldFault::size_mismatch);
  def = good.def();
  def.columns = k_max_height_field_samples + 1;
  EXPECT_EQ(fault(def), HeightFieldFault::size_mismatch);
  def = good.def();
  def.cell_x = {};
  EXPECT_EQ(fault(def), HeightFieldFault::invalid_option);
  def = good.def();
  def.origin.x = metres(511);
  EXPECT_EQ(fault(def), HeightFieldFault::coordinate_out_of_range);
  def = good.def();
  const std::vector<std::uint8_t> four(4, 3);
  def.cell_surfaces = four;
  EXPECT_EQ(fault(def), HeightFieldFault::surface_out_of_range);
  def = good.def();
  def.holes = four;
  EXPECT_EQ(fault(def), HeightFieldFault::empty);
  const std::vector<Surface> bouncy(1, Surface{{}, Coefficient::from_ratio(3, 2)});
  def = good.def();
  def.surfaces = bouncy;
  EXPECT_EQ(fault(def), HeightFieldFault::invalid_surface);
  EXPECT_EQ(to_string(HeightFieldFault::empty), "nothing but holes");
}

TEST(HeightField, ReturnsFromItsBytesAndAnswersBadOnesWithAnError) {
  Dice dice;
  const Terrain terrain = random_terrain(dice, 6, 5);
  const auto field = built(terrain.def());
  const auto bytes = field->canonical_bytes();
  EXPECT_EQ(field->id().value, hash64(bytes));
  const auto back = HeightField::from_bytes(bytes);
  ASSERT_TRUE(back.ok());
  EXPECT_EQ(back.value()->canonical_bytes(), bytes);
  EXPECT_EQ(back.value()->geometry().bounds(), field->geometry().bounds());
  for (std::size_t size = 0; size < bytes.size(); ++size)
    ASSERT_EQ(HeightField::from_bytes(ByteView(bytes).first(size)).status(), Status::truncated);
  for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
    auto bad = bytes;
    bad[bit / 8] ^= static_cast<std::byte>(1 << (bit % 8));
    const auto result = HeightField::from_bytes(bad);
    if (result.ok()) {
      ASSERT_EQ(result.value()->canonical_bytes(), bad);
    }
  }
}

}  // namespace
}  // namespace lockstone::test
