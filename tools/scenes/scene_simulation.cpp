#include "tools/scenes/scene_simulation.h"

#include <lockstone/hash.h>

namespace lockstone::scenes {
namespace {

constexpr std::size_t k_name_bytes = k_config_bytes - 14;

World make_world(const Scene& scene, std::uint64_t seed, BroadPhaseKind broad_phase,
                 std::uint32_t spare_bodies, const SceneValues& values) {
  WorldDef def = define_scene(scene, values);
  def.broad_phase = broad_phase;
  def.body_capacity += spare_bodies;
  auto assets = std::make_shared<const AssetSet>(scene.assets == nullptr ? std::vector<AssetPtr>{}
                                                                         : scene.assets(seed));
  Result<World> world = World::create(def, std::move(assets));
  LKS_CHECK(world.ok());
  scene.builder(world.value(), seed, values);
  return std::move(world).value();
}

}  // namespace

std::array<std::byte, k_config_bytes> encode_config(std::string_view name, std::uint64_t seed) {
  LKS_CHECK(name.size() < k_name_bytes);
  std::array<std::byte, k_config_bytes> bytes{};
  ByteWriter writer(bytes);
  writer.put(k_config_magic);
  writer.put(k_config_version);
  writer.put(seed);
  writer.put_bytes(std::as_bytes(std::span(name.data(), name.size())));
  return bytes;
}

SceneSimulation::SceneSimulation(const Scene& scene, std::uint64_t seed, BroadPhaseKind broad_phase,
                                 std::uint32_t spare_bodies, std::span<const std::int32_t> values)
    : scene_(scene),
      seed_(seed),
      world_(
          make_world(scene, seed, broad_phase, spare_bodies, scene_values(scene, values).value())) {
  info_.abi = k_simulation_abi;
  info_.config_hash =
      hash64(encode_config(scene.name, seed), config_hash(world_.def(), world_.assets()->hash()));
  info_.scene_hash = hash();
  info_.canary = canary_hash();
  info_.tick_rate = world_.def().tick_rate;
  info_.player_count =
      static_cast<std::uint8_t>(scene.players == nullptr ? 1 : scene.players->count);
  info_.input_bytes =
      static_cast<std::uint8_t>(scene.players == nullptr ? 1 : scene.players->input_bytes);
}

std::size_t SceneSimulation::part_hashes(std::span<PartHash, k_max_state_parts> out) const {
  const StateHash128 hash = world_.hash128();
  out[0] = {"world", hash.header};
  out[1] = {"bodies", hash.bodies};
  out[2] = {"contacts", hash.contacts};
  out[3] = {"joints", hash.joints};
  return 4;
}

void SceneSimulation::step(std::span<const PlayerInput> inputs) {
  LKS_CHECK(inputs.size() == info_.player_count);
  if (scene_.players != nullptr) {
    for (std::size_t slot = 0; slot < inputs.size(); ++slot)
      scene_.players->apply(world_, slot, inputs[slot].bytes);
  } else if (scene_.drive != nullptr) {
    scene_.drive(world_, seed_);
  }
  last_report_ = history_.step();
  if (scene_.observe != nullptr) scene_.observe(world_);
}

Result<std::unique_ptr<Simulation>> make_scene(ByteView config) {
  ByteReader reader(config);
  const auto magic = reader.get<std::uint32_t>();
  const auto version = reader.get<std::uint16_t>();
  const auto seed = reader.get<std::uint64_t>();
  const ByteView padded = reader.get_bytes(k_name_bytes);
  if (!reader.ok()) return Status::truncated;
  if (magic != k_config_magic || reader.remaining() != 0) return Status::malformed;
  if (version != k_config_version) return Status::unsupported_version;
  std::array<char, k_name_bytes> text{};
  for (std::size_t i = 0; i + 1 < k_name_bytes; ++i)
    text[i] = static_cast<char>(padded[i]);
  const Scene* scene = find_scene(text.data());
  if (scene == nullptr) return Status::not_found;
  return std::unique_ptr<Simulation>(std::make_unique<SceneSimulation>(*scene, seed));
}

}  // namespace lockstone::scenes
