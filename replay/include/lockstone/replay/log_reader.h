// Reads a log chunk by chunk, and lets nothing out that it has not checked.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <lockstone/replay/format.h>
#include <lockstone/replay/log_map.h>
#include <lockstone/replay/source.h>
#include <lockstone/simulation.h>

namespace lockstone::replay {

/// The result of LogReader::next().
enum class LogItem : std::uint8_t {
  scene,     ///< config()
  inputs,    ///< tick_inputs(), whose hashes should come next
  hashes,    ///< hashes() of the same ticks; tick_inputs() still holds them
  keyframe,  ///< keyframe_hash(), snapshot()
  commands,  ///< tick_commands() of the inputs that come next
  events,    ///< events()
  end,       ///< end()
  skipped,   ///< a chunk of a type that this build does not know, marked as one to skip
  finished,  ///< no more: the log ends where a chunk would begin. complete() tells whether after
             ///< END
  torn,      ///< no more: the log ends inside a chunk. damage() tells where; not an error as such
  damaged,   ///< no more: damage() tells where and how
};
[[nodiscard]] std::string_view to_string(LogItem item);

/// True for finished, torn and damaged, after which next() repeats itself.
[[nodiscard]] constexpr bool is_last(LogItem item) {
  return item >= LogItem::finished;
}

/// Holds one chunk at a time. Every item is checked whole before it is answered: its checksums, its
/// place in the chain, and that ticks follow each other. Everything before damage is delivered.
class LogReader {
 public:
  /// `source` must outlive the reader.
  explicit LogReader(Source& source);
  ~LogReader();

  LogReader(const LogReader&) = delete;
  LogReader& operator=(const LogReader&) = delete;

  /// Reads the file header; first, once. truncated, malformed, checksum_mismatch,
  /// unsupported_version or io_error, with damage() saying more.
  Status open();

  /// Goes on at a keyframe, once the scene was read: the next item is that `keyframe`, or `damaged`
  /// when none is there. The totals of the END are then not checked. malformed for a place beyond
  /// the log.
  Status jump(const KeyframePlace& place);

  /// Sets the greatest size of the simulation's canonical snapshots, from
  /// Simulation::snapshot_bytes_max: a longer one is malformed, and no memory is taken for it.
  void bound_snapshots(std::size_t bytes);

  /// Reads the next chunk. Earlier results of the accessors below are no longer valid, except that
  /// tick_inputs() lasts until the next `inputs`.
  [[nodiscard]] LogItem next();

  [[nodiscard]] const LogHeader& header() const;

  /// The frame of the current chunk, and its offset in the file.
  [[nodiscard]] const ChunkHeader& chunk() const;
  [[nodiscard]] std::uint64_t chunk_offset() const;

  [[nodiscard]] ByteView config() const;

  /// Inputs of tick `chunk().first_tick + index`, in slot order; index < chunk().count.
  [[nodiscard]] std::span<const PlayerInput> tick_inputs(std::size_t index) const;

  /// Commands of that tick, in their order; they last as long as the inputs.
  [[nodiscard]] std::span<const PlayerCommand> tick_commands(std::size_t index) const;

  /// The state hash after each tick of the chunk.
  [[nodiscard]] std::span<const std::uint64_t> hashes() const;

  /// The state at tick chunk().first_tick, before that tick's inputs.
  [[nodiscard]] ByteView snapshot() const;
  [[nodiscard]] std::uint64_t keyframe_hash() const;

  [[nodiscard]] std::span<const LogEvent> events() const;

  /// The END, once it was read.
  [[nodiscard]] const LogEnd& end() const;

  /// Of the ticks that were delivered with their hashes, since open() or the last jump(). The END's
  /// is checked against it, except after a jump.
  [[nodiscard]] TranscriptHash transcript() const;

  /// True once the END was read: nothing of the match is missing.
  [[nodiscard]] bool complete() const;

  /// Status::ok unless the log is torn or damaged.
  [[nodiscard]] const Damage& damage() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace lockstone::replay
