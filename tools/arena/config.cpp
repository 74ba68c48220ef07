#include "tools/arena/config.h"

namespace lockstone::arena {
namespace {

bool in_range(const ArenaConfig& config) {
  return config.players >= 1 && config.players <= k_max_players &&
         config.loose_bodies <= k_max_loose_bodies && config.variant <= Variant::empty;
}

}  // namespace

std::array<std::byte, k_config_bytes> ArenaConfig::encode() const {
  std::array<std::byte, k_config_bytes> bytes{};
  ByteWriter writer(bytes);
  writer.put(k_config_magic);
  writer.put(k_config_version);
  writer.put(seed);
  writer.put(loose_bodies);
  writer.put(players);
  writer.put(variant);
  LKS_CHECK(writer.ok() && writer.size() == k_config_bytes);
  return bytes;
}

Result<ArenaConfig> ArenaConfig::decode(ByteView bytes) {
  ByteReader reader(bytes);
  const auto magic = reader.get<std::uint32_t>();
  const auto version = reader.get<std::uint16_t>();
  ArenaConfig config;
  config.seed = reader.get<std::uint64_t>();
  config.loose_bodies = reader.get<std::uint16_t>();
  config.players = reader.get<std::uint8_t>();
  const auto variant = reader.get<std::uint8_t>();
  if (!reader.ok()) return Status::truncated;
  if (magic != k_config_magic || reader.remaining() != 0) return Status::malformed;
  if (version != k_config_version) return Status::unsupported_version;
  config.variant = static_cast<Variant>(variant);
  if (!in_range(config)) return Status::invalid_argument;
  return config;
}

}  // namespace lockstone::arena
