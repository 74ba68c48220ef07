#include "tools/watch/world_description.h"

#include <algorithm>
#include <array>
#include <memory>
#include <utility>

#include <lockstone/load_asset.h>

namespace lockstone::watch {
namespace {

constexpr std::size_t k_most_definition_bytes = 128;

// Def is WorldDef, const or not.
template <class Def, class F>
void visit_definition(Def& def, F&& f) {
  f(def.body_capacity);
  f(def.pair_capacity);
  f(def.contact_capacity);
  f(def.joint_capacity);
  f(def.converged_contacts);
  f(def.tick_rate);
  f(def.substeps);
  f(def.sleep_ms);
  f(def.sleep_distance.raw);
  f(def.gravity.x.raw);
  f(def.gravity.y.raw);
  f(def.gravity.z.raw);
  f(def.speed_limit.raw);
  f(def.vehicle_capacity);
  f(def.terrain_tile_capacity);
}

// Compounds come last: they name hulls of the set.
std::vector<AssetPtr> in_order_of_loading(const AssetSet& assets) {
  std::vector<AssetPtr> sorted(assets.all().begin(), assets.all().end());
  std::stable_partition(sorted.begin(), sorted.end(), [](const AssetPtr& asset) {
    return asset->kind() != ShapeKind::compound;
  });
  return sorted;
}

}  // namespace

std::vector<std::byte> describe_world(const World& world) {
  std::array<std::byte, k_most_definition_bytes> head{};
  ByteWriter writer(head);
  writer.put(ViewMessage::description);
  writer.put(k_simulation_abi);
  visit_definition(world.def(), [&](auto field) { writer.put(field); });
  LKS_CHECK(writer.ok());
  std::vector<std::byte> message(writer.written().begin(), writer.written().end());
  for (const AssetPtr& asset : in_order_of_loading(*world.assets())) {
    const std::vector<std::byte> bytes = asset->canonical_bytes();
    std::array<std::byte, 4> size{};
    ByteWriter(size).put(static_cast<std::uint32_t>(bytes.size()));
    message.insert(message.end(), size.begin(), size.end());
    message.insert(message.end(), bytes.begin(), bytes.end());
  }
  return message;
}

Result<World> described_world(ByteView message) {
  ByteReader reader(message);
  if (reader.get<std::uint8_t>() != static_cast<std::uint8_t>(ViewMessage::description))
    return Status::malformed;
  if (reader.get<std::uint32_t>() != k_simulation_abi) return Status::incompatible;
  WorldDef def;
  visit_definition(def, [&]<class Field>(Field& field) { field = reader.get<Field>(); });
  std::vector<AssetPtr> assets;
  while (reader.ok() && reader.remaining() > 0) {
    const ByteView bytes = reader.get_bytes(reader.get<std::uint32_t>());
    if (!reader.ok()) break;
    Result<AssetPtr> asset = load_asset(bytes, AssetSet(assets));
    if (!asset) return asset.status();
    assets.push_back(std::move(asset).value());
  }
  if (!reader.ok()) return Status::truncated;
  return World::create(def, std::make_shared<const AssetSet>(std::move(assets)));
}

}  // namespace lockstone::watch
