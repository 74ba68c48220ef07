// The vocabulary of the input log, `.lks`. docs/reference/replay-format.md lays it out byte by
// byte.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <lockstone/replay/transcript.h>
#include <lockstone/simulation.h>
#include <lockstone/status.h>

namespace lockstone::replay {

/// The version of the file header and of the chunk frame. Each chunk type has its own version too.
/// Readers take the version before as well, which had at most k_old_max_players.
inline constexpr std::uint16_t k_format_version = 4;
inline constexpr std::uint16_t k_oldest_format_version = 3;
inline constexpr std::size_t k_old_max_players = 16;
inline constexpr std::uint8_t k_chunk_version = 1;

/// Bounds that hold for every log. Readers refuse more before they allocate anything.
inline constexpr std::size_t k_max_file_header_bytes = 4096;
inline constexpr std::size_t k_max_build_bytes = 128;        ///< the build string
inline constexpr std::size_t k_max_game_bytes = 64;          ///< the game's name; its version
inline constexpr std::size_t k_max_text_bytes = 256;         ///< an event's text, the end's reason
inline constexpr std::size_t k_max_chunk_ticks = 1024;       ///< and never more than one second
inline constexpr std::size_t k_max_scene_bytes = 16U << 20;  ///< the game's configuration
inline constexpr std::size_t k_max_keyframe_bytes = 64U << 20;  ///< one canonical snapshot
/// A compressed payload is at most this many times as long as its stored bytes, so that a reader
/// needs memory and time in proportion to the file.
inline constexpr std::size_t k_max_compression_ratio = 32;
inline constexpr std::size_t k_max_command_chunk_bytes = 1U << 20;
inline constexpr std::size_t k_max_tick_commands = 255;
inline constexpr std::uint64_t k_max_start_tick = std::uint64_t{1} << 62;

/// Bytes of the frame in front of every chunk's payload.
inline constexpr std::size_t k_chunk_header_bytes = 56;

/// The slot of an event that concerns no player.
inline constexpr std::uint8_t k_no_slot = 255;

enum class ChunkType : std::uint8_t {
  none = 0,       ///< never in a file; in a report: the file header, or a frame that is unreadable
  scene = 1,      ///< the configuration bytes for SimulationFactory; the first chunk, once
  input = 2,      ///< origin and bytes of every slot, for up to one second of ticks
  hash = 3,       ///< the state hash after each tick of the INPUT chunk before it
  keyframe = 4,   ///< a canonical snapshot
  event = 5,      ///< joins, leaves, substitutions, notes
  diag = 6,       ///< reserved: diagnostics
  index = 7,      ///< where the keyframes are; can be found again without it
  end = 8,        ///< the recorder finished in order
  signature = 9,  ///< an Ed25519 signature over all that stands before it
  command = 10,   ///< player commands of ticks of the INPUT chunk after it
};

/// "INPUT", "HASH", …; "chunk" for a type that this build does not know.
[[nodiscard]] std::string_view to_string(ChunkType type);

enum class Codec : std::uint8_t {
  raw = 0,   ///< the stored bytes are the payload
  zstd = 1,  ///< one Zstandard frame (RFC 8878)
};
[[nodiscard]] std::string_view to_string(Codec codec);

/// Whether this build reads and writes compressed chunks. One that does not refuses logs that hold
/// them, with unsupported_version.
[[nodiscard]] bool compression_available();

/// Flag bit: a reader that does not know this chunk's type may skip the chunk.
inline constexpr std::uint8_t k_flag_may_skip = 1;

/// The frame of one chunk, without its sync word and checksums.
struct ChunkHeader {
  ChunkType type = ChunkType::none;
  std::uint8_t version = k_chunk_version;
  Codec codec = Codec::raw;
  std::uint8_t flags = 0;
  std::uint32_t sequence = 0;      ///< 0 for the first chunk of the file, then one more each
  std::uint32_t count = 0;         ///< INPUT, HASH: ticks; EVENT: records; else 0
  std::uint64_t first_tick = 0;    ///< the log's position: see docs/reference/replay-format.md
  std::uint32_t raw_bytes = 0;     ///< payload bytes after decoding
  std::uint32_t stored_bytes = 0;  ///< payload bytes in the file
};

/// A log's description of its match besides the simulation's own SimulationInfo.
struct MatchMetadata {
  std::uint64_t match_id = 0;
  std::uint64_t seed = 0;  ///< for people and tools; the simulation takes its seed from the config
  std::uint64_t start_tick = 0;  ///< 0 … k_max_start_tick; above 0 the log begins with a keyframe
  std::string build = {};        ///< which program wrote it, cut to k_max_build_bytes
  /// The game's name, by which tools find its simulation, and its version, for people; each cut to
  /// k_max_game_bytes. Empty: not named.
  std::string game = {};
  std::string game_version = {};
};

/// The file header.
struct LogHeader {
  SimulationInfo info;
  MatchMetadata match;
};

enum class EventKind : std::uint8_t {
  join = 1,
  leave = 2,
  substitution = 3,  ///< for people: the origins in the INPUT chunks are decisive
  note = 4,
  name = 5,  ///< the text is the name of the slot's player from here on
};

/// "join", …; "event" for a kind that this build does not know.
[[nodiscard]] std::string_view to_string(EventKind kind);

/// Something that happened, for people. It does not change the simulation.
struct LogEvent {
  std::uint64_t tick = 0;
  EventKind kind = EventKind::note;
  std::uint8_t slot = k_no_slot;  ///< a player's slot, or k_no_slot
  std::string text = {};          ///< UTF-8 without control characters
};

/// Whether the log goes on to where the match was recorded to.
enum class EndKind : std::uint8_t {
  finished = 0,  ///< by the recorder of the match
  cut = 1,       ///< cut() took some ticks of another log
  repaired = 2,  ///< repair() closed the good part
};

/// "finished", "cut", "repaired".
[[nodiscard]] std::string_view to_string(EndKind kind);

/// How the recorder closed the log.
struct LogEnd {
  std::uint64_t final_tick = 0;  ///< the tick that would have come next
  std::uint64_t final_hash = 0;  ///< the last recorded hash; 0 when no tick was recorded
  std::uint64_t ticks = 0;
  std::uint64_t events = 0;
  std::uint32_t keyframes = 0;
  EndKind kind = EndKind::finished;
  TranscriptHash transcript{};  ///< of the log's ticks that have a hash
  std::string reason;
};

/// Where and how a log is damaged.
struct Damage {
  Status status = Status::ok;
  /// Of the damaged chunk's first byte; of the offending byte itself where that is known.
  std::uint64_t offset = 0;
  ChunkType type = ChunkType::none;
  std::string what;  ///< one line for people
};

}  // namespace lockstone::replay
