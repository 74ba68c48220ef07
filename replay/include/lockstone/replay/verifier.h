// Re-simulates a log and compares the hash of every tick.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <lockstone/replay/format.h>
#include <lockstone/replay/signature.h>
#include <lockstone/replay/source.h>
#include <lockstone/simulation.h>

namespace lockstone::replay {

/// The values are the exit codes of a verifying program.
enum class VerifyOutcome : std::uint8_t {
  same = 0,          ///< every whole tick of the log gave its recorded hash
  diverged = 1,      ///< a tick gave another hash
  corrupt = 2,       ///< the log is damaged, and all before the damage was the same
  incompatible = 3,  ///< the log is of another simulation, configuration or format version
};

[[nodiscard]] constexpr int exit_code(VerifyOutcome outcome) {
  return static_cast<int>(outcome);
}

/// "same", "diverged", "corrupt", "incompatible".
[[nodiscard]] std::string_view to_string(VerifyOutcome outcome);

struct VerifyOptions {
  /// Also demand an END and no torn tail: a log that a killed recorder left is then corrupt.
  bool strict = false;
  /// After a divergence, go on to the next keyframe to name the first difference in the state.
  bool explain = true;
};

/// A header field in which the log and the simulation differ.
struct FieldMismatch {
  std::string field;  ///< "abi", "config hash", "scene hash", "canary", "tick rate", …
  std::string log;    ///< its value in the log
  std::string here;   ///< its value in this build
};

struct Divergence {
  std::uint64_t tick = 0;      ///< the first tick whose inputs led to another hash
  std::uint64_t expected = 0;  ///< recorded
  std::uint64_t actual = 0;    ///< computed
  /// The ticks agree, but the keyframe before `tick` holds another state than the hash says.
  bool in_keyframe = false;
  /// The first difference in the state at `difference_tick`, that is after all ticks below it;
  /// `here` is this build, `there` the log. Not set when no keyframe follows the divergence.
  std::optional<StateDifference> difference;
  std::uint64_t difference_tick = 0;
};

struct VerifyReport {
  VerifyOutcome outcome = VerifyOutcome::same;
  std::uint64_t start_tick = 0;
  std::uint64_t ticks_verified = 0;  ///< ticks whose hash was the recorded one
  std::uint64_t final_hash = 0;      ///< of the last verified tick; 0 when there is none
  bool complete = false;             ///< the END was read
  bool torn_tail = false;            ///< the log ends inside a chunk
  std::string end_reason;            ///< from the END
  EndKind end_kind = EndKind::finished;
  /// From the END: for players to compare with their own. Checked against the log's inputs.
  TranscriptHash transcript{};
  std::optional<Divergence> divergence;
  /// The damage, the simulation's refusal, or the place where the tail is torn.
  std::optional<Damage> damage;
  std::vector<FieldMismatch> mismatches;

  /// One line for people, without a final line break. Of a log that has no end, begins late, or
  /// was cut or repaired, it says which ticks alone are proved.
  [[nodiscard]] std::string to_line() const;

  /// The questions that a verdict of `same` leaves open, one line each, for people; nothing when
  /// the signature by an expected key is `good`. Which ticks were verified, to_line() says.
  [[nodiscard]] std::vector<std::string> not_proved(SignatureState signature) const;
};

/// Called after each chunk of ticks with the ticks done and the ticks there are, by the frames.
using VerifyProgress = std::function<void(std::uint64_t ticks, std::uint64_t total)>;

/// Verifies a log. The first finding in the order of the file decides the outcome; after a
/// divergence the rest of the log is still read for `complete`, `torn_tail` and `damage`.
///
/// A log that ends at a chunk's end without END is `same` with `complete` false; one that ends
/// inside a chunk is `same` with `torn_tail` too: a killed recorder leaves such a log.
/// Ticks whose hashes were lost with the tail are not verified.
[[nodiscard]] VerifyReport verify(Source& source, const SimulationFactory& factory,
                                  const VerifyOptions& options = {},
                                  const VerifyProgress& progress = {});

/// Opens one log. Called on several threads, each of which reads for itself.
using SourceOpener = std::function<Result<std::unique_ptr<Source>>()>;

/// Verifies several logs on several threads, at most `threads` (0 counts as 1): keyframes make the
/// parts between them independent. Returns for each log, in their order, the report that verify()
/// would give; one that cannot be opened is corrupt. `factory` is called on several threads.
/// `progress` counts over all logs, and is called by one thread at a time.
[[nodiscard]] std::vector<VerifyReport> verify_all(std::span<const SourceOpener> logs,
                                                   const SimulationFactory& factory,
                                                   const VerifyOptions& options = {},
                                                   unsigned threads = 1,
                                                   const VerifyProgress& progress = {});

}  // namespace lockstone::replay
