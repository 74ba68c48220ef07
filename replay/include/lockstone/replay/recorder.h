// Writes the log of a match while it is played.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>

#include <lockstone/replay/format.h>
#include <lockstone/replay/signature.h>
#include <lockstone/replay/sink.h>
#include <lockstone/simulation.h>
#include <lockstone/status.h>

namespace lockstone::replay {

/// How long a match counts as young: a minute at 60 ticks a second.
inline constexpr std::uint64_t k_early_ticks = 3600;

struct RecorderOptions {
  /// Ticks between keyframes, counted from the start tick; 0: keyframe_due() is never true.
  std::uint32_t keyframe_interval_ticks = 600;
  /// The same, if it is less, for the first k_early_ticks: so that a short match, too, has enough
  /// parts to be verified on many cores.
  std::uint32_t early_keyframe_interval_ticks = 150;
  /// Ticks a chunk; 0, and anything above it, means one second, and never more than
  /// k_max_chunk_ticks. This is also how much a killed recorder loses.
  std::uint32_t chunk_ticks = 0;
  /// Room for one canonical snapshot, from Simulation::snapshot_bytes_max; 0: no keyframes.
  std::size_t keyframe_bytes_max = 0;
  /// Store SCENE and KEYFRAME compressed where compression_available() and it saves bytes.
  bool compress = true;
  /// Write an INDEX of the keyframes at the end.
  bool index = true;
  /// Sign after each keyframe and after the END; needs signing_available().
  std::optional<SigningKey> signing_key = std::nullopt;
};

/// Appends a match to a sink, tick by tick. begin() allocates; nothing after it does. A
/// BackgroundSink in between keeps the disk from stalling the tick.
///
///     Recorder recorder(sink, {.keyframe_bytes_max = game.snapshot_bytes_max(canonical)});
///     recorder.begin(game.info(), config, {.match_id = 7, .build = "mygame 1.2"});
///     for (;;) {
///       game.step(inputs);
///       recorder.record_step(game, inputs);
///     }
///     recorder.finish("match over");
///
/// Ticks leave for the sink together with their hashes, whole chunks at a time, so a killed process
/// leaves a log that verifies up to its last whole chunk. On an interrupt, call finish() from the
/// main loop (not from a signal handler). After an io_error the recorder stays failed and returns
/// io_error from every call: the part written before remains a good log.
class Recorder {
 public:
  /// `sink` must outlive the recorder.
  explicit Recorder(Sink& sink, const RecorderOptions& options = {});

  Recorder(const Recorder&) = delete;
  Recorder& operator=(const Recorder&) = delete;

  /// Writes the pending chunks, without an END: the log stays incomplete, as after a kill.
  ~Recorder();

  /// Writes the file header and the configuration bytes that SimulationFactory takes. Once.
  /// invalid_argument for a field of `info` or `match` out of range, too long a configuration, a
  /// keyframe_bytes_max above k_max_keyframe_bytes, or a signing key in a build that cannot sign.
  Status begin(const SimulationInfo& info, ByteView config, const MatchMetadata& match);

  /// The commands of the next tick, before its record_tick(); none are fine. invalid_argument, and
  /// nothing is recorded, for one of no bytes or too many, of a slot that does not exist, or for
  /// more than k_max_tick_commands or k_max_command_chunk_bytes allow for a tick.
  Status record_commands(std::span<const PlayerCommand> commands);

  /// Records that `inputs` took the match from `tick` to `tick + 1`, whose state hashes to `hash`.
  /// invalid_argument, and nothing is recorded, when `tick` is not next_tick(), when the inputs are
  /// not one of SimulationInfo::input_bytes for each slot, or when the log starts above tick 0 and
  /// has no keyframe yet.
  Status record_tick(std::uint64_t tick, std::span<const PlayerInput> inputs, std::uint64_t hash);

  /// The same, asking the simulation that was just stepped, with a keyframe when one is due.
  Status record_step(const Simulation& stepped, std::span<const PlayerInput> inputs);

  /// True when the state at next_tick() should be handed to keyframe().
  [[nodiscard]] bool keyframe_due() const;

  /// Writes the state of `simulation`, which stands at next_tick(). invalid_argument when it stands
  /// elsewhere, when its hash is not the recorded one, or when this tick has a keyframe already;
  /// capacity_exhausted when there is no room.
  Status keyframe(const Simulation& simulation);

  /// The same from a canonical snapshot; `hash` is that of its state.
  Status keyframe(std::uint64_t tick, std::uint64_t hash, ByteView snapshot);

  /// Notes something for people. `text` is cut to k_max_text_bytes; control bytes, and
  /// bytes of no whole UTF-8 character, become '?'.
  /// invalid_argument for a slot that does not exist or a kind 0.
  Status event(std::uint64_t tick, EventKind kind, std::uint8_t slot, std::string_view text);

  /// Hands everything pending to the sink. For a match that pauses: otherwise done each second.
  Status flush();

  /// Writes the pending chunks and the END, signed where there is a key. `reason` is treated as an
  /// event's text.
  Status finish(std::string_view reason, EndKind kind = EndKind::finished);

  /// Of the ticks recorded so far, as the END will hold it: for clients to compare with theirs.
  [[nodiscard]] TranscriptHash transcript() const;

  /// The tick that record_tick() expects.
  [[nodiscard]] std::uint64_t next_tick() const { return next_tick_; }

 private:
  enum class State : std::uint8_t { idle, recording, finished, failed };
  struct Buffers;

  [[nodiscard]] Status check_recording() const;
  void allocate(ByteView config);
  void start_chunk();
  Status write_beginning(const LogHeader& header, ByteView config);
  Status write_keyframe(std::uint64_t hash, std::size_t snapshot_bytes);
  std::size_t seal_ticks();
  std::size_t seal_events(std::size_t used_bytes);
  Status append(ByteView bytes);
  Status append_packed(ChunkHeader header, std::span<std::byte> chunk);
  Status sign();
  Status note(Status status);

  Sink& sink_;
  RecorderOptions options_;
  SimulationInfo info_;
  State state_ = State::idle;
  std::unique_ptr<Buffers> buffers_;
  std::uint64_t start_tick_ = 0;
  std::uint64_t next_tick_ = 0;
  std::uint64_t last_keyframe_tick_ = 0;
  LogEnd totals_;
};

}  // namespace lockstone::replay
