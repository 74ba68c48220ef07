// The recorder of a simulated match, with a disk that may be full.
#pragma once

#include <cstdint>
#include <span>
#include <string>

#include <lockstone/replay/recorder.h>
#include <lockstone/replay/sink.h>
#include <lockstone/simulation.h>

#include "tools/simnet/match.h"

namespace lockstone::simnet {

/// A disk that stores all bytes it is given, until it is full.
class LimitedSink final : public replay::Sink {
 public:
  Status append(ByteView bytes) override { return full ? Status::io_error : memory.append(bytes); }
  replay::MemorySink memory;
  bool full = false;
};

/// Records a server's ticks, and checks that the written part, whether the disk was full or not, is
/// a good log.
class MatchLog {
 public:
  explicit MatchLog(const Simulation& simulation)
      : recorder_(disk_,
                  {.keyframe_bytes_max = simulation.snapshot_bytes_max(SnapshotKind::canonical)}) {}

  [[nodiscard]] Status begin(const SimulationInfo& info, const Game& game, std::uint64_t seed);

  void record(std::uint64_t tick, std::span<const PlayerInput> inputs, std::uint64_t hash,
              const Simulation& simulation);

  /// Of the tick that is recorded next.
  void commands(std::span<const PlayerCommand> commands) {
    static_cast<void>(recorder_.record_commands(commands));
  }

  void set_full(bool full) { disk_.full = full; }

  /// The fault of the log; empty: it has none.
  [[nodiscard]] std::string check(const Game& game) const;

 private:
  LimitedSink disk_;
  replay::Recorder recorder_;
};

}  // namespace lockstone::simnet
