#include "tools/lockstone/match/match_host.h"

#include <algorithm>
#include <array>
#include <bit>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <thread>
#include <utility>

#include <fmt/format.h>

#include <lockstone/hash.h>
#include <lockstone/net/player_name.h>
#include <lockstone/world.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/file/resume.h"
#include "tools/lockstone/match/journal.h"
#include "tools/lockstone/match/match_log.h"
#include "tools/lockstone/match/match_socket.h"
#include "tools/lockstone/match/metrics_port.h"
#include "tools/lockstone/match/secrets.h"
#include "tools/lockstone/support/build_text.h"
#include "tools/lockstone/support/output_file.h"
#include "tools/lockstone/support/tar.h"
#include "tools/tool/games.h"

namespace lockstone::tool {
namespace {

net::ServerConfig server_config(const MatchOptions& options, std::vector<std::byte> match_config,
                                ByteView unguessable) {
  net::ServerConfig config;
  config.insecure = options.insecure;
  config.match_config = std::move(match_config);
  config.tick_count = options.ticks;
  config.input_delay_ticks = static_cast<std::uint8_t>(options.input_delay);
  config.late_policy = options.strict ? net::LatePolicy::strict : net::LatePolicy::deadline;
  config.pacing = options.fast ? net::Pacing::fast : net::Pacing::real_time;
  config.timeouts.drop_us = static_cast<std::int64_t>(options.drop_after_s * 1e6);
  config.start_players = static_cast<std::uint8_t>(options.start_players);
  config.desync_policy = options.desync_policy;
  config.rejoin_seed = hash64(unguessable);
  config.max_spectators = options.spectators;
  config.spectator_delay_ticks = options.spectator_delay_s * 60;
  config.history_ticks = std::bit_ceil(1024 + config.spectator_delay_ticks * 5 / 4);
  return config;
}

/// In seconds of the host's clock.
struct TickTimes {
  double started = 0;
  double last_tick = 0;
};

struct HostOrders {
  bool pause = false;  ///< by a player
  bool drain = false;  ///< by the owner
};

}  // namespace

struct MatchHost::Impl final : net::ServerObserver {
  explicit Impl(const Games& known) : games(known) {}

  const Games& games;
  MatchOptions options;
  Match match;
  std::unique_ptr<MatchSocket> socket;  ///< null: it has the line of its owner
  net::Transport* line = nullptr;
  std::unique_ptr<net::Server> server;
  MatchLog log;
  Progress progress;
  Journal journal;
  Stopwatch watch;
  MatchSummary summary;
  TickTimes times;
  TickLateness lateness;
  std::uint64_t ticks_seen = 0;
  std::unique_ptr<MetricsPort> metrics_port;
  HostOrders wanted;
  std::optional<net::SlotMask> resume_mask;  ///< of a match that goes on
  std::vector<TarEntry> bundle;              ///< of the first desync, without the log

  void say(const JournalEntry& entry) {
    if (options.silent) return;
    progress.clear();
    journal.write(entry);
  }

  [[nodiscard]] std::string player(std::uint8_t slot) const {
    return net::player_text(slot, server->player_name(slot));
  }

  void tick_confirmed(std::uint64_t tick, std::span<const PlayerInput> inputs,
                      std::optional<std::uint64_t> hash) override {
    const double now = watch.seconds();
    if (times.last_tick > 0) {
      summary.longest_seconds = std::max(summary.longest_seconds, now - times.last_tick);
    }
    times.last_tick = now;
    lateness.note(static_cast<std::int64_t>(now * 1e6), match.simulation->info().tick_rate);
    summary.final_hash = hash.value_or(0);
    log.record(*match.simulation, tick, inputs, summary.final_hash);
  }
  void commands_confirmed(std::uint64_t tick, std::span<const PlayerCommand> commands) override {
    log.commands(commands);
    if (match.game->chat_text == nullptr) return;
    for (const PlayerCommand& command : commands) {
      const std::optional<std::string> text = match.game->chat_text(command.bytes);
      if (text) say({"chat", speaker(command.slot) + ": " + *text, command.slot, tick});
    }
  }
  [[nodiscard]] std::string speaker(std::uint8_t slot) const {
    return slot == k_server_slot ? "server" : player(slot);
  }
  void player_joined(std::uint8_t slot, std::string_view name) override {
    say({"player_joined", fmt::format("player {} joined: {}", slot, name), slot});
    log.event(replay::EventKind::join, slot, {});
    log.event(replay::EventKind::name, slot, name);
  }
  void player_left(std::uint8_t slot, net::LeaveReason reason) override {
    if (reason != net::LeaveReason::match_over) {
      say({"player_left", fmt::format("{} left: {}", player(slot), to_string(reason)), slot});
    }
    log.event(replay::EventKind::leave, slot, to_string(reason));
  }
  void player_silent(std::uint8_t slot, std::int64_t silent_us) override {
    say({"player_silent", fmt::format("{} is silent since {} ms", player(slot), silent_us / 1000),
         slot});
  }
  void player_refused(const net::Refusal& refusal) override {
    say({"player_refused", refusal.to_line()});
  }
  void desync_found(const net::DesyncReport& report) override {
    ++summary.desyncs;
    say({"desync", "desync: " + report.to_line(), report.slot, report.tick});
    log.event(replay::EventKind::note, report.slot, "desync: " + report.to_line());
    if (!options.bundle.empty() && bundle.empty()) begin_bundle(report);
  }
  void player_active(std::uint8_t slot, std::uint64_t tick) override {
    say({"player_active", fmt::format("{} plays from tick {} on", player(slot), tick), slot, tick});
    log.event(replay::EventKind::join, slot, fmt::format("plays from tick {} on", tick));
  }
  void player_asks(std::uint8_t slot, net::AskKind kind, std::uint8_t topic,
                   std::uint8_t choice) override {
    const char* wish = kind == net::AskKind::vote     ? "votes"
                       : kind == net::AskKind::resume ? "asks to go on"
                                                      : "asks for a pause";
    say({"player_asks", fmt::format("{} {} ({}, {})", player(slot), wish, topic, choice), slot});
    if (kind != net::AskKind::vote) wanted.pause = kind == net::AskKind::pause;
  }

  // One archive that holds all that is known about it.
  void begin_bundle(const net::DesyncReport& report) {
    std::string text = fmt::format(
        "{}\nverdict: {}\nhash here:  {}\nhash there: {}\nbuild here:  {}\nbuild there: {}\n",
        report.to_line(), to_string(report.verdict), hash_text(report.hash_here),
        hash_text(report.hash_there),
        report.build_here.empty() ? build_text(build_of(*match.game)) : report.build_here,
        report.build_there);
    for (std::uint8_t slot = 0; slot < match.simulation->info().player_count; ++slot)
      text += player(slot) + '\n';
    const auto* begin = reinterpret_cast<const std::byte*>(text.data());
    bundle.push_back({"report.txt", {begin, begin + text.size()}});
    bundle.push_back({"here.snapshot", {report.dump_here.begin(), report.dump_here.end()}});
    bundle.push_back({"there.snapshot", {report.dump_there.begin(), report.dump_there.end()}});
  }

  void write_bundle() {
    if (bundle.empty()) return;
    bundle.push_back({"match.lks", log.bytes(options.record)});
    const std::vector<std::byte> archive = make_tar(bundle);
    std::string text;
    for (std::byte byte : archive)
      text.push_back(static_cast<char>(byte));
    if (write_text_file({options.bundle, options.force}, text)) {
      say({"desync_written", "the desync is written to " + options.bundle});
    }
  }
  void match_started() override {
    times.started = watch.seconds();
    const World* world = world_of(*match.game, *match.simulation);
    const std::string bodies =
        world == nullptr ? "" : fmt::format(", {} bodies", world->body_count());
    say({"match_started", fmt::format("the match begins: {} players{}",
                                      match.simulation->info().player_count, bodies)});
  }
  void match_finished(net::FinishReason reason, std::uint64_t,
                      std::optional<std::uint64_t>) override {
    summary.reason = reason;
  }

  [[nodiscard]] bool make_simulation() {
    if (!options.resume.empty()) return take_up();
    std::optional<Match> started = start_match(games, options.start);
    if (!started) return false;
    match = std::move(*started);
    options.start.players = match.simulation->info().player_count;
    return true;
  }

  // The scene comes from the log, everything else from the options.
  [[nodiscard]] bool take_up() {
    std::optional<ResumedMatch> resumed = load_killed_match(games, options.resume);
    if (!resumed) return false;
    match = std::move(resumed->match);
    resume_mask = resumed->playing_mask;
    options.start.players = match.simulation->info().player_count;
    options.start.seed = resumed->header.match.seed;
    if (options.record.empty()) options.record = options.resume;
    ticks_seen = match.simulation->tick();
    const std::uint64_t tick = match.simulation->tick();
    say({"match_resumed", fmt::format("{} goes on at tick {}", options.resume, tick), {}, tick});
    return true;
  }

  // A resumed match goes on in its own log.
  [[nodiscard]] bool may_write_files() const {
    const bool own = !options.resume.empty() && options.record == options.resume;
    return (own || may_write({options.record, options.force})) &&
           may_write({options.bundle, options.force});
  }

  [[nodiscard]] bool set_up() {
    if (!may_write_files() || !make_simulation()) return false;
    if (line == nullptr && !open_socket()) return false;
    const Status status = log.open(options, *match.game, *match.simulation, match.config);
    if (status != Status::ok) {
      return refuse(fmt::format("cannot write {}: {}", options.record, to_string(status)));
    }
    if (options.metrics_port != 0 && socket != nullptr) {
      metrics_port = MetricsPort::open(options.metrics_port, options.metrics_bind);
      if (metrics_port == nullptr) return false;
    }
    std::array<std::byte, 16> unguessable{};
    net::SystemRandom random;
    random.fill(unguessable);
    net::ServerConfig server_options = server_config(options, match.config, unguessable);
    server_options.resume_mask = resume_mask;
    net::Server::Created created =
        net::Server::create(server_options, {line, match.simulation.get(), nullptr, this});
    server = std::move(created.server);
    journal = Journal(options.json_log, socket != nullptr ? socket->port() : options.match);
    if (server == nullptr) return refuse(std::string(to_string(created.error)));
    return true;
  }

  // All seats, and strangers at the door.
  [[nodiscard]] std::size_t connections() const {
    constexpr std::size_t k_strangers = 16;
    return options.start.players + options.spectators + k_strangers;
  }

  [[nodiscard]] bool open_socket() {
    SocketOptions asked;
    asked.enet.bind_address = options.bind;
    asked.enet.port = options.port;
    asked.enet.max_connections = connections();
    asked.enet.max_connections_per_address = options.max_per_address;
    if (options.fast) asked.enet.limits = net::DatagramLimits::none();
    asked.web = options.web.options(asked.enet);
    asked.key = options.key;
    asked.match = options.match;
    asked.addresses = options.addresses;
    asked.unix_us_at_zero = unix_microseconds() - watch.microseconds();
    socket = MatchSocket::open(asked);
    if (socket != nullptr) line = &socket->session();
    return socket != nullptr;
  }

  static bool refuse(const std::string& why) {
    complain(why);
    return false;
  }
};

MatchHost::MatchHost(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MatchHost::~MatchHost() = default;

std::unique_ptr<MatchHost> MatchHost::create(const Games& games, const MatchOptions& options,
                                             net::Transport* line) {
  auto impl = std::make_unique<Impl>(games);
  impl->options = options;
  impl->line = line;
  if (!impl->set_up()) return nullptr;
  return std::unique_ptr<MatchHost>(new MatchHost(std::move(impl)));
}

std::uint16_t MatchHost::port() const {
  return impl_->socket == nullptr ? std::uint16_t{0} : impl_->socket->port();
}

std::string MatchHost::web_address() const {
  return impl_->socket == nullptr ? std::string() : impl_->socket->web_address();
}

bool MatchHost::begun() const {
  return impl_->server->state() != net::ServerState::lobby;
}

const TickLateness& MatchHost::lateness() const {
  return impl_->lateness;
}

void MatchHost::restart_lateness() {
  impl_->lateness = {};
}

bool MatchHost::step() {
  Impl& impl = *impl_;
  impl.server->update(impl.watch.microseconds());
  if (impl.server->state() == net::ServerState::over) return false;
  if (impl.wanted.pause != impl.server->paused()) {
    impl.wanted.pause ? impl.server->pause() : impl.server->resume();
  }
  return true;
}

bool MatchHost::update() {
  using namespace std::chrono_literals;
  Impl& impl = *impl_;
  if (!step()) return false;
  if (impl.metrics_port != nullptr) {
    impl.metrics_port->serve(
        [this](std::string_view request) { return answer_about(request, metrics()); });
  }
  // The transport does not wait: give the processor away when there was nothing to do.
  const bool busy = std::exchange(impl.ticks_seen, ticks_confirmed()) != ticks_confirmed();
  if (!busy) std::this_thread::sleep_for(impl.options.fast ? 100us : 1000us);
  impl.progress.show(progress_line());
  return true;
}

void MatchHost::stop() {
  impl_->server->stop();
}

void MatchHost::drain() {
  Impl& impl = *impl_;
  if (std::exchange(impl.wanted.drain, true)) return;
  const bool begun = impl.server->state() != net::ServerState::lobby;
  impl.say({"draining", begun ? "draining: the match is played to its end"
                              : "draining: the match has not begun, and ends"});
  if (!begun) impl.server->stop();
}

void MatchHost::say_summary(const MatchSummary& summary) {
  impl_->say({"match_over",
              fmt::format("the match is over: {}, {} ticks, final hash {}",
                          to_string(summary.reason), summary.ticks, hash_text(summary.final_hash)),
              {},
              summary.ticks});
  impl_->say({"match_time", fmt::format("{:.1f} s, longest between two ticks {:.0f} ms",
                                        summary.seconds, 1000 * summary.longest_seconds)});
  for (std::uint8_t slot = 0; slot < summary.players.size(); ++slot) {
    const net::PlayerStats& player = summary.players[slot];
    impl_->say({"player_summary",
                fmt::format("{}: {} of {} hashes equal, {} late inputs, {} bytes in, {} "
                            "bytes out",
                            impl_->player(slot), player.hashes_equal, player.hashes_compared,
                            player.late_inputs, player.bytes_received, player.bytes_sent),
                slot});
  }
}

MatchSummary MatchHost::finish() {
  Impl& impl = *impl_;
  impl.progress.clear();
  MatchSummary& summary = impl.summary;
  summary.ticks = ticks_confirmed();
  summary.reason = impl.server->finish_reason();
  summary.seconds = std::max(0.0, impl.times.last_tick - impl.times.started);
  summary.record_status = impl.log.finish(to_string(summary.reason));
  impl.write_bundle();
  for (unsigned slot = 0; slot < impl.match.simulation->info().player_count; ++slot) {
    summary.players.push_back(impl.server->stats(static_cast<std::uint8_t>(slot)));
  }
  return summary;
}

const Simulation& MatchHost::simulation() const {
  return *impl_->match.simulation;
}

const GameDef& MatchHost::game() const {
  return *impl_->match.game;
}

std::uint64_t MatchHost::ticks_confirmed() const {
  return impl_->server->ticks_confirmed();
}

MatchMetrics MatchHost::metrics() const {
  MatchMetrics metrics;
  metrics.port = port();
  if (impl_->socket == nullptr) metrics.room = impl_->options.match;
  metrics.state = to_string(impl_->server->state());
  metrics.ready = !impl_->wanted.drain && impl_->server->state() <= net::ServerState::running;
  metrics.ticks = ticks_confirmed();
  metrics.spectators = impl_->server->spectators();
  metrics.present_mask = impl_->server->present_mask();
  metrics.desyncs = impl_->summary.desyncs;
  metrics.server = impl_->server->counters();
  metrics.connections = impl_->server->connections();
  if (impl_->socket != nullptr) {
    metrics.socket = impl_->socket->socket_counters();
    metrics.web = impl_->socket->web_counters();
    metrics.security = impl_->socket->security_counters();
  }
  for (unsigned slot = 0; slot < impl_->match.simulation->info().player_count; ++slot) {
    metrics.players.push_back(impl_->server->stats(static_cast<std::uint8_t>(slot)));
    metrics.names.emplace_back(impl_->server->player_name(static_cast<std::uint8_t>(slot)));
  }
  return metrics;
}

std::string MatchHost::progress_line() const {
  const int present = std::popcount(impl_->server->present_mask());
  if (impl_->server->state() == net::ServerState::lobby) {
    return fmt::format("waiting for players: {} of {}", present, impl_->options.start.players);
  }
  std::string line = fmt::format("tick {}", ticks_confirmed());
  if (impl_->options.ticks > 0) line += fmt::format(" of {}", impl_->options.ticks);
  line += fmt::format(", {} players", present);
  const net::SlotMask waiting = impl_->server->waiting_mask();
  if (waiting != 0 && !impl_->options.fast) {
    line += ", waiting for " + impl_->player(static_cast<std::uint8_t>(std::countr_zero(waiting)));
  }
  return line;
}

Progress& MatchHost::progress() {
  return impl_->progress;
}

}  // namespace lockstone::tool
