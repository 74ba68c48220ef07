// siege: an attacked match on this machine.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>

#include <fmt/format.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/match/net_commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/relay/datagram_rate.h"
#include "tools/relay/siege.h"
#include "tools/tool/start_match.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

void print_report(const relay::SiegeReport& report) {
  fmt::print("{:<22} {:>8} {:>9} {:>9}\n", "attack", "sent", "answered", "admitted");
  for (const relay::AttackReport& attack : report.attacks)
    fmt::print("{:<22} {:>8} {:>9} {:>9}\n", attack.name, attack.sent, attack.answered,
               attack.admitted);
  const net::EnetCounters& socket = report.socket;
  fmt::print(
      "\ndatagrams {}: {} malformed, {} of no connection, {} forged, {} repeated connects, "
      "{} oversized, {} replayed, {} too far ahead, {} beyond limits, {} of a crowd\n",
      socket.datagrams, socket.malformed, socket.strays, socket.forged, socket.repeated_connects,
      socket.oversized, socket.replayed, socket.too_far_ahead, socket.limited, socket.crowded);
  const net::SecurityCounters& security = report.security;
  fmt::print(
      "handshakes {} completed, {} refused, {} timed out, {} replaced, {} too often; packets {} "
      "forged, {} replayed\n",
      security.handshakes_completed, security.handshakes_refused, security.handshakes_timed_out,
      security.handshakes_replaced, security.handshakes_limited, security.packets_forged,
      security.packets_replayed);
  fmt::print("server {} ticks, {} stalls, longest between two {:.1f} ms, {:.1f} % of a core\n",
             report.ticks, report.server_stalls,
             static_cast<double>(report.longest_server_gap_us) / 1000,
             100 * static_cast<double>(report.server_busy_us) /
                 static_cast<double>(std::max<std::int64_t>(report.duration_us, 1)));
  for (std::size_t i = 0; i < report.honest.size(); ++i) {
    const relay::PlayerOutcome& player = report.honest[i];
    fmt::print("player {}: {} ticks, {} inputs replaced, longest between two {:.1f} ms, {}\n", i,
               player.ticks, player.substituted, static_cast<double>(player.longest_us) / 1000,
               player.equal ? "all hashes equal" : "hashes DIFFER");
  }
  fmt::print("visitors {} of {} let in\n", report.visitors_seated, report.visitors);
  fmt::print("the flooding player {}, the lying one {}\n",
             report.traitor_dropped ? "was dropped" : "was NOT dropped",
             report.liar_expelled ? "was expelled" : "was NOT expelled");
}

// True when the game has a seat for everybody; else a complaint.
bool has_seats(const relay::SiegeOptions& options) {
  const GameDef& game = *options.game;
  const unsigned seats = options.honest + relay::k_siege_attackers;
  MatchRequest request{.seed = options.seed, .players = static_cast<std::uint8_t>(seats)};
  if (players_of(game, request) == seats) return true;
  request.players = 0;
  const std::optional<unsigned> usual = players_of(game, request);
  complain(fmt::format("siege --players {} needs {} + {} seats; {}", options.honest, options.honest,
                       relay::k_siege_attackers,
                       usual ? fmt::format("{} has {}", game.name, *usual)
                             : fmt::format("{} refuses that number", game.name)));
  return false;
}

int siege(const relay::SiegeOptions& options) {
  if (!has_seats(options)) return k_usage;
  if (!net::security_available()) {
    complain("siege needs libsodium, which this build lacks");
    return k_unavailable;
  }
  const auto report = relay::run_siege(options);
  if (!report) {
    complain("siege needs UDP sockets on this machine, which the system refuses");
    return k_unavailable;
  }
  print_report(*report);
  fmt::print("{}\n", report->withstood() ? "withstood" : "NOT withstood");
  return report->withstood() ? k_ok : k_different;
}

int print_rates() {
  constexpr std::uint64_t k_datagrams = 200'000;
  const auto rates = relay::measure_rates(k_datagrams);
  if (!rates) {
    complain("no measurement: no socket, or no libsodium");
    return k_unavailable;
  }
  fmt::print("{:<22} {:>9} {:>30}\n", "datagrams", "taken", "per second of processor time");
  for (const relay::DatagramRate& rate : *rates)
    fmt::print("{:<22} {:>9} {:>30}\n", rate.name, rate.datagrams, rate.per_second);
  return k_ok;
}

}  // namespace

void add_siege_command(CLI::App& app, Tool& tool) {
  struct Options {
    relay::SiegeOptions siege;
    unsigned seconds = 20;
    bool rate = false;
  };
  auto options = std::make_shared<Options>();
  CLI::App* command = app.add_subcommand(
      "siege", "Attack a match on this machine: forged, replayed, damaged, too many packets");
  command->add_option("--seconds", options->seconds, "Length of the attack")
      ->check(CLI::Range(1U, 3600U))
      ->capture_default_str();
  command
      ->add_option("--players", options->siege.honest,
                   "Honest ones; the game needs two more seats, for attackers")
      ->check(CLI::Range(1U, 14U))
      ->capture_default_str();
  command->add_option("--seed", options->siege.seed, "Seed of the attackers' choices")
      ->capture_default_str();
  command->add_flag("--rate", options->rate,
                    "Measure instead how many datagrams of each kind one core gets through");
  command->callback([options, &tool] {
    if (options->rate) {
      tool.exit_code = print_rates();
      return;
    }
    if (!has_matches(tool.games)) {
      tool.exit_code = k_usage;
      return;
    }
    options->siege.game = &tool.games.list().front();
    options->siege.duration_us = std::int64_t{options->seconds} * 1'000'000;
    tool.exit_code = siege(options->siege);
  });
}

}  // namespace lockstone::tool
