// Reads a log tick by tick.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <lockstone/replay/log_reader.h>

namespace lockstone::replay {

/// The ticks that have a recorded hash, in order, from the beginning or from a keyframe.
class TickReader {
 public:
  /// `source` must outlive the reader.
  explicit TickReader(Source& source) : reader_(source) {}

  /// Reads the file header and the configuration. `from`: begin at this keyframe.
  Status open(const std::optional<KeyframePlace>& from = std::nullopt);

  /// Right after open(): reads the keyframe that was asked for; false when it is not good.
  [[nodiscard]] bool read_keyframe();

  /// As LogReader::bound_snapshots.
  void bound_snapshots(std::size_t bytes) { reader_.bound_snapshots(bytes); }

  /// Goes to the next tick; false at the end of the readable part: see reader().damage().
  [[nodiscard]] bool next();

  [[nodiscard]] std::uint64_t tick() const { return tick_; }
  [[nodiscard]] std::span<const PlayerInput> inputs() const {
    return reader_.tick_inputs(position_);
  }
  /// In the order in which they act, before the inputs.
  [[nodiscard]] std::span<const PlayerCommand> commands() const {
    return reader_.tick_commands(position_);
  }
  /// After the tick.
  [[nodiscard]] std::uint64_t hash() const { return reader_.hashes()[position_]; }

  /// Whether the log holds the state at tick(), before its inputs; then it is snapshot().
  [[nodiscard]] bool at_keyframe() const { return at_keyframe_; }

  /// The last keyframe that was read.
  [[nodiscard]] ByteView snapshot() const { return snapshot_; }

  /// The game's configuration, from open() on.
  [[nodiscard]] ByteView config() const { return config_; }
  [[nodiscard]] const LogReader& reader() const { return reader_; }

 private:
  void take_snapshot();

  LogReader reader_;
  std::vector<std::byte> config_;
  std::vector<std::byte> snapshot_;
  std::uint64_t tick_ = 0;
  std::size_t position_ = 0;
  std::size_t count_ = 0;
  bool at_keyframe_ = false;
};

}  // namespace lockstone::replay
