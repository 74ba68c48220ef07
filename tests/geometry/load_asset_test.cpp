// Loading assets of any kind from untrusted bytes.
#include <array>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/literals.h>
#include <lockstone/load_asset.h>
#include <lockstone/mesh.h>

#include "core/geometry/asset_frame.h"
#include "tests/support/random.h"

namespace lockstone {
namespace {

using namespace literals;
using Bytes = std::vector<std::byte>;

std::shared_ptr<const Hull> sample_hull() {
  constexpr std::array<Vec3<Length>, 5> points{Vec3<Length>{0_m, 0_m, 0_m},
                                               {2_m, 0_m, 0_m},
                                               {0_m, 1_m, 0_m},
                                               {0_m, 0_m, 3_m},
                                               {1_m, 1_m, 1_m}};
  return Hull::build(points).hull;
}

AssetPtr sample_mesh() {
  constexpr std::array<Vec3<Length>, 4> vertices{
      Vec3<Length>{0_m, 0_m, 0_m}, {0_m, 0_m, 1_m}, {1_m, 0_m, 0_m}, {1_m, 1_m, 1_m}};
  constexpr std::array triangles{TriangleIndices{0, 1, 2}, TriangleIndices{2, 1, 3}};
  constexpr std::array surfaces{Surface{}};
  constexpr std::array<std::uint8_t, 2> of_triangles{0, k_own_surface};
  MeshDef def;
  def.vertices = vertices;
  def.triangles = triangles;
  def.surfaces = surfaces;
  def.triangle_surfaces = of_triangles;
  return Mesh::build(def).mesh;
}

AssetPtr sample_height_field() {
  constexpr std::array<Length, 9> heights{0_m, 1_m, 0.5_m, 0_m, 2_m, 0_m, 1_m, 1_m, 1_m};
  constexpr std::array<std::uint8_t, 4> holes{0, 1, 0, 0};
  HeightFieldDef def;
  def.columns = def.rows = 3;
  def.heights = heights;
  def.holes = holes;
  return HeightField::build(def).height_field;
}

AssetPtr sample_compound() {
  CompoundChild box;
  box.shape = Shape::box(1_m, 1_m, 0.5_m);
  CompoundChild hull;
  hull.asset = sample_hull();
  hull.shape = hull.asset->shape();
  hull.position = {2_m, 0_m, 0_m};
  const std::array children{box, hull};
  return Compound::build(children).compound;
}

std::array<AssetPtr, 4> samples() {
  return {sample_hull(), sample_mesh(), sample_height_field(), sample_compound()};
}

AssetSet known_hulls() {
  return AssetSet({sample_hull()});
}

TEST(LoadAsset, GivesBackEveryKind) {
  for (const AssetPtr& asset : samples()) {
    ASSERT_NE(asset, nullptr);
    const Bytes bytes = asset->canonical_bytes();
    const Result<AssetPtr> loaded = load_asset(bytes, known_hulls());
    ASSERT_TRUE(loaded.ok()) << to_string(loaded.status());
    EXPECT_EQ(loaded.value()->kind(), asset->kind());
    EXPECT_EQ(loaded.value()->id(), asset->id());
    EXPECT_EQ(loaded.value()->canonical_bytes(), bytes);
  }
}

TEST(LoadAsset, AsksForTheHullsOfACompound) {
  const Bytes bytes = sample_compound()->canonical_bytes();
  EXPECT_EQ(load_asset(bytes).status(), Status::not_found);
  EXPECT_EQ(load_asset(bytes, AssetSet({sample_mesh()})).status(), Status::not_found);
}

TEST(LoadAsset, RefusesEveryTruncation) {
  for (const AssetPtr& asset : samples()) {
    const Bytes bytes = asset->canonical_bytes();
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const Status status = load_asset(ByteView(bytes).first(size), known_hulls()).status();
      EXPECT_EQ(status, Status::truncated) << size << " of " << bytes.size();
    }
  }
}

TEST(LoadAsset, RefusesTrailingBytes) {
  for (const AssetPtr& asset : samples()) {
    Bytes bytes = asset->canonical_bytes();
    bytes.push_back({});
    EXPECT_EQ(load_asset(bytes, known_hulls()).status(), Status::malformed);
  }
}

TEST(LoadAsset, RefusesOtherKindsMagicAndVersions) {
  for (const AssetPtr& asset : samples()) {
    const Bytes bytes = asset->canonical_bytes();
    for (int kind = 0; kind < 256; ++kind) {
      if (kind == static_cast<int>(asset->kind())) continue;
      Bytes other = bytes;
      other[6] = static_cast<std::byte>(kind);
      EXPECT_FALSE(load_asset(other, known_hulls()).ok()) << kind;
    }
    Bytes magic = bytes;
    magic[0] ^= std::byte{1};
    EXPECT_EQ(load_asset(magic, known_hulls()).status(), Status::malformed);
    Bytes version = bytes;
    version[4] ^= std::byte{0x40};
    EXPECT_EQ(load_asset(version, known_hulls()).status(), Status::unsupported_version);
    Bytes reserved = bytes;
    reserved[7] = std::byte{1};
    EXPECT_EQ(load_asset(reserved, known_hulls()).status(), Status::malformed);
  }
}

// Loads `bytes`: a typed error, or an asset that has exactly these bytes and this hash.
void expect_refused_or_faithful(const Bytes& bytes, AssetId original) {
  const Result<AssetPtr> loaded = load_asset(bytes, known_hulls());
  if (!loaded) {
    EXPECT_NE(loaded.status(), Status::ok);
    return;
  }
  EXPECT_EQ(loaded.value()->canonical_bytes(), bytes);
  EXPECT_EQ(loaded.value()->id(), geometry::id_of(bytes));
  EXPECT_NE(loaded.value()->id(), original);
}

TEST(LoadAsset, RefusesFlippedBitsOrNamesThemAnew) {
  for (const AssetPtr& asset : samples()) {
    const Bytes bytes = asset->canonical_bytes();
    for (std::size_t bit = 0; bit < 8 * bytes.size(); ++bit) {
      Bytes flipped = bytes;
      flipped[bit / 8] ^= static_cast<std::byte>(1 << (bit % 8));
      expect_refused_or_faithful(flipped, asset->id());
    }
  }
}

TEST(LoadAsset, SurvivesArbitraryBytesAfterAGoodHead) {
  test::Random random(test::run_seed());
  for (int run = 0; run < 2000; ++run) {
    const AssetPtr asset = samples()[static_cast<std::size_t>(run % 4)];
    Bytes bytes = asset->canonical_bytes();
    const std::int64_t changes = random.between(1, 12);
    for (std::int64_t i = 0; i < changes; ++i) {
      const auto at = random.between(8, static_cast<std::int64_t>(bytes.size()) - 1);
      bytes[static_cast<std::size_t>(at)] = static_cast<std::byte>(random.between(0, 255));
    }
    if (bytes != asset->canonical_bytes()) expect_refused_or_faithful(bytes, asset->id());
  }
}

}  // namespace
}  // namespace lockstone
