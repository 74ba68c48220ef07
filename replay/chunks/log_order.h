// The order of chunks in a log, tick after tick, and the totals that its END must repeat.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

#include <lockstone/replay/format.h>
#include <lockstone/replay/transcript.h>

namespace lockstone::replay {

/// A scene first; then inputs, with their commands before them, and their hashes in turn, and at
/// most one keyframe between them; the END last. Checks return the fault, or null; only chunks
/// without a fault are noted.
class LogOrder {
 public:
  /// The log's first tick.
  void begin(std::uint64_t start_tick) { start_tick_ = next_tick_ = start_tick; }

  /// Goes on with the keyframe of `tick`. Totals then do not count earlier items.
  void jump(std::uint64_t tick);

  /// Whether a chunk may come next, by its frame alone.
  [[nodiscard]] const char* check(const ChunkHeader& chunk) const;
  /// Whether inputs may come before any keyframe.
  [[nodiscard]] const char* check_start() const;
  [[nodiscard]] const char* check_keyframe(std::uint64_t hash) const;
  [[nodiscard]] const char* check_end(const LogEnd& end) const;

  void note_scene() { has_scene_ = true; }
  /// Of ticks of the inputs that come next.
  void note_commands() { awaits_inputs_ = true; }
  void note_inputs(std::uint32_t ticks);
  /// The hashes of the inputs that were noted last.
  void note_hashes(std::uint64_t last_hash);
  /// One of the ticks whose hashes have come.
  void add_to_transcript(std::uint64_t tick, std::span<const PlayerInput> inputs,
                         std::span<const PlayerCommand> commands) {
    transcript_.add(tick, inputs, commands);
  }
  void note_keyframe(std::uint64_t tick, std::uint64_t hash);
  void note_events(std::size_t events) { seen_.events += events; }
  void note_end() { complete_ = true; }

  /// Whether a signature may stand behind the END: the first one.
  [[nodiscard]] bool take_signature();

  [[nodiscard]] bool has_scene() const { return has_scene_; }
  [[nodiscard]] bool complete() const { return complete_; }
  /// The commands that were read last are of the inputs that come.
  [[nodiscard]] bool awaits_inputs() const { return awaits_inputs_; }
  /// How many ticks the last inputs have.
  [[nodiscard]] std::uint32_t input_ticks() const { return input_ticks_; }
  [[nodiscard]] TranscriptHash transcript() const { return transcript_.value(); }

 private:
  LogEnd seen_;  ///< totals so far
  Transcript transcript_;
  std::optional<std::uint64_t> last_keyframe_;  ///< its tick
  std::uint64_t start_tick_ = 0;
  std::uint64_t next_tick_ = 0;
  std::uint32_t input_ticks_ = 0;
  bool has_scene_ = false;
  bool awaits_inputs_ = false;  ///< the last chunk was COMMAND
  bool awaits_hashes_ = false;  ///< the last chunk was INPUT
  bool complete_ = false;
  bool signed_ = false;   ///< a SIGNATURE stands behind the END
  bool arrives_ = false;  ///< the next chunk is the keyframe that was jumped to
  bool jumped_ = false;
};

}  // namespace lockstone::replay
