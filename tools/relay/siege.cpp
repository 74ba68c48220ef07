#include "tools/relay/siege.h"

#include <algorithm>
#include <chrono>
#include <thread>

#include "tools/relay/attacks.h"

namespace lockstone::relay {
namespace {

constexpr std::int64_t k_farewell_us = 20'000'000;

std::vector<std::unique_ptr<Attack>> attacks_on(TrialMatch& match, const SiegeOptions& options) {
  std::vector<std::unique_ptr<Attack>> attacks;
  attacks.push_back(forged_connects(match, options.seed));
  attacks.push_back(garbage(match, options.seed + 1));
  attacks.push_back(oversized(match, options.seed + 4));
  attacks.push_back(repeated_connects(match, options.seed + 2));
  attacks.push_back(bad_tokens(match, options.seed + 3));
  attacks.push_back(flood(match, options.honest, options.flood_per_second));
  attacks.push_back(walk_of_a_player(match));
  attacks.push_back(walk_of_strangers(match, options.walkers));
  attacks.push_back(shut_door(match, 20));
  attacks.push_back(reconnect_storm(match));
  return attacks;
}

TrialOptions trial_of(const SiegeOptions& options) {
  TrialOptions trial;
  trial.game = options.game;
  trial.players = options.honest + k_siege_attackers;
  trial.liar = options.honest + 1;
  trial.seed = options.seed;
  trial.input_delay = options.input_delay;
  trial.limits = options.limits;
  trial.max_connections = options.max_connections;
  trial.strangers_per_address = options.strangers_per_address;
  trial.spectators = static_cast<std::uint16_t>(options.visitors + 2);
  return trial;
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
  report.ticks = match.ticks_confirmed();
  report.longest_server_gap_us = match.longest_server_gap_us();
  report.server_stalls = match.server_stalls();
  report.server_busy_us = match.server_busy_us();
  report.liar_expelled = match.server_counters().expelled > 0;
  report.socket = match.socket_counters();
  report.security = match.security_counters();
  return report;
}

}  // namespace

bool SiegeReport::withstood() const {
  const bool nobody_in =
      std::all_of(attacks.begin(), attacks.end(),
                  [](const AttackReport& attack) { return attack.admitted <= attack.entitled; });
  // The first three come from outside.
  const bool silent =
      attacks[0].answered == 0 && attacks[1].answered == 0 && attacks[2].answered == 0;
  const bool unharmed = std::all_of(honest.begin(), honest.end(), [this](const PlayerOutcome& one) {
    return one.substituted == 0 && one.equal && one.ticks == ticks &&
           one.state == net::ClientState::finished;
  });
  const bool door_open = visitors_seated == visitors;
  return nobody_in && silent && unharmed && door_open && server_stalls == 0 && traitor_dropped &&
         liar_expelled;
}

std::optional<SiegeReport> run_siege(const SiegeOptions& options) {
  using Clock = std::chrono::steady_clock;
  using namespace std::chrono_literals;
  const auto match = TrialMatch::create(trial_of(options));
  if (match == nullptr) return std::nullopt;
  const auto attacks = attacks_on(*match, options);
  Visitors visitors(*match, options.visitors, options.duration_us * 3 / 4);
  const Clock::time_point start = Clock::now();
  const std::int64_t longest_us = options.duration_us + options.patience_us;
  bool stopped = false, dropped = false;
  std::int64_t now_us = 0;
  for (bool going = true; going && now_us <= longest_us + k_farewell_us;) {
    now_us = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - start).count();
    for (const auto& attack : attacks)
      if (!stopped) attack->step(now_us);
    visitors.step(now_us);
    going = match->update(now_us);
    dropped = dropped || (match->ticks_confirmed() > 0 && !stopped &&
                          (match->present_mask() >> options.honest & 1) == 0);
    const bool done = dropped && match->server_counters().expelled > 0 && visitors.over() &&
                      all_sent(attacks, options.least_sent);
    if (!stopped && now_us > (done ? options.duration_us : longest_us)) {
      match->stop();
      stopped = true;
    }
    std::this_thread::sleep_for(500us);
  }
  SiegeReport report = report_of(*match, options, attacks);
  report.traitor_dropped = dropped;
  report.visitors = options.visitors;
  report.visitors_seated = visitors.seated();
  report.duration_us = now_us;
  // Ten at once, one a second, and the one that comes in meanwhile.
  report.attacks.back().admitted = match->entries_of(k_storming_player);
  report.attacks.back().entitled = 11 + static_cast<std::uint64_t>(now_us) / 1'000'000;
  return report;
}

}  // namespace lockstone::relay
