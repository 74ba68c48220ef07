#include <cstdio>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <lockstone/replay/source.h>
#include <lockstone/replay/verifier.h>

#include "tools/arena/arena_simulation.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/match/match_host.h"
#include "tools/lockstone/match/match_options.h"
#include "tools/lockstone/match/secrets.h"
#include "tools/lockstone/support/child_process.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/interrupt.h"
#include "tools/lockstone/support/output_file.h"
#include "tools/render/svg.h"
#include "tools/scenes/play.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct DemoOptions {
  MatchOptions match;
  std::string svg = "demo.svg";
  std::optional<std::uint64_t> flip_bit_at;
};

std::string token_path(const std::string& folder, unsigned slot) {
  return fmt::format("{}/{}", folder, slot);
}

// A token for each player, in files of the folder. False, with a complaint, when there are none.
bool issue_tokens(const DemoOptions& options, const std::string& folder) {
  net::SystemRandom random;
  for (unsigned slot = 0; slot < options.match.start.players; ++slot) {
    net::TokenGrant grant;
    grant.match = options.match.match;
    grant.player = slot;
    grant.slot = static_cast<std::uint8_t>(slot);
    grant.expires_unix_s = unix_seconds() + 60;
    const auto token = net::issue_token(*options.match.key, grant, random);
    if (!token) return false;
    if (!write_secret_file(token_path(folder, slot), token.value().to_text())) return false;
  }
  return true;
}

std::vector<ChildProcess> start_players(const DemoOptions& options, const std::string& folder,
                                        std::uint16_t port) {
  std::vector<ChildProcess> players;
  for (unsigned slot = 0; slot < options.match.start.players; ++slot) {
    std::vector<std::string> arguments{
        "join",       "--quiet",
        "--port",     std::to_string(port),
        "--bot-seed", std::to_string(options.match.start.seed + slot),
        "--slot",     std::to_string(slot),
        "--name",     fmt::format("bot {}", slot)};
    arguments.push_back(options.match.insecure ? "--insecure" : "--token");
    if (!options.match.insecure) arguments.push_back(token_path(folder, slot));
    if (options.flip_bit_at && slot + 1 == options.match.start.players) {
      arguments.push_back("--flip-bit-at");
      arguments.push_back(std::to_string(*options.flip_bit_at));
    }
    players.push_back(ChildProcess::start(arguments));
  }
  return players;
}

void play(MatchHost& host) {
  bool stopping = false;
  while (host.update()) {
    if (!interrupted() || stopping) continue;
    host.stop();
    stopping = true;
  }
}

/// The verifier's verdict on the demo's log, and the time it took.
struct Verification {
  replay::VerifyReport report;
  double seconds = 0;
};

Verification verify_log(const GameDef& game, const std::string& path) {
  Verification result;
  auto source = replay::FileSource::open(path);
  if (!source) {
    result.report.outcome = replay::VerifyOutcome::corrupt;
    return result;
  }
  Progress progress;
  const Stopwatch watch;
  result.report = replay::verify(
      *source.value(), game.make, {.strict = true},
      [&](std::uint64_t ticks, std::uint64_t total) { progress.show("verify", ticks, total); });
  result.seconds = watch.seconds();
  return result;
}

void row(std::string_view name, const std::string& value) {
  fmt::print("  {:<13} {}\n", name, value);
}

void print_hashes(const MatchSummary& summary) {
  std::uint64_t compared = 0, equal = 0, late = 0, substituted = 0;
  for (const net::PlayerStats& player : summary.players) {
    compared += player.hashes_compared;
    equal += player.hashes_equal;
    late += player.late_inputs;
    substituted += player.substituted_inputs;
  }
  row("hashes",
      fmt::format("{} compared, {} equal, {} different", compared, equal, compared - equal));
  row("late inputs", fmt::format("{}, {} replaced", late, substituted));
}

// Traffic per second of game time, so that fast and real-time matches compare.
void print_traffic(const MatchSummary& summary, unsigned tick_rate) {
  const double seconds = static_cast<double>(summary.ticks) / tick_rate;
  if (seconds <= 0) return;
  for (std::size_t slot = 0; slot < summary.players.size(); ++slot) {
    const net::PlayerStats& player = summary.players[slot];
    row(fmt::format("player {}", slot),
        fmt::format("{:.0f} bytes/s up, {:.0f} down",
                    static_cast<double>(player.bytes_received) / seconds,
                    static_cast<double>(player.bytes_sent) / seconds));
  }
}

void print_verification(const DemoOptions& options, const Verification& verification,
                        unsigned tick_rate) {
  std::error_code error;
  const auto bytes = std::filesystem::file_size(options.match.record, error);
  row("log", fmt::format("{}, {:.1f} KiB", options.match.record,
                         error ? 0 : static_cast<double>(bytes) / 1024));
  row("verify", verification.report.to_line());
  if (verification.seconds <= 0) return;
  const double game_seconds = static_cast<double>(verification.report.ticks_verified) / tick_rate;
  row("", fmt::format("{:.0f} times real time", game_seconds / verification.seconds));
}

// "12, −1, 5": points by player, where the match was one of the arena.
std::string scores_of(const Simulation& simulation) {
  const auto* game = dynamic_cast<const arena::ArenaSimulation*>(&simulation);
  if (game == nullptr) return {};
  std::string text;
  for (unsigned slot = 0; slot < game->arena().config.players; ++slot) {
    text += fmt::format("{}{}", slot == 0 ? "" : ", ", game->arena().state.players[slot].score);
  }
  return text;
}

void print_summary(const DemoOptions& options, const MatchSummary& summary,
                   const Verification& verification, const Simulation& simulation) {
  const unsigned tick_rate = simulation.info().tick_rate;
  fmt::print("\n");
  row("players", std::to_string(summary.players.size()));
  row("ticks", fmt::format("{} of {}, {}, {:.1f} s, {:.1f} times real time", summary.ticks,
                           options.match.ticks, to_string(summary.reason), summary.seconds,
                           summary.seconds > 0
                               ? static_cast<double>(summary.ticks) / tick_rate / summary.seconds
                               : 0));
  print_hashes(summary);
  print_traffic(summary, tick_rate);
  print_verification(options, verification, tick_rate);
  row("scores", scores_of(simulation));
  row("final hash", hash_text(summary.final_hash));
  row("picture", options.svg);
  if (!has_studio()) return;
  std::error_code error;
  const std::filesystem::path program = std::filesystem::read_symlink("/proc/self/exe", error);
  row("to watch it",
      fmt::format("{} studio {}", error ? program_name() : program.string(), options.match.record));
}

bool draw_end(const DemoOptions& options, const MatchHost& host) {
  render::Picture picture;
  picture.style = render::arena_look;
  picture.caption = fmt::format("tick {}   {}   scores {}", host.simulation().tick(),
                                hash_text(host.simulation().hash()), scores_of(host.simulation()));
  return write_text_file({options.svg, options.match.force},
                         render::draw(*scenes::world_of(host.simulation()), picture));
}

int exit_code_for(const MatchSummary& summary, const Verification& verification, bool players_ok) {
  if (summary.desyncs > 0) return k_different;
  if (summary.record_status != Status::ok) return k_unavailable;
  if (verification.report.outcome != replay::VerifyOutcome::same) {
    return exit_code(verification.report.outcome);
  }
  return players_ok ? k_ok : k_unavailable;
}

int demo(const Games& games, DemoOptions options) {
  if (!may_write({options.svg, options.match.force})) return k_unavailable;
  catch_interrupts();
  const PrivateFolder folder;
  if (!options.match.insecure) {
    if (!require_security()) return k_unavailable;
    net::SystemRandom random;
    options.match.key = net::make_key(random);
    if (folder.path().empty() || !issue_tokens(options, folder.path())) return k_unavailable;
  }
  options.match.max_per_address = 64;  // all are on this machine
  const std::unique_ptr<MatchHost> host = MatchHost::create(games, options.match);
  if (host == nullptr) return k_unavailable;
  std::vector<ChildProcess> players = start_players(options, folder.path(), host->port());
  play(*host);
  bool players_ok = true;
  for (ChildProcess& player : players)
    players_ok = player.wait(5) == k_ok && players_ok;
  const MatchSummary summary = host->finish();
  const Verification verification = verify_log(host->game(), options.match.record);
  const bool drawn = draw_end(options, *host);
  print_summary(options, summary, verification, host->simulation());
  const int code = exit_code_for(summary, verification, players_ok);
  return code == k_ok && !drawn ? static_cast<int>(k_unavailable) : code;
}

}  // namespace

void add_demo_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<DemoOptions>();
  options->match.record = "demo.lks";
  options->match.ticks = 900;
  options->match.start.players = 4;
  CLI::App* command = app.add_subcommand(
      "demo", "Play a match of bots on this machine, one process each, and verify its log");
  add_match_options(*command, tool.games, options->match);
  command->add_option("--record", options->match.record, "The log")->capture_default_str();
  command->add_option("--svg", options->svg, "A picture of the end")->capture_default_str();
  command->add_flag("--insecure", options->match.insecure, "Without tokens and encryption");
  command->add_option("--flip-bit-at", options->flip_bit_at,
                      "Let the last player go wrong by one bit at this tick: it must be found");
  command->callback([options, &tool] { tool.exit_code = demo(tool.games, *options); });
}

}  // namespace lockstone::tool
