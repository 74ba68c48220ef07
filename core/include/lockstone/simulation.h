// The seam between a game and everything that carries it over a network or through a file.
//
// `net` and `replay` know a game only as a Simulation: bytes in, bytes out. A game implements it
// once, on top of lockstone::World or of anything else that is deterministic. One object is used by
// one thread at a time.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>

#include <lockstone/bytes.h>
#include <lockstone/hash.h>
#include <lockstone/status.h>

namespace lockstone {

/// Bound on the player slots of a match, and on the bytes of one player's input for one tick.
inline constexpr std::size_t k_max_players = 64;
inline constexpr std::size_t k_max_input_bytes = 64;

/// Two peers must agree on all of this before they play.
struct SimulationInfo {
  std::uint32_t abi = 0;          ///< changes whenever the same inputs may give another state
  std::uint64_t config_hash = 0;  ///< rules, capacities and parameters
  std::uint64_t scene_hash = 0;   ///< the state before the first tick
  std::uint64_t canary = 0;       ///< this build's hash of a short built-in scene
  std::uint16_t tick_rate = 60;   ///< ticks per second
  std::uint8_t player_count = 0;  ///< slots, 1 … k_max_players
  std::uint8_t input_bytes = 0;   ///< size of one player's input, 1 … k_max_input_bytes

  friend bool operator==(const SimulationInfo&, const SimulationInfo&) = default;
};

/// Where a slot's input for a tick came from. Part of the tick: every peer sees the same.
enum class InputOrigin : std::uint8_t {
  received = 0,  ///< sent by the player in time
  repeated = 1,  ///< late: the server repeated the player's last input
  neutral = 2,   ///< late: the server used an all-zero input
  absent = 3,    ///< nobody sits in this slot; the bytes are all zero
};
[[nodiscard]] std::string_view to_string(InputOrigin origin);

/// One player's input for one tick; `bytes` always has SimulationInfo::input_bytes bytes. They come
/// from outside: a simulation accepts any values.
struct PlayerInput {
  ByteView bytes;
  InputOrigin origin = InputOrigin::received;
};

/// Bound on the bytes of one player command.
inline constexpr std::size_t k_max_command_bytes = 64 * 1024;

/// The slot of commands that come from the server itself.
inline constexpr std::uint8_t k_server_slot = 253;

/// Bytes that change a game but are not the input of a tick: a line of chat, a purchase, a build
/// order. The server binds each command to a tick.
struct PlayerCommand {
  std::uint8_t slot = 0;  ///< of the player that gave it, or k_server_slot
  ByteView bytes;         ///< 1 … k_max_command_bytes
};

enum class SnapshotKind : std::uint8_t {
  native,     ///< for rollback: this process only, as fast as a copy
  canonical,  ///< little-endian and versioned: for other machines, late joiners, logs
};
[[nodiscard]] std::string_view to_string(SnapshotKind kind);

/// An integer as differences show it: "0x", and two digits for each byte of its type.
template <class T>
[[nodiscard]] std::string hexadecimal(T value) {
  constexpr char k_digits[] = "0123456789abcdef";
  auto bits = static_cast<std::make_unsigned_t<T>>(value);
  std::string text(sizeof(T) * 2, '0');
  for (std::size_t i = text.size(); i-- > 0; bits = static_cast<decltype(bits)>(bits >> 4))
    text[i] = k_digits[bits & 0xf];
  return text.insert(0, "0x");
}

/// A part of the state, and 128 bits for it. The name is for people and lives as long as the
/// program.
struct PartHash {
  std::string_view name;
  Hash128 hash;
};
inline constexpr std::size_t k_max_state_parts = 8;

/// The first difference between two states, in canonical order. Text is for people.
struct StateDifference {
  bool differs = false;
  std::string store;         ///< "body", "contact", "world", …
  std::uint64_t object = 0;  ///< index within the store
  std::string name;          ///< the game's name of the object, may be empty
  std::string field;         ///< "velocity.y"
  std::string here;          ///< raw value as `hexadecimal` writes it, then a quantity in its
  std::string there;         ///< unit: "0x000000003a1cac08 (0.227 m/s)"

  /// `body 17 "crate", velocity.y: 0x0003a2f1 here, 0x0003a2f0 there`, or "no difference".
  [[nodiscard]] std::string to_line() const;
};

/// Islands of one step: those that were computed, and those whose results a history remembered.
struct IslandWork {
  std::uint32_t computed = 0;
  std::uint32_t recalled = 0;
};

/// A deterministic game. `step`, `save`, `load` and the hashes must not allocate after creation.
class Simulation {
 public:
  virtual ~Simulation() = default;

  [[nodiscard]] virtual SimulationInfo info() const = 0;

  /// Ticks stepped since the beginning of the match.
  [[nodiscard]] virtual std::uint64_t tick() const = 0;

  /// Advances by one tick. `inputs` has info().player_count entries in slot order.
  virtual void step(std::span<const PlayerInput> inputs) = 0;

  /// A command of the next tick. Called right before `step`, on every peer in the same order, and
  /// only for confirmed ticks. The bytes come from outside, as those of inputs. Must not allocate.
  virtual void command(const PlayerCommand& /*command*/) {}

  /// An upper bound on the bytes that `save` writes, constant over the match.
  [[nodiscard]] virtual std::size_t snapshot_bytes_max(SnapshotKind kind) const = 0;

  /// Writes the whole state; returns the number of bytes. `out` has snapshot_bytes_max(kind) bytes.
  [[nodiscard]] virtual std::size_t save(SnapshotKind kind, std::span<std::byte> out) const = 0;

  /// Replaces the whole state. On any status but ok the old state is untouched.
  virtual Status load(SnapshotKind kind, ByteView bytes) = 0;

  /// From here on remembers the last `ticks` ticks, so that stepping them again costs as much as
  /// differs (RollbackHistory); 0, as at first: none. No result depends on it. May allocate. A
  /// client that predicts asks for it; a simulation may do nothing.
  virtual void keep_history(std::uint32_t /*ticks*/) {}

  /// Forgets the remembered ticks: the next steps simulate in full.
  virtual void forget_history() {}

  /// Of the last step, for statistics: no part of the state. Zero without a history.
  [[nodiscard]] virtual IslandWork island_work() const { return {}; }

  /// A hash over everything that can change the future.
  [[nodiscard]] virtual std::uint64_t hash() const = 0;

  /// Hashes of all parts of the state, at most k_max_state_parts, always the same ones in the same
  /// order; returns their number. A session compares them every 64 ticks, and so finds and locates
  /// differences that a hash of 64 bits can miss. Without this it compares `hash` alone.
  [[nodiscard]] virtual std::size_t part_hashes(std::span<PartHash, k_max_state_parts>) const {
    return 0;
  }

  /// Compares two canonical snapshots of this simulation. For people: may allocate, may be slow.
  [[nodiscard]] virtual StateDifference describe(ByteView here, ByteView there) const = 0;
};

/// Advances by one tick with its commands.
inline void step_tick(Simulation& simulation, std::span<const PlayerInput> inputs,
                      std::span<const PlayerCommand> commands) {
  for (const PlayerCommand& command : commands)
    simulation.command(command);
  simulation.step(inputs);
}

/// Makes a simulation at tick 0 from the game's own configuration bytes (scene, seed, rules). The
/// same bytes give the same simulation everywhere; bytes that the game does not know give an error.
using SimulationFactory = std::function<Result<std::unique_ptr<Simulation>>(ByteView config)>;

}  // namespace lockstone
