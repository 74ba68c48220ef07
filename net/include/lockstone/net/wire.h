// The messages of a session, byte for byte as in docs/reference/wire-format.md.
//
// `encode` writes one message into the caller's buffer and returns its size, 0 if it does not fit.
// `decode` checks every byte before it returns ok: types, lengths, ranges, nothing left over. On
// any other status the message's content is unspecified and must not be used. Neither allocates.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <span>
#include <string_view>

#include <lockstone/bytes.h>
#include <lockstone/net/player_name.h>
#include <lockstone/net/reasons.h>
#include <lockstone/net/slot_mask.h>
#include <lockstone/net/transport.h>
#include <lockstone/simulation.h>
#include <lockstone/status.h>

namespace lockstone::net {

inline constexpr std::uint32_t k_protocol_magic = 0x4e534b4c;  ///< "LKSN"
inline constexpr std::uint16_t k_protocol_version = 5;
inline constexpr std::uint8_t k_any_slot = 255;
inline constexpr std::uint64_t k_max_tick = std::uint64_t{1} << 62;  ///< no tick or count is above
inline constexpr std::size_t k_max_text_bytes = 96;
inline constexpr std::size_t k_max_build_bytes = 64;
inline constexpr std::size_t k_max_config_bytes = 32 * 1024;
inline constexpr std::size_t k_max_chunk_bytes = 8 * 1024;
inline constexpr std::size_t k_max_hashes_per_message = 32;
inline constexpr std::size_t k_max_ticks_per_message = 255;
inline constexpr std::uint64_t k_parts_interval_ticks = 64;
inline constexpr std::size_t k_max_message_bytes = k_max_config_bytes + 64;
static_assert(k_max_message_bytes <= k_max_reliable_bytes);

enum class MessageType : std::uint8_t {
  hello = 1,
  offer = 2,
  answer = 3,
  welcome = 4,
  refuse = 5,
  start = 6,
  inputs = 7,
  ticks = 8,
  resend = 9,
  desync = 10,
  dump_request = 11,
  dump = 12,
  finish = 13,
  bye = 14,
  snapshot = 15,
  snapshot_taken = 16,
  activate = 17,
  ask = 18,
  paused = 19,
  parts = 20,
  named = 21,
  command = 22,
  tick_command = 23,
  command_result = 24,
};
[[nodiscard]] std::string_view to_string(MessageType type);

/// Text of bounded length: printable ASCII on the wire.
template <std::size_t k_capacity>
class FixedText {
 public:
  FixedText() = default;
  /// Cuts text that does not fit; other characters than printable ASCII become '?'.
  explicit FixedText(std::string_view text) {
    size_ = std::min(text.size(), k_capacity);
    for (std::size_t i = 0; i < size_; ++i) {
      chars_[i] = text[i] >= ' ' && text[i] <= '~' ? text[i] : '?';
    }
  }
  [[nodiscard]] std::string_view view() const { return {chars_.data(), size_}; }

 private:
  std::array<char, k_capacity> chars_{};
  std::size_t size_ = 0;
};
using FieldText = FixedText<k_max_text_bytes>;
using BuildText = FixedText<k_max_build_bytes>;

/// Client: the first message. With another `protocol` the rest is not read and keeps its defaults.
struct Hello {
  std::uint16_t protocol = k_protocol_version;
  bool insecure = false;                  ///< asks for a session without encryption
  std::uint8_t wanted_slot = k_any_slot;  ///< 0 … k_max_players - 1, k_spectator_slot, k_any_slot
  std::uint64_t rejoin_key = 0;           ///< from an earlier Welcome; 0: never was here
  std::uint64_t ticks_stepped = 0;        ///< the state after this many ticks is still here
  std::uint64_t state_hash = 0;           ///< its hash; 0 after 0 ticks
  PlayerName name;
  BuildText build;  ///< of the game, and the processor: for reports
};

/// Server: the configuration of the simulation. `config` points into the decoded packet.
struct Offer {
  bool insecure = false;
  ByteView config;
};

/// Client: the simulation that its build made of the configuration.
struct Answer {
  SimulationInfo info;
};

/// Where somebody who is seated begins.
enum class Entry : std::uint8_t {
  lobby = 0,     ///< at tick 0, with everybody else, when Start comes
  ticks = 1,     ///< where it was: the ticks since then follow
  snapshot = 2,  ///< at a state that follows in pieces
};
[[nodiscard]] std::string_view to_string(Entry entry);

/// Server: the client sits in `slot`.
struct Welcome {
  std::uint8_t slot = 0;
  std::uint8_t player_count = 0;
  std::uint8_t input_delay_ticks = 0;  ///< 0 … k_max_input_delay_ticks
  LatePolicy late_policy = LatePolicy::deadline;
  Pacing pacing = Pacing::real_time;
  std::uint64_t tick_count = 0;  ///< 0: until stopped
  Entry entry = Entry::lobby;
  std::uint64_t rejoin_key = 0;      ///< opens the same seat again
  std::uint64_t commands_taken = 0;  ///< the seat's commands that came whole, or were refused
};

/// Server: the client does not play. `here` is the server's value, `there` the client's.
struct Refuse {
  RefuseReason reason = RefuseReason::none;
  RefuseField field = RefuseField::none;
  std::uint64_t here = 0;
  std::uint64_t there = 0;
};

/// Server: all are seated, tick 0 begins.
struct Start {
  SlotMask present_mask = 0;  ///< bit n: somebody sits in slot n
};

/// How long the parts of a tick are.
struct TickShape {
  std::uint8_t player_count = 0;
  std::uint8_t input_bytes = 0;

  [[nodiscard]] std::size_t origin_bytes() const { return (player_count + std::size_t{3}) / 4; }
  /// Two bits of origin a slot, every slot's input, and the number of commands.
  [[nodiscard]] std::size_t record_bytes() const {
    return origin_bytes() + std::size_t{player_count} * input_bytes + 1;
  }
};
/// So that the largest tick fits into one datagram.
inline constexpr std::size_t k_max_tick_input_bytes = 1024;  ///< of all players together
inline constexpr std::size_t k_max_record_bytes =
    (k_max_players + 3) / 4 + k_max_tick_input_bytes + 1;

/// The commands of one tick.
inline constexpr std::size_t k_max_tick_commands = 255;
inline constexpr std::size_t k_max_tick_command_bytes = 256 * 1024;

/// No inputs came since the last time that a margin was told.
inline constexpr std::int8_t k_no_margin = -128;

/// Client: its inputs from `first_tick` on, in `coded` for a RecordReader of input_bytes; the ticks
/// it has; and the hashes that the server has not acknowledged.
struct Inputs {
  std::uint64_t ticks_received = 0;  ///< confirmed ticks 0 … ticks_received - 1 are here
  std::uint64_t first_tick = 0;
  std::uint8_t count = 0;
  std::uint64_t first_hash_tick = 0;
  std::uint8_t hash_count = 0;  ///< 0 … k_max_hashes_per_message
  std::array<std::uint64_t, k_max_hashes_per_message> hashes{};
  ByteView coded;
};

/// Server: confirmed ticks from `first_tick` on, in `coded` for a RecordReader of record_bytes.
struct Ticks {
  std::uint64_t first_tick = 0;
  std::uint8_t count = 0;
  std::uint64_t ticks_confirmed = 0;          ///< how many ticks the server has confirmed
  std::uint64_t inputs_received = 0;          ///< this client need not send inputs below
  std::uint64_t hashes_received = 0;          ///< this client need not send hashes below
  SlotMask waiting_mask = 0;                  ///< slots that the match waits for (strict)
  std::int8_t margin_quarters = k_no_margin;  ///< how early the last inputs came, quarter ticks
  ByteView coded;
};

/// Client: confirmed ticks that are missing between others.
struct Resend {
  std::uint64_t first_tick = 0;
  std::uint16_t count = 0;
};

/// Server: states differ. The texts are StateDifference's; `differs` is false without dumps.
struct DesyncNotice {
  std::uint64_t tick = 0;
  std::uint8_t slot = 0;
  Verdict verdict = Verdict::undecided;
  std::uint64_t hash_here = 0;
  std::uint64_t hash_there = 0;
  bool differs = false;
  std::uint64_t object = 0;
  FieldText store, name, field, here, there;
};

/// Server: the canonical snapshot after `tick`, please.
struct DumpRequest {
  std::uint64_t tick = 0;
};

/// Client: a piece of it; total_bytes 0 says that it is not kept any more.
struct Dump {
  std::uint64_t tick = 0;
  std::uint32_t total_bytes = 0;
  std::uint32_t offset_bytes = 0;
  ByteView chunk;  ///< at most k_max_chunk_bytes
};

/// Server: the match is over.
struct Finish {
  FinishReason reason = FinishReason::completed;
  std::uint64_t ticks = 0;
  bool has_hash = false;
  std::uint64_t hash = 0;
};

/// Server: a piece of a canonical snapshot, to begin from.
struct Snapshot {
  std::uint64_t ticks = 0;  ///< the state after this many ticks
  std::uint64_t hash = 0;   ///< its expected hash
  std::uint32_t total_bytes = 0;
  std::uint32_t offset_bytes = 0;
  ByteView chunk;  ///< 1 … k_max_chunk_bytes
};

/// Client: a snapshot was loaded, or is wrong.
struct SnapshotTaken {
  std::uint64_t ticks = 0;
  bool good = false;
};

/// Server: from `tick` on, `slot` plays.
struct Activate {
  std::uint8_t slot = 0;
  std::uint64_t tick = 0;
};

/// Client: a request; the owner of the server decides how to act on it.
struct Ask {
  AskKind kind = AskKind::pause;
  std::uint8_t topic = 0;   ///< the subject of a vote
  std::uint8_t choice = 0;  ///< of a vote
};

/// Server: the match stands still, or goes on.
struct Paused {
  bool paused = false;
};

/// Client: hashes of its state's parts, every k_parts_interval_ticks.
struct Parts {
  std::uint64_t ticks = 0;  ///< of the state after this many ticks, a multiple of the interval
  std::uint8_t count = 0;   ///< 1 … k_max_state_parts
  std::array<Hash128, k_max_state_parts> hashes{};
};

/// Server: the name of the player that sits in `slot`, or sat there last.
struct Named {
  std::uint8_t slot = 0;
  PlayerName name;
};

/// Client: a piece of a command.
struct CommandPiece {
  std::uint32_t total_bytes = 0;  ///< 1 … k_max_command_bytes
  std::uint32_t offset_bytes = 0;
  ByteView chunk;  ///< 1 … k_max_chunk_bytes
};

/// Server: a piece of a command that belongs to a tick.
struct TickCommand {
  std::uint64_t tick = 0;
  std::uint8_t slot = 0;  ///< of a player, or k_server_slot
  std::uint32_t total_bytes = 0;
  std::uint32_t offset_bytes = 0;
  ByteView chunk;
};

/// Server: this client's command came whole, or is refused.
struct CommandResult {
  std::uint64_t number = 0;  ///< among all commands of the seat, from 0 on
  bool taken = false;
};

/// Either: the last message of a connection.
struct Bye {
  LeaveReason reason = LeaveReason::left;
};

/// The type of a packet's message; malformed if empty or unknown.
[[nodiscard]] Result<MessageType> message_type(ByteView packet);

[[nodiscard]] std::size_t encode(const Hello& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Offer& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Answer& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Welcome& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Refuse& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Start& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Inputs& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Ticks& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Resend& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const DesyncNotice& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const DumpRequest& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Dump& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Finish& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Snapshot& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const SnapshotTaken& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Activate& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Ask& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Paused& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Parts& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Named& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const CommandPiece& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const TickCommand& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const CommandResult& message, std::span<std::byte> out);
[[nodiscard]] std::size_t encode(const Bye& message, std::span<std::byte> out);

[[nodiscard]] Status decode(ByteView packet, Hello& message);
[[nodiscard]] Status decode(ByteView packet, Offer& message);
[[nodiscard]] Status decode(ByteView packet, Answer& message);
[[nodiscard]] Status decode(ByteView packet, Welcome& message);
[[nodiscard]] Status decode(ByteView packet, Refuse& message);
[[nodiscard]] Status decode(ByteView packet, Start& message);
[[nodiscard]] Status decode(ByteView packet, std::size_t input_bytes, Inputs& message);
[[nodiscard]] Status decode(ByteView packet, TickShape shape, Ticks& message);
[[nodiscard]] Status decode(ByteView packet, Resend& message);
[[nodiscard]] Status decode(ByteView packet, DesyncNotice& message);
[[nodiscard]] Status decode(ByteView packet, DumpRequest& message);
[[nodiscard]] Status decode(ByteView packet, Dump& message);
[[nodiscard]] Status decode(ByteView packet, Finish& message);
[[nodiscard]] Status decode(ByteView packet, Snapshot& message);
[[nodiscard]] Status decode(ByteView packet, SnapshotTaken& message);
[[nodiscard]] Status decode(ByteView packet, Activate& message);
[[nodiscard]] Status decode(ByteView packet, Ask& message);
[[nodiscard]] Status decode(ByteView packet, Paused& message);
[[nodiscard]] Status decode(ByteView packet, Parts& message);
[[nodiscard]] Status decode(ByteView packet, Named& message);
[[nodiscard]] Status decode(ByteView packet, CommandPiece& message);
[[nodiscard]] Status decode(ByteView packet, TickCommand& message);
[[nodiscard]] Status decode(ByteView packet, CommandResult& message);
[[nodiscard]] Status decode(ByteView packet, Bye& message);

/// Header bytes of Inputs (without hashes) and Ticks: the rest of a datagram holds the records.
inline constexpr std::size_t k_inputs_header_bytes = 1 + 8 + 8 + 1 + 8 + 1;
inline constexpr std::size_t k_ticks_header_bytes = 1 + 8 + 1 + 8 + 8 + 8 + 8 + 1;
static_assert(k_ticks_header_bytes + 1 + k_max_record_bytes <= k_max_datagram_bytes);

}  // namespace lockstone::net
