#include "tools/relay/siege.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "tools/relay/attacks.h"

namespace lockstone::relay {
namespace {

constexpr std::int64_t k_patience_us = 20'000'000;

std::vector<std::unique_ptr<Attack>> attacks_on(TrialMatch& match, const SiegeOptions& options) {
  std::vector<std::unique_ptr<Attack>> attacks;
  attacks.push_back(forged_connects(match, options.seed));
  attacks.push_back(garbage(match, options.seed + 1));
  attacks.push_back(oversized(match, options.seed + 4));
  attacks.push_back(repeated_connects(match, options.seed + 2));
  attacks.push_back(bad_tokens(match, options.seed + 3));
  attacks.push_back(flood(match, options.honest, options.flood_per_second));
  return attacks;
}

bool all_sent(const std::vector<std::unique_ptr<Attack>>& attacks, std::uint64_t least) {
  return std::all_of(attacks.begin(), attacks.end(),
                     [least](const auto& attack) { return attack->report().sent >= least; });
}

SiegeReport report_of(const TrialMatch& match, const SiegeOptions& options,
                      const std::vector<std::unique_ptr<Attack>>& attacks) {
  SiegeReport report;
  for (const auto& attack : attacks)
    report.attacks.push_back(attack->report());
  for (unsigned slot = 0; slot < options.honest; ++slot)
    report.honest.push_back(match.outcome(slot));
  report.traitor = match.outcome(options.honest);
  report.ticks = match.ticks_closed();
  report.longest_server_gap_us = match.longest_server_gap_us();
  report.socket = match.socket_counters();
  report.security = match.security_counters();
  return report;
}

}  // namespace

bool SiegeReport::withstood() const {
  const bool nobody_in =
      std::all_of(attacks.begin(), attacks.end(),
                  [](const AttackReport& attack) { return attack.admitted == 0; });
  // The first three come from outside.
  const bool silent =
      attacks[0].answered == 0 && attacks[1].answered == 0 && attacks[2].answered == 0;
  const bool unharmed = std::all_of(honest.begin(), honest.end(), [this](const PlayerOutcome& one) {
    return one.substituted == 0 && one.equal && one.ticks == ticks &&
           one.state == net::ClientState::finished;
  });
  return nobody_in && silent && unharmed && traitor_dropped;
}

std::optional<SiegeReport> run_siege(const SiegeOptions& options) {
  using Clock = std::chrono::steady_clock;
  using namespace std::chrono_literals;
  TrialOptions trial;
  trial.players = options.honest + 1;
  trial.seed = options.seed;
  trial.limits = options.limits;
  const auto match = TrialMatch::create(trial);
  if (match == nullptr) return std::nullopt;
  const auto attacks = attacks_on(*match, options);
  const Clock::time_point start = Clock::now();
  bool stopped = false, dropped = false;
  for (bool going = true; going;) {
    const auto now = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start);
    for (const auto& attack : attacks)
      if (!stopped) attack->step(now.count());
    going = match->update(now.count());
    dropped = dropped || (match->ticks_closed() > 0 && !stopped &&
                          (match->present_mask() >> options.honest & 1) == 0);
    const std::int64_t longest_us = options.duration_us + k_patience_us;
    const bool done = dropped && all_sent(attacks, options.least_sent);
    if (!stopped && now.count() > (done ? options.duration_us : longest_us)) {
      match->stop();
      stopped = true;
    }
    if (now.count() > longest_us + k_patience_us) break;
    std::this_thread::sleep_for(500us);
  }
  SiegeReport report = report_of(*match, options, attacks);
  report.traitor_dropped = dropped;
  return report;
}

}  // namespace lockstone::relay
