#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <lockstone/net/client.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/state/flipping_simulation.h"
#include "tools/lockstone/match/caller.h"
#include "tools/lockstone/match/secrets.h"
#include "tools/lockstone/match/servers.h"
#include "tools/lockstone/support/build_text.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/interrupt.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/relay/stall_watch.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct JoinOptions {
  std::string server;
  std::string web;
  std::string host = "127.0.0.1";
  std::uint16_t port = 0;
  std::string token;
  std::uint64_t bot_seed = 1;
  std::string name = "bot";
  std::string say;
  int slot = net::k_no_slot;
  std::optional<std::uint64_t> flip_bit_at;
  bool spectate = false;
  unsigned predict = 0;
  double reconnect = 30;
  bool insecure = false;
  bool json = false;
  bool quiet = false;
};

/// A client's copy of the match: made by whichever game knows its configuration.
class JoinedGame {
 public:
  JoinedGame(const Games& games, std::optional<std::uint64_t> flip_bit_at)
      : games_(games), flip_bit_at_(flip_bit_at) {}

  [[nodiscard]] SimulationFactory factory() {
    return [this](ByteView config) -> Result<std::unique_ptr<Simulation>> {
      Result<std::unique_ptr<Simulation>> made = Status::not_found;
      for (const GameDef& game : games_.list()) {
        made = game.make(config);
        game_ = &game;
        if (made) break;
      }
      if (!made || !flip_bit_at_) return made;
      return make_flipping(*game_, std::move(made).value(), *flip_bit_at_);
    };
  }

  /// The first game until a simulation is made.
  [[nodiscard]] const GameDef& game() const { return *game_; }

 private:
  const Games& games_;
  const GameDef* game_ = &games_.list().front();
  std::optional<std::uint64_t> flip_bit_at_;
};

/// Plays for the local player, by the state of this client's own simulation.
class BotInputs final : public net::InputSource {
 public:
  BotInputs(const JoinedGame& joined, std::uint64_t seed) : joined_(joined), seed_(seed) {}

  void watch(const net::Client& client) { client_ = &client; }

  void sample(std::uint64_t tick, std::span<std::byte> out) override {
    const Simulation* simulation = client_->simulation();
    if (simulation == nullptr || client_->slot() == net::k_no_slot) return;
    const BotView view{unwrapped(*simulation), seed_, client_->slot(), tick};
    static_cast<void>(press(joined_.game(), view, out));  // neutral inputs where nobody plays
  }

 private:
  const JoinedGame& joined_;
  std::uint64_t seed_;
  const net::Client* client_ = nullptr;
};

class JoinObserver final : public net::ClientObserver {
 public:
  JoinObserver(bool quiet, const JoinedGame& joined) : quiet_(quiet), joined_(joined) {}

  void joined(std::uint8_t slot) override {
    const bool back = std::exchange(own_slot_, slot) == slot;
    if (quiet_) return;
    const bool watches = slot == net::k_spectator_slot;
    fmt::print(stderr, "{} {}\n", back ? "back as" : "joined as",
               watches ? "a spectator" : fmt::format("player {}", slot));
  }
  void commands_stepped(std::uint64_t, std::span<const PlayerCommand> commands) override {
    if (quiet_ || joined_.game().chat_text == nullptr) return;
    for (const PlayerCommand& command : commands) {
      const std::optional<std::string> text = joined_.game().chat_text(command.bytes);
      if (text) fmt::print(stderr, "player {}: {}\n", command.slot, *text);
    }
  }
  void player_named(std::uint8_t slot, std::string_view name) override {
    if (quiet_ || slot == own_slot_ || name.empty()) return;
    fmt::print(stderr, "player {} is {}\n", slot, name);
  }
  void tick_stepped(std::uint64_t tick, std::span<const PlayerInput>, std::uint64_t hash) override {
    final_hash = hash;
    stalls.tick(watch.microseconds());
    if (tick == active_tick_) active_seconds = watch.seconds();
  }
  void player_active(std::uint8_t slot, std::uint64_t tick) override {
    if (slot == own_slot_) active_tick_ = tick;
  }
  void desync_reported(const net::DesyncReport& report) override {
    desync = report.to_line();
    if (!quiet_) complain("desync: " + desync);
  }

  std::uint64_t final_hash = 0;
  std::string desync;
  unsigned reconnects = 0;  ///< tried
  Stopwatch watch;
  relay::StallWatch stalls;
  double active_seconds = 0;  ///< from the start until it played in a running match; 0: it did not

 private:
  bool quiet_;
  const JoinedGame& joined_;
  std::uint8_t own_slot_ = net::k_no_slot;
  std::uint64_t active_tick_ = ~std::uint64_t{0};
};

bool is_over(net::ClientState state) {
  return state == net::ClientState::finished || state == net::ClientState::refused ||
         state == net::ClientState::failed;
}

std::string_view failure_text(net::ClientFailure failure) {
  switch (failure) {
    case net::ClientFailure::none:
      return "no failure";
    case net::ClientFailure::connection_lost:
      return "the connection was lost";
    case net::ClientFailure::handshake_timed_out:
      return "the server did not answer";
    case net::ClientFailure::server_silent:
      return "the server fell silent";
    case net::ClientFailure::server_malformed:
      return "the server sent malformed packets";
    case net::ClientFailure::config_not_understood:
      return "the match's configuration is unknown";
    case net::ClientFailure::not_deterministic:
      return "the simulation is not deterministic";
    case net::ClientFailure::dropped:
      return "the server dropped this player";
  }
  return "unknown failure";
}

void print_json(const net::Client& client, const JoinObserver& observer) {
  const net::ClientStats stats = client.stats();
  const nlohmann::ordered_json json{
      {"slot", client.slot()},
      {"ticks", client.ticks_stepped()},
      {"final_hash", hash_text(observer.final_hash)},
      {"bytes_sent", stats.bytes_sent},
      {"bytes_received", stats.bytes_received},
      {"substituted_inputs", stats.substituted_inputs},
      {"resends_requested", stats.resends_requested},
      {"round_trip_us", stats.round_trip_us},
      {"jitter_us", stats.jitter_us},
      {"margin_quarters", stats.margin_quarters},
      {"lead_ticks", stats.lead_ticks},
      {"rollbacks", stats.rollbacks},
      {"ticks_stepped_again", stats.ticks_stepped_again},
      {"islands_computed_again", stats.islands_computed_again},
      {"islands_recalled", stats.islands_recalled},
      {"states_loaded", stats.states_loaded},
      {"reconnects", observer.reconnects},
      {"stalled_ms", observer.stalls.stalled_us() / 1000},
      {"longest_between_ticks_ms", observer.stalls.longest_us() / 1000},
      {"seconds_to_active", observer.active_seconds},
      {"desync", observer.desync}};
  write_json(json);
}

int conclude(const JoinOptions& options, const net::Client& client, const JoinObserver& observer) {
  if (options.json) print_json(client, observer);
  if (client.state() == net::ClientState::refused) {
    complain(client.refusal().to_line());
    return client.refusal().reason == net::RefuseReason::simulation_mismatch ? k_incompatible
                                                                             : k_unavailable;
  }
  if (!observer.desync.empty()) return k_different;
  if (client.state() == net::ClientState::failed) {
    complain(std::string(failure_text(client.failure())));
    return client.failure() == net::ClientFailure::config_not_understood ? k_incompatible
                                                                         : k_unavailable;
  }
  if (!options.quiet && !options.json) {
    fmt::print("the match is over: {}, {} ticks, final hash {}\n",
               to_string(client.finish_reason()), client.ticks_stepped(),
               hash_text(observer.final_hash));
  }
  return k_ok;
}

/// Plays to the end. A lost connection is made again, for a while; until it is in, by the next
/// target.
class Play {
 public:
  Play(const JoinOptions& options, Targets& targets, Caller& caller, net::Client& client,
       JoinObserver& observer, const JoinedGame& joined)
      : options_(options),
        targets_(targets),
        caller_(caller),
        client_(client),
        observer_(observer),
        joined_(joined) {}

  void run() {
    using namespace std::chrono_literals;
    std::uint64_t seen = 0;
    std::int64_t busy_us = 0;
    while (!is_over(client_.state()) || come_back()) {
      client_.update(watch_.microseconds());
      if (client_.state() == net::ClientState::running) {
        lost_seconds_ = -1;
        calls_ = 0;
      }
      say_once();
      if (interrupted() && !std::exchange(leaving_, true)) client_.leave();
      const bool busy = std::exchange(seen, client_.ticks_stepped()) != client_.ticks_stepped();
      if (busy) busy_us = watch_.microseconds();
      // In a fast match the next tick is near; at 60 a second there is time.
      const bool soon = watch_.microseconds() - busy_us < 2000;
      if (!busy) std::this_thread::sleep_for(soon ? 100us : 1000us);
    }
  }

 private:
  void say_once() {
    const auto& chat = joined_.game().chat_command;
    const bool says = !options_.say.empty() && !said_ && chat != nullptr;
    if (says && client_.state() == net::ClientState::running)
      said_ = client_.send_command(chat(options_.say)).ok();
  }

  // False when there is nothing to come back to, or it took too long.
  [[nodiscard]] bool come_back() {
    if (leaving_ || interrupted() || !client_.may_reconnect()) return false;
    const double now = watch_.seconds();
    if (pause_seconds_ == 0) return plan_call(now);
    if (now < call_seconds_) return true;
    pause_seconds_ = 0;
    const Result<net::ConnectionId> connection = caller_.call_next(targets_);
    if (!connection || !client_.reconnect(connection.value())) return connection.ok();
    ++observer_.reconnects;
    return true;
  }

  // Strangers call one target after the other, twice each at least. The pause between two rounds is
  // short at first, then twice as long each time.
  [[nodiscard]] bool plan_call(double now) {
    constexpr double k_next_target_seconds = 0.01;
    constexpr double k_first_pause_seconds = 0.25;
    constexpr double k_longest_pause_seconds = 4;
    constexpr std::size_t k_calls_of_strangers = 3;
    if (lost_seconds_ < 0) lost_seconds_ = now;
    const bool stranger = client_.rejoin_key() == 0;
    const std::size_t round = stranger ? targets_.count() : 1;
    if (stranger && calls_ >= std::max(k_calls_of_strangers, 2 * round - 1)) return false;
    if (stranger) targets_.go_on();
    ++calls_;
    const std::size_t rounds = std::min<std::size_t>(calls_ / round, 8);
    pause_seconds_ = calls_ % round != 0
                         ? k_next_target_seconds
                         : std::min(k_first_pause_seconds * static_cast<double>(1U << (rounds - 1)),
                                    k_longest_pause_seconds);
    if (now + pause_seconds_ - lost_seconds_ > options_.reconnect) return false;
    call_seconds_ = now + pause_seconds_;
    if (!options_.quiet) {
      const std::string where = round > 1 ? targets_.current().to_text() : "again";
      fmt::print(stderr, "{}: calling {} in {} s\n", why(), where, pause_seconds_);
    }
    return true;
  }

  [[nodiscard]] std::string why() const {
    if (client_.state() == net::ClientState::refused) return client_.refusal().to_line();
    return std::string(failure_text(client_.failure()));
  }

  const JoinOptions& options_;
  Targets& targets_;
  Caller& caller_;
  net::Client& client_;
  JoinObserver& observer_;
  const JoinedGame& joined_;
  Stopwatch watch_;
  bool leaving_ = false;
  bool said_ = false;
  double lost_seconds_ = -1;  ///< since when; below 0: it is not
  std::size_t calls_ = 0;     ///< since then
  double pause_seconds_ = 0;  ///< before the next call; 0: none is planned
  double call_seconds_ = 0;   ///< when it is due
};

// Reads the token, if there is to be one. Not k_ok, with a complaint.
int set_security(const JoinOptions& options, std::optional<net::ConnectToken>& token) {
  if (options.insecure == !options.token.empty()) {
    complain("give --token FILE, or say --insecure");
    return k_usage;
  }
  if (options.insecure) return k_ok;
  if (!require_security()) return k_unavailable;
  token = read_token(options.token);
  return token ? k_ok : k_corrupt;
}

// Not k_ok, with a complaint, if nothing says where the server is.
int find_targets(const JoinOptions& options, const std::optional<net::ConnectToken>& token,
                 std::vector<net::HostPort>& targets) {
  if (!options.web.empty()) {
    targets.push_back({options.web, 0});
    return k_ok;
  }
  net::HostPort server{options.host, options.port};
  if (!options.server.empty()) {
    const Result<net::HostPort> read = net::HostPort::from_text(options.server);
    if (!read) {
      complain(fmt::format("{} is no server like 1.2.3.4:7777, [::1]:7777 or localhost:7777",
                           options.server));
      return k_usage;
    }
    server = read.value();
  }
  if (server.port != 0) {
    targets = look_up(server);
    return targets.empty() ? k_unavailable : k_ok;
  }
  for (std::size_t i = 0; token && i < token->grant.servers.count; ++i)
    targets.push_back(token->grant.servers.entries[i].to_host_port());
  if (!targets.empty()) return k_ok;
  complain("neither --server nor --port is given, and no token names a server");
  return k_usage;
}

int join(const Games& games, const JoinOptions& options) {
  constexpr std::int64_t k_patience_us = 2'000'000;  // with a server that may be elsewhere
  catch_interrupts();
  std::optional<net::ConnectToken> token;
  if (const int code = set_security(options, token); code != k_ok) return code;
  std::vector<net::HostPort> found;
  if (const int code = find_targets(options, token, found); code != k_ok) return code;
  Targets targets(std::move(found));
  const std::unique_ptr<Caller> caller = call(targets, token);
  if (caller == nullptr) return k_unavailable;
  JoinedGame joined(games, options.flip_bit_at);
  BotInputs inputs(joined, options.bot_seed);
  JoinObserver observer(options.quiet, joined);
  net::ClientConfig config;
  if (targets.count() > 1) config.timeouts.handshake_us = k_patience_us;
  config.insecure = options.insecure;
  config.name = options.name;
  config.wanted_slot =
      static_cast<std::uint8_t>(options.spectate ? net::k_spectator_slot : options.slot);
  config.build = build_text(build_of(joined.game()));
  config.prediction_ticks = static_cast<std::uint8_t>(options.predict);
  const net::Client::Created created = net::Client::create(
      config, {caller->transport(), caller->connection(), joined.factory(), &inputs, &observer});
  if (created.client == nullptr) {
    complain(std::string(to_string(created.error)));
    return k_usage;
  }
  inputs.watch(*created.client);
  Play(options, targets, *caller, *created.client, observer, joined).run();
  return conclude(options, *created.client, observer);
}

}  // namespace

void add_join_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<JoinOptions>();
  CLI::App* command = app.add_subcommand("join", "Play in a match, as a bot");
  CLI::Option* server = command->add_option(
      "--server", options->server,
      "Like game.example:7777, 1.2.3.4:7777 or [::1]:7777; default: the token's servers in turn");
  command->add_option("--host", options->host, "Name or numeric address, beside --port")
      ->capture_default_str()
      ->excludes(server);
  command->add_option("--port", options->port, "UDP port of --host")->excludes(server);
  command->add_option("--ws", options->web, "Like ws://127.0.0.1:9000/: over a WebSocket, not UDP")
      ->excludes(server);
  command->add_option("--token", options->token, "File with a token of `token issue`");
  command->add_option("--bot-seed", options->bot_seed, "Seed of the choices that the bot makes")
      ->capture_default_str();
  command->add_option("--name", options->name, "Name that the server shows for this player")
      ->capture_default_str();
  command->add_option("--say", options->say, "A line of chat, once the match runs");
  command->add_flag("--spectate", options->spectate, "Only watch");
  command->add_option("--predict", options->predict, "Rollback: ticks to run ahead; 0: lockstep")
      ->check(CLI::Range(0, 15))
      ->capture_default_str();
  command->add_option("--slot", options->slot, "Player slot; any when not given")
      ->check(CLI::Range(std::size_t{0}, k_max_players - 1));
  command
      ->add_option("--reconnect", options->reconnect,
                   "Call again for this many seconds when the connection is lost; 0: never")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  command->add_flag("--insecure", options->insecure,
                    "No token and no encryption: anybody may listen and forge");
  command->add_flag("--json", options->json, "Print the result as JSON");
  command->add_flag("--quiet", options->quiet, "Print failures only");
  command->add_option("--flip-bit-at", options->flip_bit_at, "")->group("");  // for tests: hidden
  command->callback([options, &tool] { tool.exit_code = join(tool.games, *options); });
}

}  // namespace lockstone::tool
