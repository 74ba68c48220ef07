// Re-simulates a part of a log and compares.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <lockstone/replay/log_map.h>
#include <lockstone/replay/log_reader.h>
#include <lockstone/replay/verifier.h>

namespace lockstone::replay {

/// The fields in which the two differ.
[[nodiscard]] std::vector<FieldMismatch> compare_info(const SimulationInfo& log,
                                                      const SimulationInfo& here);

/// The part of a log between two keyframes.
struct LogSegment {
  std::optional<KeyframePlace> begin = std::nullopt;  ///< none: the log's beginning
  std::optional<KeyframePlace> end = std::nullopt;    ///< none: the log's end
};

/// Called with the ticks done since the last call.
using TickCounter = std::function<void(std::uint64_t ticks)>;

/// One run over a segment of a log. Its steps follow the items that the reader delivers;
/// `simulation_` stands still once it must not be stepped further.
class Verification {
 public:
  /// All must outlive this.
  Verification(Source& source, const LogSegment& segment, const SimulationFactory& factory,
               const VerifyOptions& options, const TickCounter& counter)
      : reader_(source),
        segment_(segment),
        factory_(factory),
        options_(options),
        counter_(counter) {}

  VerifyReport run();

 private:
  void take(LogItem item);
  void take_scene();
  void take_ticks();
  void take_keyframe();
  [[nodiscard]] bool at_end(LogItem item) const;
  void start_from_keyframe();
  void check_keyframe();
  void explain();
  void conclude(LogItem last);
  void diverge(std::uint64_t tick, std::uint64_t expected, std::uint64_t actual);
  void refuse(Status status, const std::string& what);

  // False once the outcome is settled, so that the rest of the log is only read.
  [[nodiscard]] bool running() const { return report_.outcome == VerifyOutcome::same; }

  LogReader reader_;
  LogSegment segment_;
  const SimulationFactory& factory_;
  const VerifyOptions& options_;
  const TickCounter& counter_;
  std::vector<std::byte> config_;
  std::unique_ptr<Simulation> simulation_;
  std::unique_ptr<Simulation> scratch_;  // keyframes are loaded into it
  bool explaining_ = false;
  bool starts_at_keyframe_ = false;
  VerifyReport report_;
};

}  // namespace lockstone::replay
