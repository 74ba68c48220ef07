// The log of a match that is hosted.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <lockstone/replay/background_sink.h>
#include <lockstone/replay/recorder.h>
#include <lockstone/replay/sink.h>
#include <lockstone/simulation.h>
#include <lockstone/tool.h>

namespace lockstone::tool {

struct MatchOptions;

/// The log of a match, or nothing where none is wanted. After the first error it stays silent: a
/// full disk must not end the match.
class MatchLog {
 public:
  [[nodiscard]] Status open(const MatchOptions& options, const GameDef& game,
                            const Simulation& simulation, ByteView config);
  /// Of the tick that is recorded next.
  void commands(std::span<const PlayerCommand> commands);
  void record(const Simulation& simulation, std::uint64_t tick, std::span<const PlayerInput> inputs,
              std::uint64_t hash);
  void event(replay::EventKind kind, std::uint8_t slot, std::string_view text);
  [[nodiscard]] Status finish(std::string_view reason);

  /// After `finish`: the recorded log.
  [[nodiscard]] std::vector<std::byte> bytes(const std::string& record) const;

 private:
  static constexpr const char* k_unfinished = ".resuming";

  [[nodiscard]] Status take_over(const MatchOptions& options);
  [[nodiscard]] bool active() const { return recorder_.has_value() && status_ == Status::ok; }
  Status note(Status status);

  std::unique_ptr<replay::Sink> sink_;
  const replay::MemorySink* memory_ = nullptr;  ///< it, where no file was asked for
  std::optional<replay::BackgroundSink> background_;
  std::optional<replay::Recorder> recorder_;
  Status status_ = Status::ok;
};

}  // namespace lockstone::tool
