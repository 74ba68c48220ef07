#include <lockstone/replay/verifier.h>

#include "replay/text.h"
#include "replay/verification.h"

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
  line += "; " + std::to_string(ticks_verified) + " ticks verified";
  if (torn_tail) return line + ", torn tail: " + describe_damage(*damage);
  if (outcome != VerifyOutcome::incompatible && !complete) line += ", incomplete (no end)";
  return line;
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
