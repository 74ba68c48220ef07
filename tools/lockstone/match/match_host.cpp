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
#include <lockstone/net/transport_secure.h>
#include <lockstone/replay/background_sink.h>
#include <lockstone/replay/sink.h>
#include <lockstone/world.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/log_file.h"
#include "tools/lockstone/logs/resume.h"
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

/// The log of a match, or nothing where none is wanted. After the first error it stays silent: a
/// full disk must not end the match.
class MatchLog {
 public:
  [[nodiscard]] Status open(const MatchOptions& options, const GameDef& game,
                            const Simulation& simulation, ByteView config) {
    if (options.record.empty() && options.bundle.empty()) return Status::ok;
    if (options.record.empty()) {
      auto memory = std::make_unique<replay::MemorySink>();
      memory_ = memory.get();
      sink_ = std::move(memory);
    } else {
      const bool resumes = !options.resume.empty();
      auto sink = replay::FileSink::create(options.record + (resumes ? k_unfinished : ""),
                                           options.force || resumes);
      if (!sink) return sink.status();
      sink_ = std::move(sink).value();
    }
    replay::RecorderOptions recorder_options;
    recorder_options.keyframe_bytes_max = simulation.snapshot_bytes_max(SnapshotKind::canonical);
    recorder_options.signing_key = options.signing_key;
    background_.emplace(*sink_);
    recorder_.emplace(*background_, recorder_options);
    replay::MatchMetadata match{.match_id = random_match_id(), .seed = options.start.seed};
    name_game(game, match);
    const Status begun = recorder_->begin(simulation.info(), config, match);
    return note(begun == Status::ok && !options.resume.empty() ? take_over(options) : begun);
  }

  void record(const Simulation& simulation, std::uint64_t tick, std::span<const PlayerInput> inputs,
              std::uint64_t hash) {
    if (!active()) return;
    if (note(recorder_->record_tick(tick, inputs, hash)) != Status::ok) return;
    if (recorder_->keyframe_due()) static_cast<void>(note(recorder_->keyframe(simulation)));
  }

  void event(replay::EventKind kind, std::uint8_t slot, std::string_view text) {
    if (!active()) return;
    static_cast<void>(note(recorder_->event(recorder_->next_tick(), kind, slot, text)));
  }

  [[nodiscard]] Status finish(std::string_view reason) {
    if (active()) static_cast<void>(note(recorder_->finish(reason)));
    if (background_) static_cast<void>(note(background_->close()));
    return status_;
  }

  /// After `finish`: the recorded log.
  [[nodiscard]] std::vector<std::byte> bytes(const std::string& record) const {
    if (memory_ != nullptr) return memory_->bytes();
    const std::string text = read_file(record).value_or("");
    const auto* begin = reinterpret_cast<const std::byte*>(text.data());
    return {begin, begin + text.size()};
  }

 private:
  static constexpr const char* k_unfinished = ".resuming";

  // The old log stays as it is until the new one holds all of it, and then gives way at once.
  [[nodiscard]] Status take_over(const MatchOptions& options) {
    Status status = copy_log(options.resume, *recorder_);
    if (status == Status::ok) status = recorder_->flush();
    std::error_code error;
    if (status == Status::ok && memory_ == nullptr) {
      std::filesystem::rename(options.record + k_unfinished, options.record, error);
    }
    return error ? Status::io_error : status;
  }

  [[nodiscard]] bool active() const { return recorder_.has_value() && status_ == Status::ok; }

  Status note(Status status) {
    if (status != Status::ok && status_ == Status::ok) {
      status_ = status;
      complain(fmt::format("the log is given up: {}", to_string(status)));
    }
    return status;
  }

  std::unique_ptr<replay::Sink> sink_;
  const replay::MemorySink* memory_ = nullptr;  ///< it, where no file was asked for
  std::optional<replay::BackgroundSink> background_;
  std::optional<replay::Recorder> recorder_;
  Status status_ = Status::ok;
};

}  // namespace

struct MatchHost::Impl final : net::ServerObserver {
  explicit Impl(const Games& known) : games(known) {}

  const Games& games;
  MatchOptions options;
  Match match;
  net::SystemRandom random;
  std::unique_ptr<net::EnetTransport> transport;
  std::unique_ptr<net::SecureTransport> secure;
  std::unique_ptr<net::Server> server;
  MatchLog log;
  Progress progress;
  Stopwatch watch;
  MatchSummary summary;
  double started_seconds = 0;
  double last_tick_seconds = 0;
  std::uint64_t ticks_seen = 0;
  std::unique_ptr<MetricsPort> metrics_port;
  bool wanted_pause = false;
  std::optional<std::uint16_t> resume_mask;  ///< of a match that goes on
  std::vector<TarEntry> bundle;              ///< of the first desync, without the log

  void say(const std::string& line) {
    progress.clear();
    fmt::print("{}\n", line);
    std::fflush(stdout);
  }

  void tick_confirmed(std::uint64_t tick, std::span<const PlayerInput> inputs,
                      std::optional<std::uint64_t> hash) override {
    const double now = watch.seconds();
    if (last_tick_seconds > 0) {
      summary.longest_seconds = std::max(summary.longest_seconds, now - last_tick_seconds);
    }
    last_tick_seconds = now;
    summary.final_hash = hash.value_or(0);
    log.record(*match.simulation, tick, inputs, summary.final_hash);
  }
  void player_joined(std::uint8_t slot, std::string_view name) override {
    say(fmt::format("player {} joined: {}", slot, name));
    log.event(replay::EventKind::join, slot, name);
  }
  void player_left(std::uint8_t slot, net::LeaveReason reason) override {
    if (reason != net::LeaveReason::match_over) {
      say(fmt::format("player {} left: {}", slot, to_string(reason)));
    }
    log.event(replay::EventKind::leave, slot, to_string(reason));
  }
  void player_silent(std::uint8_t slot, std::int64_t silent_us) override {
    say(fmt::format("player {} is silent since {} ms", slot, silent_us / 1000));
  }
  void player_refused(const net::Refusal& refusal) override { say(refusal.to_line()); }
  void desync_found(const net::DesyncReport& report) override {
    ++summary.desyncs;
    say("desync: " + report.to_line());
    log.event(replay::EventKind::note, report.slot, "desync: " + report.to_line());
    if (!options.bundle.empty() && bundle.empty()) begin_bundle(report);
  }
  void player_active(std::uint8_t slot, std::uint64_t tick) override {
    say(fmt::format("player {} plays from tick {} on", slot, tick));
    log.event(replay::EventKind::join, slot, fmt::format("plays from tick {} on", tick));
  }
  void player_asks(std::uint8_t slot, net::AskKind kind, std::uint8_t topic,
                   std::uint8_t choice) override {
    const char* wish = kind == net::AskKind::vote     ? "votes"
                       : kind == net::AskKind::resume ? "asks to go on"
                                                      : "asks for a pause";
    say(fmt::format("player {} {} ({}, {})", slot, wish, topic, choice));
    if (kind != net::AskKind::vote) wanted_pause = kind == net::AskKind::pause;
  }

  // One archive that holds all that is known about it.
  void begin_bundle(const net::DesyncReport& report) {
    const std::string text = fmt::format(
        "{}\nverdict: {}\nhash here:  {}\nhash there: {}\nbuild here:  {}\nbuild there: {}\n",
        report.to_line(), to_string(report.verdict), hash_text(report.hash_here),
        hash_text(report.hash_there),
        report.build_here.empty() ? build_text(build_of(*match.game)) : report.build_here,
        report.build_there);
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
      say("the desync is written to " + options.bundle);
    }
  }
  void match_started() override {
    started_seconds = watch.seconds();
    const World* world = world_of(*match.game, *match.simulation);
    say(fmt::format("the match begins: {} players{}", match.simulation->info().player_count,
                    world == nullptr ? "" : fmt::format(", {} bodies", world->body_count())));
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
    say(fmt::format("{} goes on at tick {}", options.resume, match.simulation->tick()));
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
    net::EnetOptions enet{.bind_address = options.bind, .port = options.port};
    enet.max_connections = connections();
    enet.max_connections_per_address = options.max_per_address;
    if (options.fast) enet.limits = net::DatagramLimits::none();
    if (options.key) {
      enet.link_key = net::make_link_key(*options.key, options.match);
      enet.match_tag = net::make_match_tag(options.match);
    }
    std::string problem;
    auto listening = net::EnetTransport::listen(enet, &problem);
    if (!listening) return refuse("cannot listen on " + problem);
    transport = std::move(listening).value();
    if (options.key && !encrypt()) return false;
    const Status status = log.open(options, *match.game, *match.simulation, match.config);
    if (status != Status::ok) {
      return refuse(fmt::format("cannot write {}: {}", options.record, to_string(status)));
    }
    if (options.metrics_port != 0) {
      metrics_port = MetricsPort::open(options.metrics_port, options.metrics_bind);
      if (metrics_port == nullptr) return false;
    }
    std::array<std::byte, 16> unguessable{};
    random.fill(unguessable);
    net::ServerConfig server_options = server_config(options, match.config, unguessable);
    server_options.resume_mask = resume_mask;
    net::Server::Created created = net::Server::create(
        server_options, {session_transport(), match.simulation.get(), nullptr, this});
    server = std::move(created.server);
    if (server == nullptr) return refuse(std::string(to_string(created.error)));
    return true;
  }

  // All seats, and strangers at the door.
  [[nodiscard]] std::size_t connections() const {
    constexpr std::size_t k_strangers = 16;
    return options.start.players + options.spectators + k_strangers;
  }

  [[nodiscard]] bool encrypt() {
    net::SecureServerOptions security;
    security.backend_key = *options.key;
    security.match = options.match;
    security.max_connections = connections();
    security.own_addresses = options.addresses;
    security.unix_us_at_zero = unix_microseconds() - watch.microseconds();
    auto created = net::SecureTransport::serve(*transport, security, random);
    if (!created) return refuse(fmt::format("no encryption: {}", to_string(created.status())));
    secure = std::move(created).value();
    return true;
  }

  [[nodiscard]] net::Transport* session_transport() const {
    if (secure != nullptr) return secure.get();
    return transport.get();
  }

  static bool refuse(const std::string& why) {
    complain(why);
    return false;
  }
};

MatchHost::MatchHost(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
MatchHost::~MatchHost() = default;

std::unique_ptr<MatchHost> MatchHost::create(const Games& games, const MatchOptions& options) {
  auto impl = std::make_unique<Impl>(games);
  impl->options = options;
  if (!impl->set_up()) return nullptr;
  return std::unique_ptr<MatchHost>(new MatchHost(std::move(impl)));
}

std::uint16_t MatchHost::port() const {
  return impl_->transport->port();
}

bool MatchHost::update() {
  using namespace std::chrono_literals;
  Impl& impl = *impl_;
  impl.server->update(impl.watch.microseconds());
  if (impl.server->state() == net::ServerState::over) return false;
  if (impl.wanted_pause != impl.server->paused()) {
    impl.wanted_pause ? impl.server->pause() : impl.server->resume();
  }
  if (impl.metrics_port != nullptr) {
    impl.metrics_port->serve([this] { return metrics(); });
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

MatchSummary MatchHost::finish() {
  Impl& impl = *impl_;
  impl.progress.clear();
  MatchSummary& summary = impl.summary;
  summary.ticks = ticks_confirmed();
  summary.reason = impl.server->finish_reason();
  summary.seconds = std::max(0.0, impl.last_tick_seconds - impl.started_seconds);
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
  metrics.ticks = ticks_confirmed();
  metrics.spectators = impl_->server->spectators();
  metrics.present_mask = impl_->server->present_mask();
  metrics.desyncs = impl_->summary.desyncs;
  metrics.server = impl_->server->counters();
  metrics.connections = impl_->server->connections();
  metrics.socket = impl_->transport->counters();
  if (impl_->secure != nullptr) metrics.security = impl_->secure->counters();
  for (unsigned slot = 0; slot < impl_->match.simulation->info().player_count; ++slot) {
    metrics.players.push_back(impl_->server->stats(static_cast<std::uint8_t>(slot)));
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
  const std::uint16_t waiting = impl_->server->waiting_mask();
  if (waiting != 0 && !impl_->options.fast) {
    line += fmt::format(", waiting for player {}", std::countr_zero(waiting));
  }
  return line;
}

Progress& MatchHost::progress() {
  return impl_->progress;
}

}  // namespace lockstone::tool
