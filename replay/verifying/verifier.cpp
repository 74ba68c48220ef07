#include <lockstone/replay/verifier.h>

#include "replay/bytes/text.h"
#include "replay/verifying/verification.h"

namespace lockstone::replay {
namespace {

std::string describe_divergence(const Divergence& divergence) {
  std::string line = divergence.in_keyframe ? "keyframe at tick " : "tick ";
  line += std::to_string(divergence.tick) + ": hash " + to_hex(divergence.actual) + " here, " +
          to_hex(divergence.expected) + " in the log";
  if (divergence.difference) {
    line += "; at tick " + std::to_string(divergence.difference_tick) + ' ' +
            divergence.difference->to_line();
  }
  return line;
}

std::string describe_damage(const Damage& damage) {
  return damage.what + " at byte " + std::to_string(damage.offset);
}

// Which ticks alone are proved, where that is not the whole match.
std::string describe_part(const VerifyReport& report) {
  const std::uint64_t end = report.start_tick + report.ticks_verified;
  const std::string ticks = std::to_string(report.ticks_verified);
  const bool cut_short = !report.complete || report.end_kind != EndKind::finished;
  std::string line;
  if (report.start_tick > 0) line += "begins at tick " + std::to_string(report.start_tick);
  if (cut_short) line += (line.empty() ? "cut at tick " : ", cut at tick ") + std::to_string(end);
  if (line.empty()) return line;
  return line + ": only " + (report.start_tick == 0 ? "the first " : "these ") + ticks +
         " ticks are proved";
}

}  // namespace

std::string_view to_string(VerifyOutcome outcome) {
  switch (outcome) {
    case VerifyOutcome::same:
      return "same";
    case VerifyOutcome::diverged:
      return "diverged";
    case VerifyOutcome::corrupt:
      return "corrupt";
    case VerifyOutcome::incompatible:
      return "incompatible";
  }
  return "unknown outcome";
}

std::string VerifyReport::to_line() const {
  std::string line(to_string(outcome));
  if (divergence) line += ": " + describe_divergence(*divergence);
  for (const FieldMismatch& mismatch : mismatches) {
    line += ": " + mismatch.field + ' ' + mismatch.log + " in the log, " + mismatch.here + " here";
  }
  if (damage && !torn_tail) line += ": " + describe_damage(*damage);
  const std::string part = outcome == VerifyOutcome::same ? describe_part(*this) : std::string();
  if (!part.empty()) line += "; " + part;
  line += "; " + std::to_string(ticks_verified) + " ticks verified";
  if (torn_tail) return line + ", torn tail: " + describe_damage(*damage);
  if (outcome != VerifyOutcome::incompatible && !complete) line += ", incomplete (no end)";
  return line;
}

std::vector<std::string> VerifyReport::not_proved(SignatureState signature) const {
  std::vector<std::string> lines;
  if (outcome != VerifyOutcome::same) return lines;
  if (signature == SignatureState::none) {
    lines.emplace_back(
        "not proved: that the match was played with these inputs. The log is not signed, and "
        "anybody who changes a log can compute its hashes again");
  } else if (signature != SignatureState::good) {
    lines.emplace_back("not proved: who signed the log, and that it is whole");
  }
  if (complete && !lines.empty()) {
    lines.push_back("transcript " + to_text(transcript) + ": compare it with the players' own");
  }
  return lines;
}

VerifyReport verify(Source& source, const SimulationFactory& factory, const VerifyOptions& options,
                    const VerifyProgress& progress) {
  const std::uint64_t total = progress ? map_log(source).ticks : 0;
  std::uint64_t done = 0;
  TickCounter counter;
  if (progress) counter = [&](std::uint64_t ticks) { progress(done += ticks, total); };
  return Verification(source, {}, factory, options, counter).run();
}

}  // namespace lockstone::replay
