#include <algorithm>

#include <lockstone/asset.h>
#include <lockstone/hash.h>

#include "core/geometry/convex/asset_geometry.h"

namespace lockstone {
namespace {

std::uint64_t hash_of(std::span<const AssetPtr> assets) {
  if (assets.empty()) return 0;
  std::vector<std::byte> bytes(assets.size() * sizeof(std::uint64_t));
  ByteWriter writer(bytes);
  for (const AssetPtr& asset : assets)
    writer.put(asset->id().value);
  return hash64(writer.written());
}

}  // namespace

Asset::Asset(ShapeKind kind, AssetId id, std::unique_ptr<const geometry::AssetGeometry> geometry)
    : kind_(kind), id_(id), geometry_(std::move(geometry)) {
  LKS_ASSERT(geometry_ != nullptr);
}

Asset::~Asset() = default;

AssetSet::AssetSet(std::vector<AssetPtr> assets) : assets_(std::move(assets)) {
  if (std::ranges::find(assets_, nullptr) != assets_.end())
    misused("AssetSet: an entry is null; look at the result of the builder first");
  const auto id = [](const AssetPtr& asset) { return asset->id(); };
  std::ranges::sort(assets_, {}, id);
  const auto same = [&id](const AssetPtr& a, const AssetPtr& b) { return id(a) == id(b); };
  assets_.erase(std::unique(assets_.begin(), assets_.end(), same), assets_.end());
  hash_ = hash_of(assets_);
}

const Asset* AssetSet::find(AssetId id) const {
  const auto by_id = [](const AssetPtr& asset) { return asset->id(); };
  const auto found = std::ranges::lower_bound(assets_, id, {}, by_id);
  return found != assets_.end() && (*found)->id() == id ? found->get() : nullptr;
}

}  // namespace lockstone
