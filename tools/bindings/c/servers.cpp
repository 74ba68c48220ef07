// The server's side of sessions.
#include <lockstone/net/server.h>

#include "tools/bindings/c/session_handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

static_assert(LKS_SERVER_OVER == static_cast<int>(net::ServerState::over));
static_assert(LKS_LATE_STRICT == static_cast<int>(net::LatePolicy::strict));
static_assert(LKS_SUBSTITUTE_NEUTRAL == static_cast<int>(net::Substitute::neutral));
static_assert(LKS_PACING_FAST == static_cast<int>(net::Pacing::fast));
static_assert(LKS_DESYNC_RESYNC == static_cast<int>(net::DesyncPolicy::resync));
static_assert(LKS_FINISH_NO_PLAYERS == static_cast<int>(net::FinishReason::no_players));
static_assert(LKS_ASK_VOTE == static_cast<int>(net::AskKind::vote));

lks_server_def raw_def(const net::ServerConfig& config) {
  lks_server_def raw{};
  raw.size = sizeof raw;
  raw.insecure = config.insecure ? 1 : 0;
  raw.input_delay_ticks = config.input_delay_ticks;
  raw.late_policy = static_cast<std::uint32_t>(config.late_policy);
  raw.substitute = static_cast<std::uint32_t>(config.substitute);
  raw.pacing = static_cast<std::uint32_t>(config.pacing);
  raw.desync_policy = static_cast<std::uint32_t>(config.desync_policy);
  raw.history_ticks = config.history_ticks;
  raw.snapshot_ticks = config.snapshot_ticks;
  raw.late_join = config.late_join ? 1 : 0;
  raw.start_players = config.start_players;
  raw.max_spectators = config.max_spectators;
  raw.spectator_delay_ticks = config.spectator_delay_ticks;
  raw.tick_count = config.tick_count;
  raw.rejoin_seed = config.rejoin_seed;
  raw.drop_us = config.timeouts.drop_us;
  raw.rejoin_us = config.timeouts.rejoin_us;
  raw.command_bytes_max = config.commands.max_bytes;
  raw.commands_per_second = config.commands.per_second;
  raw.command_bytes_per_second = config.commands.bytes_per_second;
  return raw;
}

net::ServerConfig config_of(const lks_server_def& raw) {
  using namespace net;
  ServerConfig config;
  config.insecure = flag(raw.insecure, "def.insecure");
  config.input_delay_ticks = narrow<std::uint8_t>(raw.input_delay_ticks, "def.input_delay_ticks");
  config.late_policy =
      enumerator(raw.late_policy, LatePolicy::deadline, LatePolicy::strict, "def.late_policy");
  config.substitute =
      enumerator(raw.substitute, Substitute::repeat, Substitute::neutral, "def.substitute");
  config.pacing = enumerator(raw.pacing, Pacing::real_time, Pacing::fast, "def.pacing");
  config.desync_policy = enumerator(raw.desync_policy, DesyncPolicy::end_match,
                                    DesyncPolicy::resync, "def.desync_policy");
  config.history_ticks = raw.history_ticks;
  config.snapshot_ticks = raw.snapshot_ticks;
  config.late_join = flag(raw.late_join, "def.late_join");
  config.start_players = narrow<std::uint8_t>(raw.start_players, "def.start_players");
  config.max_spectators = narrow<std::uint16_t>(raw.max_spectators, "def.max_spectators");
  config.spectator_delay_ticks = raw.spectator_delay_ticks;
  config.tick_count = raw.tick_count;
  config.rejoin_seed = raw.rejoin_seed;
  config.timeouts.drop_us = timeout_of(raw.drop_us, "def.drop_us");
  config.timeouts.rejoin_us = timeout_of(raw.rejoin_us, "def.rejoin_us");
  config.commands = {raw.command_bytes_max, raw.commands_per_second, raw.command_bytes_per_second};
  return config;
}

}  // namespace

struct lks_server final : net::ServerObserver {
  std::shared_ptr<Match> match;
  std::shared_ptr<Carrier> carrier;
  std::shared_ptr<LogWriter> log;
  Status log_status = Status::ok;
  SessionEvents events;
  std::unique_ptr<net::Server> server;
  bool relay = false;
  bool updating = false;

  lks_server() = default;
  lks_server(const lks_server&) = delete;
  lks_server& operator=(const lks_server&) = delete;
  ~lks_server() override {
    server.reset();
    if (carrier != nullptr) carrier->in_session = false;
    if (match != nullptr) match->in_session = false;
  }

  void note(Status status) {
    if (status == Status::ok || log_status != Status::ok) return;
    log_status = status;
    say(LKS_LEVEL_WARNING, "the log is given up: " + std::string(to_string(status)));
  }
  [[nodiscard]] bool records() const { return log != nullptr && log_status == Status::ok; }
  void record(replay::EventKind kind, std::uint8_t slot, std::string_view text) {
    if (records()) note(log->recorder->event(log->recorder->next_tick(), kind, slot, text));
  }

  void tick_confirmed(std::uint64_t tick, std::span<const PlayerInput> inputs,
                      std::optional<std::uint64_t> hash) override {
    lks_session_event event = event_of(LKS_SESSION_TICK);
    event.tick = tick;
    event.hash = hash.value_or(0);
    events.add(event);
    if (records()) note(log->recorder->record_tick(tick, inputs, event.hash));
    if (records() && log->recorder->keyframe_due())
      note(log->recorder->keyframe(*match->simulation));
  }
  void commands_confirmed(std::uint64_t tick, std::span<const PlayerCommand> commands) override {
    events.add_commands(tick, commands);
    if (records()) note(log->recorder->record_commands(commands));
  }
  void player_joined(std::uint8_t slot, std::string_view name) override {
    lks_session_event event = event_of(LKS_SESSION_JOINED);
    event.slot = slot;
    events.add(event, std::string(name));
    record(replay::EventKind::join, slot, {});
    record(replay::EventKind::name, slot, name);
    say(LKS_LEVEL_INFO, "player " + std::to_string(slot) + " joined: " + std::string(name));
  }
  void player_left(std::uint8_t slot, net::LeaveReason reason) override {
    lks_session_event event = event_of(LKS_SESSION_LEFT);
    event.slot = slot;
    event.reason = static_cast<std::uint32_t>(reason);
    const std::string text(to_string(reason));
    events.add(event, text);
    record(replay::EventKind::leave, slot, text);
    say(LKS_LEVEL_INFO, "player " + std::to_string(slot) + " left: " + text);
  }
  void player_silent(std::uint8_t slot, std::int64_t silent_us) override {
    lks_session_event event = event_of(LKS_SESSION_SILENT);
    event.slot = slot;
    event.value = silent_us;
    events.add(event);
  }
  void player_refused(const net::Refusal& refusal) override {
    lks_session_event event = event_of(LKS_SESSION_REFUSED);
    event.reason = static_cast<std::uint32_t>(refusal.reason);
    events.add(event, refusal.to_line());
    say(LKS_LEVEL_WARNING, refusal.to_line());
  }
  void desync_found(const net::DesyncReport& report) override {
    events.add(event_of(report), report.to_line());
    record(replay::EventKind::note, report.slot, "desync: " + report.to_line());
    say(LKS_LEVEL_ERROR, "desync: " + report.to_line());
  }
  void match_started() override { events.add(event_of(LKS_SESSION_STARTED)); }
  void player_active(std::uint8_t slot, std::uint64_t tick) override {
    lks_session_event event = event_of(LKS_SESSION_PLAYER_ACTIVE);
    event.slot = slot;
    event.tick = tick;
    events.add(event);
  }
  void player_asks(std::uint8_t slot, net::AskKind kind, std::uint8_t topic,
                   std::uint8_t choice) override {
    lks_session_event event = event_of(LKS_SESSION_ASKED);
    event.slot = slot;
    event.reason = static_cast<std::uint32_t>(kind);
    event.value = topic * 256 + choice;
    events.add(event);
  }
  void match_finished(net::FinishReason reason, std::uint64_t ticks,
                      std::optional<std::uint64_t> hash) override {
    lks_session_event event = event_of(LKS_SESSION_FINISHED);
    event.reason = static_cast<std::uint32_t>(reason);
    event.tick = ticks;
    event.hash = hash.value_or(0);
    events.add(event, std::string(to_string(reason)));
  }
};

namespace {

net::Server& running(lks_server* server) {
  if (required(server, "server").updating)
    throw_status(LKS_READ_ONLY, "the server is being updated");
  return *server->server;
}

const lks_server& handle(const lks_server* server) {
  return required(server, "server");
}

net::ServerParts parts_of(lks_server& made) {
  net::ServerParts parts;
  parts.transport = made.carrier->session;
  if (made.relay)
    parts.describer = made.match->simulation.get();
  else
    parts.simulation = made.match->simulation.get();
  parts.observer = &made;
  return parts;
}

void claim(lks_server& made, lks_simulation* simulation, lks_transport* transport) {
  const std::shared_ptr<Match>& match = required(simulation, "simulation").match;
  if (match == nullptr || match->in_session) throw_invalid("simulation", "is another session's");
  lockstone::c::claim(transport);
  made.carrier = transport->carrier;
  match->in_session = true;
  made.match = match;
}

lks_session_stats raw_of(const net::PlayerStats& stats) {
  lks_session_stats raw = traffic_of(stats);
  raw.hashes_compared = stats.hashes_compared;
  raw.hashes_equal = stats.hashes_equal;
  raw.commands_taken = stats.commands_taken;
  raw.commands_refused = stats.commands_refused;
  return raw;
}

}  // namespace

lks_status lks_server_def_init(lks_server_def* def, size_t size) {
  return call([&] { give(raw_def(net::ServerConfig{}), def, size, "def"); });
}

lks_status lks_server_create(const lks_server_def* def, lks_simulation* simulation,
                             lks_transport* transport, lks_server** out) {
  return call([&] {
    required(out, "out");
    const lks_server_def raw = take(def, raw_def(net::ServerConfig{}), "def");
    net::ServerConfig config = config_of(raw);
    auto made = std::make_unique<lks_server>();
    made->relay = flag(raw.relay, "def.relay");
    claim(*made, simulation, transport);
    config.match_config = made->match->config;
    config.info = made->match->simulation->info();
    net::Server::Created created = net::Server::create(config, parts_of(*made));
    if (created.server == nullptr) throw_invalid("def", to_string(created.error));
    made->server = std::move(created.server);
    *out = made.release();
  });
}

void lks_server_destroy(lks_server* server) {
  delete server;
}

lks_status lks_server_update(lks_server* server, int64_t now_us) {
  return call([&] {
    net::Server& target = running(server);
    if (now_us < 0) throw_invalid("now_us", "must not be negative");
    server->events.clear();
    const Updating during(server->updating);
    target.update(now_us);
    if (server->log_status != Status::ok) {
      throw_status(static_cast<lks_status>(server->log_status), "the log was given up");
    }
  });
}

lks_status lks_server_events(const lks_server* server, lks_session_event* out, size_t capacity,
                             size_t* count) {
  return call([&] { handle(server).events.give(out, capacity, count); });
}

lks_status lks_server_event_text(const lks_server* server, size_t index, char* out,
                                 size_t capacity) {
  return call([&] { handle(server).events.give_text(index, out, capacity); });
}

lks_status lks_server_event_bytes(const lks_server* server, size_t index, void* out,
                                  size_t capacity, size_t* count) {
  return call([&] { handle(server).events.give_command(index, out, capacity, count); });
}

lks_status lks_server_send_command(lks_server* server, const void* bytes, size_t count) {
  return call([&] {
    const ByteView command = bytes_of(bytes, count, "bytes");
    const Status status = running(server).send_command(command);
    if (status != Status::ok) throw_failure(status);
  });
}

lks_status lks_server_record(lks_server* server, lks_recorder* recorder) {
  return call([&] {
    running(server);
    const std::shared_ptr<LogWriter>& log = required(recorder, "recorder").log;
    if (server->relay) throw_invalid("server", "a relay has no states to record");
    if (log->match != server->match) throw_invalid("recorder", "records another simulation");
    if (log->recorder->next_tick() != server->match->simulation->tick())
      throw_invalid("recorder", "does not stand at the server's tick");
    server->log = log;
    server->log_status = Status::ok;
  });
}

lks_status lks_server_stop(lks_server* server) {
  return call([&] { running(server).stop(); });
}

lks_status lks_server_pause(lks_server* server, uint32_t paused) {
  return call([&] {
    net::Server& target = running(server);
    flag(paused, "paused") ? target.pause() : target.resume();
  });
}

lks_status lks_server_get(const lks_server* server, lks_server_view* view) {
  return call([&] {
    const net::Server& source = *handle(server).server;
    lks_server_view raw{};
    raw.state = static_cast<std::uint32_t>(source.state());
    raw.ticks_closed = source.ticks_confirmed();
    if (source.state() >= net::ServerState::closing)
      raw.finish_reason = static_cast<std::uint32_t>(source.finish_reason());
    raw.present = source.present_mask();
    raw.waiting = source.waiting_mask();
    raw.present_mask = static_cast<std::uint32_t>(raw.present);
    raw.waiting_mask = static_cast<std::uint32_t>(raw.waiting);
    raw.spectators = static_cast<std::uint32_t>(source.spectators());
    raw.paused = source.paused() ? 1 : 0;
    give(raw, view, required(view, "view").size, "view");
  });
}

lks_status lks_server_player_name(const lks_server* server, uint32_t slot, char* out,
                                  size_t capacity) {
  return call([&] {
    const lks_server& source = handle(server);
    if (slot >= source.match->simulation->info().player_count)
      throw_invalid("slot", "there is no such slot");
    write_text(source.server->player_name(static_cast<std::uint8_t>(slot)),
               array(out, capacity, "out"), capacity);
  });
}

lks_status lks_server_stats(const lks_server* server, uint32_t slot, lks_session_stats* stats) {
  return call([&] {
    const lks_server& source = handle(server);
    if (slot >= source.match->simulation->info().player_count)
      throw_invalid("slot", "there is no such slot");
    give(raw_of(source.server->stats(static_cast<std::uint8_t>(slot))), stats,
         required(stats, "stats").size, "stats");
  });
}
