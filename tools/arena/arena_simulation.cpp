#include "tools/arena/arena_simulation.h"

#include <cstring>
#include <utility>

#include <lockstone/hash.h>

#include "tools/arena/arena_command.h"
#include "tools/arena/input.h"
#include "tools/arena/level.h"
#include "tools/arena/rules.h"
#include "tools/arena/state_codec.h"
#include "tools/arena/tags.h"

namespace lockstone::arena {
namespace {

constexpr std::uint32_t k_snapshot_magic = 0x53414b4c;  // "LKAS"
constexpr std::uint16_t k_snapshot_version = 3;
constexpr std::size_t k_snapshot_header_bytes = 8;
constexpr std::uint64_t k_hash_seed = 0x6172656e61;

// A native snapshot is a copy of memory, which a plain record allows.
static_assert(std::is_trivially_copyable_v<GameState>);

}  // namespace

/// A canonical snapshot taken apart.
struct ArenaSimulation::Parts {
  GameState state;
  ByteView world;
};

ArenaSimulation::ArenaSimulation(const ArenaConfig& config, BroadPhaseKind broad_phase)
    : arena_(build_arena(config, broad_phase)) {
  info_.abi = k_simulation_abi << 16 | k_rules_version;
  info_.config_hash = hash64(config.encode(), config_hash(arena_.world.def()));
  info_.scene_hash = hash();
  info_.canary = canary_hash();
  info_.tick_rate = arena_.world.def().tick_rate;
  info_.player_count = config.players;
  info_.input_bytes = k_input_bytes;
}

void ArenaSimulation::step(std::span<const PlayerInput> inputs) {
  LKS_CHECK(inputs.size() == arena_.config.players);
  last_report_ = advance(arena_, inputs);
}

void ArenaSimulation::command(const PlayerCommand& command) {
  const std::optional<std::uint8_t> to = gift_slot(command.bytes);
  const std::size_t players = arena_.config.players;
  if (!to || *to >= players || command.slot >= players) return;
  add_score(arena_.state.players[command.slot], -1);
  add_score(arena_.state.players[*to], 1);
}

std::size_t ArenaSimulation::snapshot_bytes_max(SnapshotKind kind) const {
  const std::size_t world_bytes = arena_.world.snapshot_bytes_max(kind);
  if (kind == SnapshotKind::native) return sizeof(GameState) + world_bytes;
  return k_snapshot_header_bytes + k_max_state_bytes + world_bytes;
}

std::size_t ArenaSimulation::save(SnapshotKind kind, std::span<std::byte> out) const {
  LKS_CHECK(out.size() >= snapshot_bytes_max(kind));
  std::size_t own_bytes = sizeof(GameState);
  if (kind == SnapshotKind::native) {
    std::memcpy(out.data(), &arena_.state, sizeof(GameState));
  } else {
    ByteWriter writer(out);
    writer.put(k_snapshot_magic);
    writer.put(k_snapshot_version);
    writer.put(std::uint16_t{arena_.config.players});
    encode_state(arena_.state, arena_.config.players, writer);
    own_bytes = writer.size();
  }
  const std::size_t world_bytes = arena_.world.save(kind, out.subspan(own_bytes));
  LKS_CHECK(world_bytes > 0);
  return own_bytes + world_bytes;
}

Result<ArenaSimulation::Parts> ArenaSimulation::split(ByteView canonical) const {
  ByteReader reader(canonical);
  const auto magic = reader.get<std::uint32_t>();
  const auto version = reader.get<std::uint16_t>();
  const auto players = reader.get<std::uint16_t>();
  if (!reader.ok()) return Status::truncated;
  if (magic != k_snapshot_magic) return Status::malformed;
  if (version != k_snapshot_version) return Status::unsupported_version;
  if (players != arena_.config.players) return Status::incompatible;
  Result<GameState> state = decode_state(players, reader);
  if (!state) return state.status();
  return Parts{state.value(), reader.get_bytes(reader.remaining())};
}

Status ArenaSimulation::load(SnapshotKind kind, ByteView bytes) {
  if (kind == SnapshotKind::native) {
    if (bytes.size() < sizeof(GameState)) return Status::truncated;
    const Status status = arena_.world.load(kind, bytes.subspan(sizeof(GameState)));
    if (status == Status::ok) std::memcpy(&arena_.state, bytes.data(), sizeof(GameState));
    return status;
  }
  const Result<Parts> parts = split(bytes);
  if (!parts) return parts.status();
  const Status status = arena_.world.load(kind, parts.value().world);
  if (status == Status::ok) arena_.state = parts.value().state;
  return status;
}

std::uint64_t ArenaSimulation::hash() const {
  std::array<std::byte, k_max_state_bytes> bytes;
  ByteWriter writer(bytes);
  encode_state(arena_.state, arena_.config.players, writer);
  return hash64(writer.written(), arena_.world.hash().total ^ k_hash_seed);
}

std::size_t ArenaSimulation::part_hashes(std::span<PartHash, k_max_state_parts> out) const {
  std::array<std::byte, k_max_state_bytes> bytes;
  ByteWriter writer(bytes);
  encode_state(arena_.state, arena_.config.players, writer);
  const StateHash128 world = arena_.world.hash128();
  out[0] = {"rules", hash128(writer.written(), k_hash_seed)};
  out[1] = {"world", world.header};
  out[2] = {"bodies", world.bodies};
  out[3] = {"contacts", world.contacts};
  out[4] = {"joints", world.joints};
  return 5;
}

std::string ArenaSimulation::name_of_body(ByteView world_bytes, std::uint64_t index) const {
  Result<World> world = World::create(arena_.world.def());
  if (!world || world.value().load(SnapshotKind::canonical, world_bytes) != Status::ok) return {};
  if (index >= world.value().body_limit()) return {};
  const BodyHandle body = world.value().body_at(static_cast<std::uint32_t>(index));
  return body.is_null() ? std::string{} : tag_of(world.value(), body).name();
}

StateDifference ArenaSimulation::describe(ByteView here, ByteView there) const {
  const Result<Parts> left = split(here);
  const Result<Parts> right = split(there);
  if (!left || !right) {
    const auto text = [](const auto& parts) { return std::string(to_string(parts.status())); };
    if (left.status() == right.status()) return {};
    return {true, "snapshot", 0, {}, "format", text(left), text(right)};
  }
  const auto& [state, world] = left.value();
  StateDifference difference = first_difference(state, right.value().state, arena_.config.players);
  if (difference.differs) return difference;
  difference = arena_.world.describe_difference(world, right.value().world);
  // A simulation that did not step itself made no snowballs, and has no names of them.
  if (difference.store == "body" && difference.name.empty())
    difference.name = name_of_body(world, difference.object);
  return difference;
}

Result<std::unique_ptr<Simulation>> make_arena(ByteView bytes) {
  const Result<ArenaConfig> config = ArenaConfig::decode(bytes);
  if (!config) return config.status();
  return std::unique_ptr<Simulation>(std::make_unique<ArenaSimulation>(config.value()));
}

}  // namespace lockstone::arena
