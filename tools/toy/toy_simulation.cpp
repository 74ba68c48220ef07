#include "tools/toy/toy_simulation.h"

#include <array>
#include <cstring>
#include <string>

#include <lockstone/assert.h>
#include <lockstone/hash.h>

namespace lockstone::toy {
namespace {

constexpr std::uint32_t k_config_magic = 0x43594f54;    // "TOYC"
constexpr std::uint32_t k_snapshot_magic = 0x53594f54;  // "TOYS"
constexpr std::uint16_t k_version = 1;
constexpr std::size_t k_config_bytes = 20;
constexpr std::size_t k_snapshot_header_bytes = 10;

constexpr std::array<std::string_view, 2> k_world_fields{"tick", "random"};
constexpr std::array<std::string_view, 3> k_player_fields{"score", "buttons", "braking"};
constexpr std::array<std::string_view, 6> k_body_fields{"position.x", "position.y", "velocity.x",
                                                        "velocity.y", "spin",       "heat"};
constexpr std::array<std::string_view, 4> k_body_names{"crate", "barrel", "ball", "plank"};

constexpr std::size_t k_tick = 0;
constexpr std::size_t k_random = 1;
constexpr std::size_t k_score = 0;
constexpr std::size_t k_buttons = 1;
constexpr std::size_t k_braking = 2;
constexpr std::size_t k_position = 0;  // x, then y
constexpr std::size_t k_velocity = 2;  // x, then y
constexpr std::size_t k_spin = 4;
constexpr std::size_t k_heat = 5;
constexpr std::uint64_t k_wall = 1U << 20;

std::uint64_t mix(std::uint64_t value) {
  // splitmix64's finaliser: Sebastiano Vigna, public domain.
  value += 0x9e3779b97f4a7c15ULL;
  value = (value ^ (value >> 30)) * 0xbf58476d1ce4e5b9ULL;
  value = (value ^ (value >> 27)) * 0x94d049bb133111ebULL;
  return value ^ (value >> 31);
}

bool is_negative(std::uint64_t word) {
  return (word >> 63) != 0;
}
std::uint64_t negated(std::uint64_t word) {
  return 0 - word;
}
std::uint64_t magnitude(std::uint64_t word) {
  return is_negative(word) ? negated(word) : word;
}

// An eighth of a two's complement word, towards zero. Words wrap, so nothing can overflow.
std::uint64_t eighth(std::uint64_t word) {
  return is_negative(word) ? negated(negated(word) >> 3) : word >> 3;
}

std::uint64_t sign_extended(std::byte byte) {
  const auto bits = std::to_integer<std::uint64_t>(byte);
  return (bits ^ 0x80) - 0x80;
}

std::size_t word_count(const ToyConfig& config) {
  return k_world_fields.size() + config.player_count * k_player_fields.size() +
         config.body_count * k_body_fields.size();
}

bool in_range(const ToyConfig& config) {
  return config.tick_rate >= 1 && config.tick_rate <= 1000 && config.player_count >= 1 &&
         config.player_count <= k_max_players && config.body_count >= config.player_count &&
         config.body_count <= 256 && config.input_bytes >= 4 &&
         config.input_bytes <= k_max_input_bytes;
}

// This build's hash of a short match: a constant unless the rules change.
std::uint64_t canary() {
  static thread_local bool computing = false;  // the canary's own simulation has none
  if (computing) return 0;
  computing = true;
  static const std::uint64_t value = [] {
    ToySimulation simulation(ToyConfig{.seed = 99, .body_count = 8});
    std::array<std::byte, 4> bytes{};
    for (std::uint64_t tick = 0; tick < 16; ++tick) {
      toy_input(99, 0, tick, bytes);
      const std::array<PlayerInput, 2> inputs{PlayerInput{bytes}, PlayerInput{bytes}};
      simulation.step(inputs);
    }
    return simulation.hash();
  }();
  computing = false;
  return value;
}

}  // namespace

struct ToySimulation::Place {
  std::string_view store;
  std::uint64_t object = 0;
  std::string_view name;
  std::string_view field;
};

std::vector<std::byte> ToyConfig::encode() const {
  std::vector<std::byte> bytes(k_config_bytes);
  ByteWriter writer(bytes);
  writer.put(k_config_magic);
  writer.put(k_version);
  writer.put(seed);
  writer.put(tick_rate);
  writer.put(body_count);
  writer.put(player_count);
  writer.put(input_bytes);
  LKS_CHECK(writer.ok() && writer.size() == k_config_bytes);
  return bytes;
}

Result<ToyConfig> ToyConfig::decode(ByteView bytes) {
  ByteReader reader(bytes);
  const auto magic = reader.get<std::uint32_t>();
  const auto version = reader.get<std::uint16_t>();
  ToyConfig config;
  config.seed = reader.get<std::uint64_t>();
  config.tick_rate = reader.get<std::uint16_t>();
  config.body_count = reader.get<std::uint16_t>();
  config.player_count = reader.get<std::uint8_t>();
  config.input_bytes = reader.get<std::uint8_t>();
  if (!reader.ok()) return Status::truncated;
  if (magic != k_config_magic || reader.remaining() != 0) return Status::malformed;
  if (version != k_version) return Status::unsupported_version;
  if (!in_range(config)) return Status::invalid_argument;
  return config;
}

ToySimulation::ToySimulation(const ToyConfig& config) : config_(config) {
  LKS_CHECK(in_range(config));
  words_.resize(word_count(config));
  words_[k_random] = mix(config.seed);
  for (std::size_t body = 0; body < config.body_count; ++body) {
    const std::uint64_t bits = mix(config.seed ^ (body << 32));
    words_[body_word(body, k_position)] = (bits & 0xfffff) - 0x80000;
    words_[body_word(body, k_position + 1)] = ((bits >> 20) & 0xfffff) - 0x80000;
    words_[body_word(body, k_velocity)] = ((bits >> 40) & 0xfff) - 0x800;
    words_[body_word(body, k_velocity + 1)] = ((bits >> 52) & 0xfff) - 0x800;
  }
  info_.abi = 1;
  info_.config_hash = hash64(config.encode());
  info_.scene_hash = hash();
  info_.canary = canary();
  info_.tick_rate = config.tick_rate;
  info_.player_count = config.player_count;
  info_.input_bytes = config.input_bytes;
}

std::size_t ToySimulation::body_word(std::size_t body, std::size_t field) const {
  return k_world_fields.size() + config_.player_count * k_player_fields.size() +
         body * k_body_fields.size() + field;
}

void ToySimulation::step(std::span<const PlayerInput> inputs) {
  LKS_CHECK(inputs.size() == config_.player_count);
  for (std::size_t slot = 0; slot < inputs.size(); ++slot)
    apply_input(slot, inputs[slot]);
  for (std::size_t body = 0; body < config_.body_count; ++body)
    move_body(body);
  for (std::size_t body = 1; body < config_.body_count; ++body)
    pass_momentum(body - 1, body);
  words_[k_random] = mix(words_[k_random]);
  ++words_[k_tick];
}

void ToySimulation::command(const PlayerCommand& command) {
  words_[k_random] = mix(words_[k_random] ^ hash64(command.bytes, command.slot));
  if (command.slot >= config_.player_count) return;
  words_[k_world_fields.size() + command.slot * k_player_fields.size() + k_score] +=
      command.bytes.size() / 1000;
}

void ToySimulation::apply_input(std::size_t slot, const PlayerInput& input) {
  LKS_CHECK(input.bytes.size() == config_.input_bytes);
  std::uint64_t* player = &words_[k_world_fields.size() + slot * k_player_fields.size()];
  std::uint64_t* body = &words_[body_word(slot, 0)];
  // The origin is part of the tick, so a game may use it: an absent player brakes.
  player[k_braking] = input.origin == InputOrigin::absent ? 1 : 0;
  body[k_velocity] += sign_extended(input.bytes[0]) * 16;
  body[k_velocity + 1] += sign_extended(input.bytes[1]) * 16;
  player[k_buttons] = std::to_integer<std::uint64_t>(input.bytes[2]);
  for (std::byte extra : input.bytes.subspan(4))
    body[k_heat] += std::to_integer<unsigned>(extra);
  if ((player[k_buttons] & 1) == 0) return;
  const std::size_t target = std::to_integer<std::size_t>(input.bytes[3]) % config_.body_count;
  words_[body_word(target, k_spin)] += (words_[k_random] >> 60) + slot + 1;
  ++player[k_score];
}

void ToySimulation::move_body(std::size_t body) {
  std::uint64_t* words = &words_[body_word(body, 0)];
  const bool braking =
      body < config_.player_count &&
      words_[k_world_fields.size() + body * k_player_fields.size() + k_braking] != 0;
  for (std::size_t axis = 0; axis < 2; ++axis) {
    std::uint64_t& position = words[k_position + axis];
    std::uint64_t& velocity = words[k_velocity + axis];
    if (braking) velocity -= eighth(velocity);
    position += velocity;
    if (magnitude(position) > k_wall && is_negative(position) == is_negative(velocity)) {
      velocity = negated(velocity - eighth(velocity));
    }
  }
  words[k_heat] += words[k_spin] & 0xff;
}

void ToySimulation::pass_momentum(std::size_t a, std::size_t b) {
  std::uint64_t* first = &words_[body_word(a, 0)];
  std::uint64_t* second = &words_[body_word(b, 0)];
  for (std::size_t axis = 0; axis < 2; ++axis) {
    const std::uint64_t gap = first[k_position + axis] - second[k_position + axis];
    if (magnitude(gap) > k_wall / 4) continue;
    const std::uint64_t share = eighth(first[k_velocity + axis] - second[k_velocity + axis]);
    first[k_velocity + axis] -= share;
    second[k_velocity + axis] += share;
  }
}

std::size_t ToySimulation::snapshot_bytes_max(SnapshotKind kind) const {
  const std::size_t header_bytes = kind == SnapshotKind::canonical ? k_snapshot_header_bytes : 0;
  return header_bytes + words_.size() * sizeof(std::uint64_t);
}

std::size_t ToySimulation::save(SnapshotKind kind, std::span<std::byte> out) const {
  LKS_CHECK(out.size() >= snapshot_bytes_max(kind));
  if (kind == SnapshotKind::native) {
    std::memcpy(out.data(), words_.data(), words_.size() * sizeof(std::uint64_t));
    return words_.size() * sizeof(std::uint64_t);
  }
  ByteWriter writer(out);
  writer.put(k_snapshot_magic);
  writer.put(k_version);
  writer.put(static_cast<std::uint16_t>(config_.player_count));
  writer.put(config_.body_count);
  for (std::uint64_t word : words_)
    writer.put(word);
  return writer.size();
}

Result<std::size_t> ToySimulation::check_canonical(ByteView bytes) const {
  ByteReader reader(bytes);
  const auto magic = reader.get<std::uint32_t>();
  const auto version = reader.get<std::uint16_t>();
  const auto players = reader.get<std::uint16_t>();
  const auto bodies = reader.get<std::uint16_t>();
  if (!reader.ok()) return Status::truncated;
  if (magic != k_snapshot_magic) return Status::malformed;
  if (version != k_version) return Status::unsupported_version;
  if (players != config_.player_count || bodies != config_.body_count) return Status::incompatible;
  const std::size_t expected_bytes = words_.size() * sizeof(std::uint64_t);
  if (reader.remaining() < expected_bytes) return Status::truncated;
  if (reader.remaining() > expected_bytes) return Status::malformed;
  return reader.position();
}

Status ToySimulation::load(SnapshotKind kind, ByteView bytes) {
  if (kind == SnapshotKind::native) {
    if (bytes.size() != words_.size() * sizeof(std::uint64_t)) return Status::malformed;
    std::memcpy(words_.data(), bytes.data(), bytes.size());
    return Status::ok;
  }
  const Result<std::size_t> start = check_canonical(bytes);
  if (!start) return start.status();
  ByteReader reader(bytes.subspan(start.value()));
  for (std::uint64_t& word : words_)
    word = reader.get<std::uint64_t>();
  return Status::ok;
}

Hash128 ToySimulation::hash_words(std::size_t begin, std::size_t end) const {
  Hash128 result;
  for (std::size_t word = begin; word < end; ++word) {
    std::array<std::byte, 24> bytes{};
    ByteWriter writer(bytes);
    writer.put(result.low);
    writer.put(result.high);
    writer.put(words_[word]);
    result = hash128(bytes);
  }
  return result;
}

std::size_t ToySimulation::part_hashes(std::span<PartHash, k_max_state_parts> out) const {
  const std::size_t players = k_world_fields.size();
  const std::size_t bodies = players + config_.player_count * k_player_fields.size();
  out[0] = {"world", hash_words(0, players)};
  out[1] = {"players", hash_words(players, bodies)};
  out[2] = {"bodies", hash_words(bodies, words_.size())};
  return 3;
}

std::uint64_t ToySimulation::hash() const {
  // Words are hashed in blocks on the stack, so that the hash knows no byte order.
  std::array<std::byte, 512> block;
  std::uint64_t result = 0;
  for (std::size_t word = 0; word < words_.size();) {
    ByteWriter writer(block);
    for (; word < words_.size() && writer.size() < block.size(); ++word)
      writer.put(words_[word]);
    result = hash64(writer.written(), result);
  }
  return result;
}

ToySimulation::Place ToySimulation::place_of(std::size_t word) const {
  if (word < k_world_fields.size()) return {"world", 0, "", k_world_fields[word]};
  word -= k_world_fields.size();
  const std::size_t player_words = config_.player_count * k_player_fields.size();
  if (word < player_words) {
    return {"player", word / k_player_fields.size(), "",
            k_player_fields[word % k_player_fields.size()]};
  }
  word -= player_words;
  const std::size_t body = word / k_body_fields.size();
  return {"body", body, k_body_names[body % k_body_names.size()],
          k_body_fields[word % k_body_fields.size()]};
}

std::optional<std::size_t> ToySimulation::find(std::string_view store, std::uint64_t object,
                                               std::string_view field) const {
  for (std::size_t word = 0; word < words_.size(); ++word) {
    const Place place = place_of(word);
    if (place.store == store && place.object == object && place.field == field) return word;
  }
  return std::nullopt;
}

bool ToySimulation::flip_bit(std::string_view store, std::uint64_t object, std::string_view field,
                             unsigned bit) {
  const std::optional<std::size_t> word = find(store, object, field);
  if (!word || bit > 63) return false;
  words_[*word] ^= std::uint64_t{1} << bit;
  return true;
}

StateDifference ToySimulation::describe(ByteView here, ByteView there) const {
  StateDifference difference;
  const Result<std::size_t> here_start = check_canonical(here);
  const Result<std::size_t> there_start = check_canonical(there);
  if (!here_start || !there_start) return difference;
  ByteReader here_reader(here.subspan(here_start.value()));
  ByteReader there_reader(there.subspan(there_start.value()));
  for (std::size_t word = 0; word < words_.size(); ++word) {
    const auto here_value = here_reader.get<std::uint64_t>();
    const auto there_value = there_reader.get<std::uint64_t>();
    if (here_value == there_value) continue;
    const Place place = place_of(word);
    return {true,
            std::string(place.store),
            place.object,
            std::string(place.name),
            std::string(place.field),
            hexadecimal(here_value),
            hexadecimal(there_value)};
  }
  return difference;
}

// The last word saved is the last body's heat.
std::size_t ForgetfulToy::save(SnapshotKind kind, std::span<std::byte> out) const {
  const std::size_t size = ToySimulation::save(kind, out);
  ByteWriter(out.subspan(size - 8)).put(std::uint64_t{1});
  return size;
}

void toy_input(std::uint64_t seed, std::size_t slot, std::uint64_t tick, std::span<std::byte> out) {
  // Players hold a choice for some ticks, as people do; run-length coding relies on that.
  std::uint64_t bits = mix(seed ^ (slot << 56) ^ ((tick + slot) / 7));
  for (std::byte& byte : out) {
    byte = static_cast<std::byte>(bits & 0xff);
    bits = (bits >> 8) | (bits << 56);
  }
}

}  // namespace lockstone::toy
