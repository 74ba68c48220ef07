#include <algorithm>
#include <chrono>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <lockstone/net/client.h>
#include <lockstone/net/transport_enet.h>
#include <lockstone/net/transport_secure.h>

#include "tools/arena/arena_simulation.h"
#include "tools/arena/bots.h"
#include "tools/lockstone/build_text.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/console.h"
#include "tools/lockstone/flipping_simulation.h"
#include "tools/lockstone/interrupt.h"
#include "tools/lockstone/json_text.h"
#include "tools/lockstone/secrets.h"
#include "tools/relay/stall_watch.h"
#include "tools/scenes/play.h"

namespace lockstone::tool {
namespace {

struct JoinOptions {
  std::string host = "127.0.0.1";
  std::uint16_t port = 0;
  std::string token;
  std::uint64_t bot_seed = 1;
  std::string name = "bot";
  int slot = net::k_no_slot;
  std::optional<std::uint64_t> flip_bit_at;
  bool spectate = false;
  unsigned predict = 0;
  double reconnect = 30;
  bool insecure = false;
  bool json = false;
  bool quiet = false;
};

/// Plays for the local player, on what this client's own simulation shows.
class BotInputs final : public net::InputSource {
 public:
  explicit BotInputs(std::uint64_t seed) : seed_(seed) {}

  void watch(const net::Client& client) { client_ = &client; }

  void sample(std::uint64_t tick, std::span<std::byte> out) override {
    const Simulation* simulation = client_->simulation();
    if (simulation == nullptr || client_->slot() == net::k_no_slot) return;
    const auto* game = dynamic_cast<const arena::ArenaSimulation*>(&unwrapped(*simulation));
    if (game == nullptr) return;  // a scene without players: neutral inputs
    arena::Input input = arena::bot_input(game->arena(), seed_, client_->slot());
    input.sequence = static_cast<std::uint16_t>(tick & 0xffff);
    input.encode(out);
  }

 private:
  std::uint64_t seed_;
  const net::Client* client_ = nullptr;
};

class JoinObserver final : public net::ClientObserver {
 public:
  explicit JoinObserver(bool quiet) : quiet_(quiet) {}

  void joined(std::uint8_t slot) override {
    const bool back = std::exchange(own_slot_, slot) == slot;
    if (quiet_) return;
    const bool watches = slot == net::k_spectator_slot;
    fmt::print(stderr, "{} {}\n", back ? "back as" : "joined as",
               watches ? "a spectator" : fmt::format("player {}", slot));
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

SimulationFactory factory_for(const JoinOptions& options) {
  if (!options.flip_bit_at) return scenes::make_simulation;
  return [tick = *options.flip_bit_at](ByteView config) -> Result<std::unique_ptr<Simulation>> {
    Result<std::unique_ptr<Simulation>> made = scenes::make_simulation(config);
    if (!made) return made;
    return make_flipping(std::move(made).value(), tick);
  };
}

// A connection on its way, encrypted if there is a token.
struct Caller {
  net::SystemRandom random;
  std::unique_ptr<net::EnetTransport> enet;
  std::unique_ptr<net::SecureTransport> secure;
  net::ConnectionId connection = net::k_no_connection;

  [[nodiscard]] net::Transport* transport() const {
    if (secure != nullptr) return secure.get();
    return enet.get();
  }
};

// Null, with a complaint, when the system refuses.
std::unique_ptr<Caller> call(const std::string& host, std::uint16_t port,
                             const std::optional<net::ConnectToken>& token) {
  auto caller = std::make_unique<Caller>();
  net::EnetOptions enet;
  if (token) {
    enet.link_key = token->link_key;
    enet.match_tag = net::make_match_tag(token->grant.match);
  }
  auto opened = net::EnetTransport::open(enet);
  if (!opened) {
    complain(fmt::format("no socket: {}", to_string(opened.status())));
    return nullptr;
  }
  caller->enet = std::move(opened).value();
  if (token) {
    caller->secure =
        std::move(net::SecureTransport::join(*caller->enet, *token, caller->random)).value();
  }
  const Result<net::ConnectionId> connection = caller->enet->connect(host, port);
  if (!connection) {
    complain(fmt::format("cannot call {}:{}: {}", host, port, to_string(connection.status())));
    return nullptr;
  }
  caller->connection = connection.value();
  return caller;
}

/// Plays to the end. A lost connection is made anew, for a while.
class Play {
 public:
  Play(const JoinOptions& options, Caller& caller, net::Client& client, JoinObserver& observer)
      : options_(options), caller_(caller), client_(client), observer_(observer) {}

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
      if (interrupted() && !std::exchange(leaving_, true)) client_.leave();
      const bool busy = std::exchange(seen, client_.ticks_stepped()) != client_.ticks_stepped();
      if (busy) busy_us = watch_.microseconds();
      // In a fast match the next tick is near; at 60 a second there is time.
      const bool soon = watch_.microseconds() - busy_us < 2000;
      if (!busy) std::this_thread::sleep_for(soon ? 100us : 1000us);
    }
  }

 private:
  // False when there is nothing to come back to, or it took too long.
  [[nodiscard]] bool come_back() {
    if (leaving_ || interrupted() || !client_.may_reconnect()) return false;
    const double now = watch_.seconds();
    if (pause_seconds_ == 0) return plan_call(now);
    if (now < call_seconds_) return true;
    pause_seconds_ = 0;
    const Result<net::ConnectionId> connection =
        caller_.enet->connect(options_.host, options_.port);
    if (!connection || !client_.reconnect(connection.value())) return connection.ok();
    ++observer_.reconnects;
    return true;
  }

  // The first pause is short, each further one twice as long.
  [[nodiscard]] bool plan_call(double now) {
    constexpr double k_first_pause_seconds = 0.25;
    constexpr double k_longest_pause_seconds = 4;
    constexpr unsigned k_calls_of_strangers = 3;
    if (lost_seconds_ < 0) lost_seconds_ = now;
    const bool stranger = client_.rejoin_key() == 0;
    if (stranger && calls_ >= k_calls_of_strangers) return false;
    pause_seconds_ =
        std::min(k_first_pause_seconds * static_cast<double>(1U << std::min(calls_, 8U)),
                 k_longest_pause_seconds);
    if (now + pause_seconds_ - lost_seconds_ > options_.reconnect) return false;
    ++calls_;
    call_seconds_ = now + pause_seconds_;
    if (!options_.quiet) {
      fmt::print(stderr, "{}: calling again in {} s\n", why(), pause_seconds_);
    }
    return true;
  }

  [[nodiscard]] std::string why() const {
    if (client_.state() == net::ClientState::refused) return client_.refusal().to_line();
    return std::string(failure_text(client_.failure()));
  }

  const JoinOptions& options_;
  Caller& caller_;
  net::Client& client_;
  JoinObserver& observer_;
  Stopwatch watch_;
  bool leaving_ = false;
  double lost_seconds_ = -1;  ///< since when; below 0: it is not
  unsigned calls_ = 0;        ///< since then
  double pause_seconds_ = 0;  ///< before the next call; 0: none is planned
  double call_seconds_ = 0;   ///< when it is due
};

// Reads the token and takes the server from it where none is given. Not k_ok, with a complaint.
int set_security(JoinOptions& options, std::optional<net::ConnectToken>& token) {
  if (options.insecure == !options.token.empty()) {
    complain("give --token FILE, or say --insecure");
    return k_usage;
  }
  if (!options.insecure) {
    if (!require_security()) return k_unavailable;
    token = read_token(options.token);
    if (!token) return k_corrupt;
  }
  if (options.port == 0 && token && token->grant.servers.count > 0) {
    const std::string address = token->grant.servers.entries[0].to_text();
    options.host = address.substr(0, address.rfind(':'));
    options.port = token->grant.servers.entries[0].port;
  }
  if (options.port != 0) return k_ok;
  complain("--port is not given, and no token names a server");
  return k_usage;
}

int join(JoinOptions options) {
  catch_interrupts();
  std::optional<net::ConnectToken> token;
  if (const int code = set_security(options, token); code != k_ok) return code;
  const std::unique_ptr<Caller> caller = call(options.host, options.port, token);
  if (caller == nullptr) return k_unavailable;
  BotInputs inputs(options.bot_seed);
  JoinObserver observer(options.quiet);
  net::ClientConfig config;
  config.insecure = options.insecure;
  config.name = options.name;
  config.wanted_slot =
      static_cast<std::uint8_t>(options.spectate ? net::k_spectator_slot : options.slot);
  config.build = build_text();
  config.prediction_ticks = static_cast<std::uint8_t>(options.predict);
  const net::Client::Created created = net::Client::create(
      config, {caller->transport(), caller->connection, factory_for(options), &inputs, &observer});
  if (created.client == nullptr) {
    complain(std::string(to_string(created.error)));
    return k_usage;
  }
  inputs.watch(*created.client);
  Play(options, *caller, *created.client, observer).run();
  return conclude(options, *created.client, observer);
}

}  // namespace

void add_join_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<JoinOptions>();
  CLI::App* command = app.add_subcommand("join", "Play in a match over UDP, as a bot");
  command->add_option("--host", options->host, "Numeric IPv4 address")->capture_default_str();
  command->add_option("--port", options->port, "UDP port; default: the token's first server");
  command->add_option("--token", options->token, "File with a token of `token issue`");
  command->add_option("--bot-seed", options->bot_seed, "What the bot feels like")
      ->capture_default_str();
  command->add_option("--name", options->name, "Shown to the server")->capture_default_str();
  command->add_flag("--spectate", options->spectate, "Only watch");
  command->add_option("--predict", options->predict, "Rollback: ticks to run ahead; 0: lockstep")
      ->check(CLI::Range(0, 15))
      ->capture_default_str();
  command->add_option("--slot", options->slot, "Player slot; any when not given")
      ->check(CLI::Range(0, 15));
  command
      ->add_option("--reconnect", options->reconnect,
                   "Call again for so many seconds when the connection is lost; 0: never")
      ->check(CLI::Range(0.0, 3600.0))
      ->capture_default_str();
  command->add_flag("--insecure", options->insecure,
                    "No token and no encryption: anybody may listen and forge");
  command->add_flag("--json", options->json, "Print the result as JSON");
  command->add_flag("--quiet", options->quiet, "Print failures only");
  command->add_option("--flip-bit-at", options->flip_bit_at, "")->group("");  // for tests: hidden
  command->callback([options, &exit_code] { exit_code = join(*options); });
}

}  // namespace lockstone::tool
