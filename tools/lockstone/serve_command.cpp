#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/console.h"
#include "tools/lockstone/interrupt.h"
#include "tools/lockstone/match_host.h"
#include "tools/lockstone/match_options.h"

namespace lockstone::tool {
namespace {

struct ServeOptions {
  MatchOptions match;
  std::string policy = "deadline";
};

void print_players(const MatchSummary& summary) {
  for (std::size_t slot = 0; slot < summary.players.size(); ++slot) {
    const net::PlayerStats& player = summary.players[slot];
    fmt::print("player {}: {} of {} hashes equal, {} late inputs, {} bytes in, {} bytes out\n",
               slot, player.hashes_equal, player.hashes_compared, player.late_inputs,
               player.bytes_received, player.bytes_sent);
  }
}

int serve(ServeOptions options) {
  options.match.strict = options.policy == "strict";
  catch_interrupts();
  const std::unique_ptr<MatchHost> host = MatchHost::create(options.match);
  if (host == nullptr) return k_unavailable;
  fmt::print("listening on {}:{}\n", options.match.bind, host->port());
  std::fflush(stdout);
  bool stopping = false;
  while (host->update()) {
    if (!interrupted() || stopping) continue;
    host->stop();
    stopping = true;
  }
  const MatchSummary summary = host->finish();
  fmt::print("the match is over: {}, {} ticks, final hash {}\n", to_string(summary.reason),
             summary.ticks, hash_text(summary.final_hash));
  print_players(summary);
  if (summary.desyncs > 0) return k_different;
  return summary.record_status == Status::ok ? k_ok : k_unavailable;
}

}  // namespace

void add_serve_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<ServeOptions>();
  CLI::App* command = app.add_subcommand("serve", "Host a match over UDP");
  add_match_options(*command, options->match);
  command->add_option("--bind", options->match.bind, "Numeric IPv4 address")->capture_default_str();
  command->add_option("--port", options->match.port, "UDP port; 0: the system chooses")
      ->capture_default_str();
  command->add_option("--scene", options->match.scene, "What is simulated, see `scenes`")
      ->capture_default_str();
  command->add_option("--record", options->match.record, "Write the log to this file");
  command->add_option("--policy", options->policy, "On a late input: replace it, or wait for it")
      ->check(CLI::IsMember({"deadline", "strict"}))
      ->capture_default_str();
  command
      ->add_flag("--insecure", options->match.insecure,
                 "There is no encryption yet: say that this network needs none")
      ->required();
  command->callback([options, &exit_code] { exit_code = serve(*options); });
}

}  // namespace lockstone::tool
