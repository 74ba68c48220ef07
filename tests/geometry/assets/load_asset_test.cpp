// Loading assets of any kind from untrusted bytes.
#include <array>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/literals.h>
#include <lockstone/load_asset.h>
#include <lockstone/mesh.h>

#include "core/geometry/assets/asset_frame.h"
#include "tests/support/random.h"
#include "tests/support/sample_assets.h"

namespace lockstone {
namespace {

using namespace literals;
using Bytes = std::vector<std::byte>;

AssetSet known_hulls() {
  return AssetSet({test::sample_hull()});
}

TEST(LoadAsset, GivesBackEveryKind) {
  for (const AssetPtr& asset : test::sample_assets()) {
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
  const Bytes bytes = test::sample_compound()->canonical_bytes();
  EXPECT_EQ(load_asset(bytes).status(), Status::not_found);
  EXPECT_EQ(load_asset(bytes, AssetSet({test::sample_mesh()})).status(), Status::not_found);
}

TEST(LoadAsset, RefusesEveryTruncation) {
  for (const AssetPtr& asset : test::sample_assets()) {
    const Bytes bytes = asset->canonical_bytes();
    for (std::size_t size = 0; size < bytes.size(); ++size) {
      const Status status = load_asset(ByteView(bytes).first(size), known_hulls()).status();
      EXPECT_EQ(status, Status::truncated) << size << " of " << bytes.size();
    }
  }
}

TEST(LoadAsset, RefusesTrailingBytes) {
  for (const AssetPtr& asset : test::sample_assets()) {
    Bytes bytes = asset->canonical_bytes();
    bytes.push_back({});
    EXPECT_EQ(load_asset(bytes, known_hulls()).status(), Status::malformed);
  }
}

TEST(LoadAsset, RefusesOtherKindsMagicAndVersions) {
  for (const AssetPtr& asset : test::sample_assets()) {
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
  for (const AssetPtr& asset : test::sample_assets()) {
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
    const AssetPtr asset = test::sample_assets()[static_cast<std::size_t>(run % 4)];
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
