// lossy: a relay that behaves like a bad network, for a server elsewhere or for a match of its own.
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>

#include <fmt/format.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/match/net_commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/interrupt.h"
#include "tools/relay/lossy_relay.h"
#include "tools/relay/tcp_relay.h"
#include "tools/relay/trial_match.h"
#include "tools/tool/start_match.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct LossyOptions {
  std::string bind = "127.0.0.1";
  std::uint16_t port = 0;
  std::string host = "127.0.0.1";
  std::uint16_t to = 0;
  std::uint64_t seed = 1;
  double loss = 0, duplicate = 0, reorder = 0, flip = 0, truncate = 0;  // per cent
  double delay = 0, jitter = 0;                                         // milliseconds
  std::uint32_t burst = 0;
  double seconds = 0;
  double match = 0;
  double pause = 0;
  unsigned players = 4;
  unsigned input_delay = 4;
  bool tcp = false;
};

std::uint32_t ppm(double percent) {
  return static_cast<std::uint32_t>(percent * 10'000 + 0.5);
}

std::int64_t to_us(double milliseconds) {
  return static_cast<std::int64_t>(milliseconds * 1000 + 0.5);
}

relay::Faults faults_of(const LossyOptions& options) {
  relay::Faults faults;
  faults.loss_ppm = ppm(options.loss);
  faults.burst_packets = options.burst;
  faults.duplicate_ppm = ppm(options.duplicate);
  faults.reorder_ppm = ppm(options.reorder);
  faults.flip_ppm = ppm(options.flip);
  faults.truncate_ppm = ppm(options.truncate);
  faults.delay_us = to_us(options.delay);
  faults.jitter_us = to_us(options.jitter);
  return faults;
}

void print_counters(const relay::RelayCounters& counters) {
  fmt::print(
      "relayed: {} datagrams, {} delivered, {} lost, {} doubled, {} held back, {} flipped, "
      "{} cut short, {} refused\n",
      counters.received, counters.delivered, counters.lost, counters.duplicated, counters.held_back,
      counters.flipped, counters.truncated, counters.refused);
}

int relay_tcp(const LossyOptions& options) {
  using namespace std::chrono_literals;
  const auto local = relay::Endpoint::from_text(options.bind, options.port);
  const auto server = relay::Endpoint::from_text(options.host, options.to);
  if (!local || !server) {
    complain("addresses are numeric, like 127.0.0.1");
    return k_usage;
  }
  const relay::SegmentFaults faults{ppm(options.loss), to_us(options.delay), to_us(options.jitter)};
  const auto opened = relay::TcpRelay::open(local.value(), server.value(), faults, options.seed);
  if (!opened) {
    complain(fmt::format("cannot listen on {}:{}", options.bind, options.port));
    return k_unavailable;
  }
  fmt::print("listening on {}:{}\n", options.bind, opened.value()->port());
  std::fflush(stdout);
  catch_interrupts();
  const Stopwatch watch;
  while (!interrupted() && (options.seconds <= 0 || watch.seconds() < options.seconds)) {
    opened.value()->pump(watch.microseconds());
    std::this_thread::sleep_for(500us);
  }
  const relay::SegmentCounters& counters = opened.value()->counters();
  fmt::print("relayed: {} connections, {} segments, {} lost, held back by {} ms at most\n",
             counters.connections, counters.segments, counters.lost, counters.longest_us / 1000);
  return k_ok;
}

int relay_to_server(const LossyOptions& options) {
  const auto local = relay::Endpoint::from_text(options.bind, options.port);
  const auto server = relay::Endpoint::from_text(options.host, options.to);
  if (!local || !server) {
    complain("addresses are numeric, like 127.0.0.1");
    return k_usage;
  }
  const auto opened =
      relay::LossyRelay::open(local.value(), server.value(), faults_of(options), options.seed);
  if (!opened) {
    complain(fmt::format("cannot listen on {}:{}", options.bind, options.port));
    return k_unavailable;
  }
  fmt::print("listening on {}:{}\n", options.bind, opened.value()->port());
  std::fflush(stdout);
  catch_interrupts();
  const Stopwatch watch;
  while (!interrupted() && (options.seconds <= 0 || watch.seconds() < options.seconds)) {
    opened.value()->pump(watch.microseconds());
    opened.value()->wait(watch.microseconds(), 20'000);
  }
  print_counters(opened.value()->counters());
  return k_ok;
}

// One player does nothing for the time of the pause, in the middle of the match.
void apply_pause(const LossyOptions& options, double seconds, relay::TrialMatch& match) {
  if (options.pause <= 0) return;
  const double begin = options.match / 2;
  match.pause(options.players - 1, seconds >= begin && seconds < begin + options.pause);
}

void print_bots(const LossyOptions& options, const relay::TrialMatch& match) {
  const double minutes = options.match / 60;
  for (unsigned slot = 0; slot < options.players; ++slot) {
    const relay::PlayerOutcome player = match.outcome(slot);
    const auto ticks = static_cast<double>(match.ticks_confirmed());
    fmt::print(
        "player {}: {} ticks, {} ({:.2f} %) inputs replaced, stalled {:.0f} ms a minute, "
        "longest {:.0f} ms, {}\n",
        slot, player.ticks, player.substituted,
        ticks > 0 ? 100 * static_cast<double>(player.substituted) / ticks : 0,
        static_cast<double>(player.stalled_us) / 1000 / minutes,
        static_cast<double>(player.longest_us) / 1000,
        player.equal ? "all hashes equal" : "hashes DIFFER");
    if (player.state == net::ClientState::finished) continue;
    fmt::print("player {} did not stay to the end: {}\n", slot, to_string(player.leave_reason));
  }
}

int play_match(const Games& games, const LossyOptions& options) {
  if (!has_matches(games)) return k_usage;
  relay::TrialOptions trial;
  trial.game = &games.list().front();
  trial.players = options.players;
  trial.seed = options.seed;
  trial.ticks = static_cast<std::uint64_t>(options.match * 60);
  trial.input_delay = static_cast<std::uint8_t>(options.input_delay);
  trial.faults = faults_of(options);
  const auto match = relay::TrialMatch::create(trial);
  if (match == nullptr) {
    complain("no match: no socket, no libsodium, or the game refuses this many players");
    return k_unavailable;
  }
  using namespace std::chrono_literals;
  const Stopwatch watch;
  catch_interrupts();
  while (!interrupted() && match->update(watch.microseconds())) {
    apply_pause(options, watch.seconds(), *match);
    std::this_thread::sleep_for(500us);
    if (watch.seconds() > options.match + 30) break;
  }
  print_bots(options, *match);
  fmt::print("server: {} ticks, longest between two {:.0f} ms\n", match->ticks_confirmed(),
             static_cast<double>(match->longest_server_gap_us()) / 1000);
  print_counters(match->relay()->counters());
  for (unsigned slot = 0; slot < options.players; ++slot) {
    if (!match->outcome(slot).equal) return k_different;
  }
  return match->ticks_confirmed() == trial.ticks ? k_ok : k_unavailable;
}

void add_fault_options(CLI::App& command, LossyOptions& options) {
  const CLI::Range percent(0.0, 90.0);
  command.add_option("--loss", options.loss, "Lose this percentage of datagrams")->check(percent);
  command.add_option("--burst", options.burst,
                     "Lose datagrams in runs of this mean length; 0: one by one");
  command.add_option("--duplicate", options.duplicate, "Send this percentage twice")
      ->check(percent);
  command.add_option("--reorder", options.reorder, "Hold this percentage back by up to 40 ms")
      ->check(percent);
  command.add_option("--flip", options.flip, "Flip a bit of this percentage")->check(percent);
  command.add_option("--truncate", options.truncate, "Cut this percentage short")->check(percent);
  command.add_option("--delay", options.delay, "One way, ms")->check(CLI::Range(0.0, 10000.0));
  command.add_option("--jitter", options.jitter, "The delay varies by so much up and down, ms")
      ->check(CLI::Range(0.0, 10000.0));
  command.add_option("--seed", options.seed, "Seed of all random choices")->capture_default_str();
}

}  // namespace

void add_lossy_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<LossyOptions>();
  CLI::App* command = app.add_subcommand(
      "lossy", "Relay UDP or TCP as a bad network would, to a server or in a match of bots");
  command->add_option("--bind", options->bind, "Numeric IPv4 address")->capture_default_str();
  command->add_option("--port", options->port, "Where clients call; 0: the system chooses");
  command->add_option("--host", options->host, "The server's address")->capture_default_str();
  CLI::Option* to = command->add_option("--to", options->to, "The server's port");
  command->add_flag("--tcp", options->tcp,
                    "Relay TCP: --loss delays a segment, and all behind it, as its repair would");
  command->add_option("--seconds", options->seconds,
                      "Stop after this time; default: when interrupted");
  add_fault_options(*command, *options);
  CLI::Option* match =
      command->add_option("--match", options->match, "Play for this many seconds, and measure")
          ->check(CLI::Range(1.0, 3600.0));
  command->add_option("--players", options->players, "Players of that match")
      ->check(CLI::Range(1U, 16U))
      ->capture_default_str();
  command->add_option("--input-delay", options->input_delay, "Input delay of that match, in ticks")
      ->check(CLI::Range(0, 60))
      ->capture_default_str();
  command->add_option("--pause", options->pause, "Stop its last player for this many seconds");
  match->excludes(to);
  command->callback([options, &tool] {
    if (options->match <= 0 && options->to == 0) {
      complain("give --to PORT or --match SECONDS");
      tool.exit_code = k_usage;
      return;
    }
    tool.exit_code = options->match > 0 ? play_match(tool.games, *options)
                     : options->tcp     ? relay_tcp(*options)
                                        : relay_to_server(*options);
  });
}

}  // namespace lockstone::tool
