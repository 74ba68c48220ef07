#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/match/agones.h"
#include "tools/lockstone/match/journal.h"
#include "tools/lockstone/match/match_host.h"
#include "tools/lockstone/match/match_options.h"
#include "tools/lockstone/match/rooms.h"
#include "tools/lockstone/match/secrets.h"
#include "tools/lockstone/match/servers.h"
#include "tools/lockstone/match/web_players.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/interrupt.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct ServeOptions {
  MatchOptions match;
  std::string policy = "deadline";
  std::string on_desync = "resync";
  std::optional<unsigned> matches;
  RoomsOptions rooms{.rooms = 0};
  bool agones = false;
  std::string key;
  std::string sign;
  std::vector<std::string> addresses;
  std::string log_format = "text";
  bool drain = false;
};

// Not k_ok, with a complaint, unless the match is either for tokens or insecure by name.
int set_security(ServeOptions& options) {
  if (options.match.insecure == !options.key.empty()) {
    complain("give --key FILE and --match N, or say --insecure");
    return k_usage;
  }
  if (options.match.insecure) return k_ok;
  if (!require_security()) return k_unavailable;
  options.match.key = read_key(options.key);
  if (!add_servers(options.addresses, options.match.addresses)) return k_usage;
  return options.match.key ? k_ok : k_corrupt;
}

// False, with a complaint, when a log is to be signed and cannot be.
bool set_signing(ServeOptions& options) {
  if (options.sign.empty()) return true;
  if (options.match.record.empty()) {
    complain("--sign signs the log of --record FILE");
    return false;
  }
  options.match.signing_key = read_signing_key(options.sign);
  return options.match.signing_key.has_value();
}

// `agones` may be null.
int run_match(MatchHost& host, bool drains, Agones* agones) {
  bool stopping = false;
  bool begun = false;
  while (host.update()) {
    if (agones != nullptr) {
      agones->beat();
      if (host.begun() && !std::exchange(begun, true)) agones->match_began();
    }
    if (!interrupted() || stopping) continue;
    if (drains && asked_to_end()) {
      host.drain();
      continue;
    }
    host.stop();
    stopping = true;
  }
  const MatchSummary summary = host.finish();
  if (begun) agones->match_ended(false);
  host.say_summary(summary);
  if (summary.desyncs > 0) return k_different;
  return summary.record_status == Status::ok ? k_ok : k_unavailable;
}

// The options of one of several matches: ports count up, files get the number as an ending.
MatchOptions options_of(const ServeOptions& options, unsigned index) {
  MatchOptions match = options.match;
  if (options.matches.value_or(1) == 1) return match;
  if (match.port != 0) match.port = static_cast<std::uint16_t>(match.port + index);
  if (match.web.port.value_or(0) != 0) {
    match.web.port = static_cast<std::uint16_t>(*match.web.port + index);
  }
  if (match.metrics_port != 0) {
    match.metrics_port = static_cast<std::uint16_t>(match.metrics_port + index);
  }
  for (std::string* file : {&match.record, &match.bundle}) {
    if (!file->empty()) *file += fmt::format(".{}", index);
  }
  return match;
}

// Each match has ports of its own, and they must exist.
int check_matches(const ServeOptions& options) {
  constexpr unsigned k_last_port = 65535;
  constexpr unsigned k_most = 64;
  const unsigned matches = options.matches.value_or(1);
  if (matches < 1 || matches > k_most) {
    complain(fmt::format("--matches is {}; without --rooms it must be 1 … {}", matches, k_most));
    return k_usage;
  }
  const std::uint16_t web_port = options.match.web.port.value_or(0);
  for (const std::uint16_t port : {options.match.port, web_port, options.match.metrics_port}) {
    if (port == 0 || port + matches - 1 <= k_last_port) continue;
    complain(fmt::format("{} matches from port {} on: there is none above {}", matches, port,
                         k_last_port));
    return k_usage;
  }
  if (matches == 1 || options.match.resume.empty()) return k_ok;
  complain("--resume is for one match");
  return k_usage;
}

// Rooms share a port, so that the tokens must name the match.
int check_rooms(const ServeOptions& options) {
  const bool possible =
      !options.match.insecure && options.match.resume.empty() && !options.match.fast;
  if (possible) return k_ok;
  complain("--rooms needs --key, and excludes --insecure, --resume and --fast");
  return k_usage;
}

// `[::1]`, as addresses with a port have it, means `::1`.
void remove_brackets(std::string& address) {
  const bool bracketed = address.size() > 2 && address.front() == '[' && address.back() == ']';
  const bool ipv6 = address.find(':') != std::string::npos;
  if (bracketed && ipv6) address = address.substr(1, address.size() - 2);
}

void say_listening(const ServeOptions& options, std::uint16_t port, const std::string& web) {
  const net::HostPort where{options.match.bind, port};
  Journal journal(options.match.json_log, port);
  journal.write({"listening", fmt::format("listening on {}", where.to_text())});
  if (!web.empty()) journal.write({"listening_web", fmt::format("listening on {}", web)});
}

int serve_ports(const Games& games, const ServeOptions& options, Agones* agones) {
  std::vector<std::unique_ptr<MatchHost>> hosts;
  for (unsigned i = 0; i < options.matches.value_or(1); ++i) {
    hosts.push_back(MatchHost::create(games, options_of(options, i)));
    if (hosts.back() == nullptr) return k_unavailable;
    say_listening(options, hosts.back()->port(), hosts.back()->web_address());
  }
  if (agones != nullptr) agones->ready();
  std::vector<int> exits(hosts.size());
  std::vector<std::thread> threads;
  for (std::size_t i = 1; i < hosts.size(); ++i)
    threads.emplace_back([&hosts, &exits, i, &options, agones] {
      exits[i] = run_match(*hosts[i], options.drain, agones);
    });
  exits[0] = run_match(*hosts[0], options.drain, agones);
  for (std::thread& thread : threads)
    thread.join();
  return *std::max_element(exits.begin(), exits.end());
}

// The main thread answers signals and scrapers.
int serve_rooms(const Games& games, const ServeOptions& options, Agones* agones) {
  std::unique_ptr<MetricsPort> metrics_port;
  if (options.match.metrics_port != 0) {
    metrics_port = MetricsPort::open(options.match.metrics_port, options.match.metrics_bind);
    if (metrics_port == nullptr) return k_unavailable;
  }
  RoomsOptions wanted = options.rooms;
  wanted.matches = options.matches.value_or(0);
  wanted.agones = agones;
  const std::unique_ptr<Rooms> rooms = Rooms::open(games, options.match, wanted);
  if (rooms == nullptr) return k_unavailable;
  say_listening(options, rooms->port(), rooms->web_address());
  if (agones != nullptr) agones->ready();
  while (!rooms->over()) {
    if (interrupted()) options.drain&& asked_to_end() ? rooms->drain() : rooms->stop();
    if (metrics_port != nullptr) {
      metrics_port->serve(
          [&rooms](std::string_view request) { return answer_about(request, rooms->metrics()); });
    }
    if (agones != nullptr && rooms->alive()) agones->beat();
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return rooms->finish();
}

int serve(const Games& games, ServeOptions options) {
  remove_brackets(options.match.bind);
  remove_brackets(options.match.metrics_bind);
  options.match.json_log = options.log_format == "json";
  options.match.strict = options.policy == "strict";
  options.match.desync_policy = options.on_desync == "kick"     ? net::DesyncPolicy::kick
                                : options.on_desync == "resync" ? net::DesyncPolicy::resync
                                                                : net::DesyncPolicy::end_match;
  const bool rooms = options.rooms.rooms > 0;
  if (const int code = rooms ? check_rooms(options) : check_matches(options); code != k_ok) {
    return code;
  }
  if (const int code = check_web(options.match.web); code != k_ok) return code;
  if (const int code = set_security(options); code != k_ok) return code;
  if (!set_signing(options)) return k_usage;
  std::unique_ptr<Agones> agones;
  if (options.agones) {
    agones = Agones::from_environment();
    if (agones == nullptr) return k_usage;
  }
  catch_interrupts();
  const int code =
      rooms ? serve_rooms(games, options, agones.get()) : serve_ports(games, options, agones.get());
  if (agones != nullptr) agones->shutdown();
  return code;
}

void add_service_options(CLI::App& command, ServeOptions& options) {
  command.add_flag("--drain", options.drain,
                   "On SIGTERM play a match that runs to its end, and take no new one; a second "
                   "signal, or Ctrl-C, stops it");
  command
      .add_option("--log-format", options.log_format,
                  "Print lines for people, or JSON, one object a line")
      ->check(CLI::IsMember({"text", "json"}))
      ->capture_default_str();
  command.add_flag("--agones", options.agones,
                   "Tell the sidecar of Agones: ready, health, allocated while a match runs, "
                   "shutdown");
}

void add_rooms_options(CLI::App& command, ServeOptions& options) {
  command.add_option("--matches", options.matches,
                     "Host this many matches, at most 64, on ports that follow; default: 1. With "
                     "--rooms: end after this many; default: never");
  command
      .add_option("--rooms", options.rooms.rooms,
                  "Host this many matches at once on one port, and a new one after each that ends. "
                  "Tokens name the match, from --match on")
      ->check(CLI::Range(1, 1024));
  command
      .add_option("--workers", options.rooms.workers,
                  "Threads that run the matches of rooms; 0: one less than the processors")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
}

void add_security_options(CLI::App& command, ServeOptions& options) {
  command.add_option("--key", options.key, "File with the key of `token key`");
  command.add_option("--match", options.match.match, "The number that the tokens are for")
      ->capture_default_str();
  command.add_option(
      "--address", options.addresses,
      "Take only tokens that name this server, like 1.2.3.4:7777, [2001:db8::1]:7777 or "
      "game.example:7777, or any server");
  command.add_flag("--insecure", options.match.insecure,
                   "No tokens and no encryption: anybody may join, listen and forge");
}

}  // namespace

void add_serve_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<ServeOptions>();
  CLI::App* command = app.add_subcommand("serve", "Host a match over UDP, and WebSockets for browsers");
  add_match_options(*command, tool.games, options->match);
  command
      ->add_option("--bind", options->match.bind,
                   "Numeric address; :: for all of IPv6 and IPv4, 0.0.0.0 for all of IPv4")
      ->capture_default_str();
  command->add_option("--port", options->match.port, "UDP port; 0: the system chooses")
      ->capture_default_str();
  command
      ->add_option("--max-connections-per-address", options->match.max_per_address,
                   "Players and spectators behind one router share an address; IPv6: a /64")
      ->check(CLI::Range(1, 1024))
      ->capture_default_str();
  command->add_option("--record", options->match.record, "Write the log to this file");
  command->add_option("--resume", options->match.resume,
                      "Go on with the match of a killed server, from its log; the scene comes "
                      "from there, other options as before. The log goes on in the same file, or "
                      "in that of --record");
  command->add_option("--sign", options->sign,
                      "Sign the log with the secret key in this file, see `keygen`");
  command->add_option("--policy", options->policy, "On a late input: replace it, or wait for it")
      ->check(CLI::IsMember({"deadline", "strict"}))
      ->capture_default_str();
  command
      ->add_option("--start-players", options->match.start_players,
                   "Begin with this many players; others may come later. 0: with all")
      ->check(CLI::Range(std::size_t{0}, k_max_players))
      ->capture_default_str();
  command
      ->add_option("--drop-after", options->match.drop_after_s,
                   "Drop a player that is silent for this many seconds")
      ->check(CLI::Range(1.0, 3600.0))
      ->capture_default_str();
  command
      ->add_option("--spectators", options->match.spectators, "Spectators that may watch at once")
      ->check(CLI::Range(0, 256))
      ->capture_default_str();
  command->add_option("--spectator-delay", options->match.spectator_delay_s, "Seconds")
      ->check(CLI::Range(0, 180))
      ->capture_default_str();
  command
      ->add_option(
          "--on-desync", options->on_desync,
          "A player whose state is wrong: end the match, send the player away for good, or "
          "correct it once")
      ->check(CLI::IsMember({"end", "kick", "resync"}))
      ->capture_default_str();
  command->add_option("--bundle", options->match.bundle,
                      "Write the first desync to this file (tar): report, both states, log");
  command->add_option("--metrics-port", options->match.metrics_port,
                      "Answer /metrics, /stats.json, /readyz and /livez over HTTP");
  command
      ->add_option("--metrics-bind", options->match.metrics_bind,
                   "Numeric address for that; anybody who reaches it may read")
      ->capture_default_str();
  add_web_options(*command, options->match.web);
  add_rooms_options(*command, *options);
  add_service_options(*command, *options);
  add_security_options(*command, *options);
  command->callback([options, &tool] { tool.exit_code = serve(tool.games, *options); });
}

}  // namespace lockstone::tool
