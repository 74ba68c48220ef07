#include "tools/simnet/match_log.h"

#include <lockstone/replay/source.h>
#include <lockstone/replay/verifier.h>

namespace lockstone::simnet {

Status MatchLog::begin(const SimulationInfo& info, const Game& game, std::uint64_t seed) {
  return recorder_.begin(info, game.config, {.seed = seed});
}

void MatchLog::record(std::uint64_t tick, std::span<const PlayerInput> inputs, std::uint64_t hash,
                      const Simulation& simulation) {
  if (recorder_.record_tick(tick, inputs, hash) != Status::ok) return;
  if (recorder_.keyframe_due()) static_cast<void>(recorder_.keyframe(simulation));
}

std::string MatchLog::check(const Game& game) const {
  replay::MemorySource source(disk_.memory.bytes());
  const replay::VerifyReport report = replay::verify(source, game.factory);
  return report.outcome == replay::VerifyOutcome::same ? std::string() : report.to_line();
}

}  // namespace lockstone::simnet
