// The client's side of sessions.
#include <algorithm>

#include <lockstone/net/client.h>

#include "tools/bindings/c/session_handles.h"

namespace {

using namespace lockstone;
using namespace lockstone::c;

static_assert(LKS_CLIENT_FAILED == static_cast<int>(net::ClientState::failed));
static_assert(LKS_NO_SLOT == net::k_no_slot && LKS_SPECTATOR_SLOT == net::k_spectator_slot);

lks_client_def raw_def(const net::ClientConfig& config) {
  lks_client_def raw{};
  raw.size = sizeof raw;
  raw.insecure = config.insecure ? 1 : 0;
  raw.wanted_slot = config.wanted_slot;
  raw.prediction_ticks = config.prediction_ticks;
  raw.prediction_delay_ticks = config.prediction_delay_ticks;
  raw.sync_test = config.sync_test ? 1 : 0;
  raw.history_ticks = config.history_ticks;
  raw.snapshot_ticks = config.snapshot_ticks;
  raw.adapt_lead = config.adapt_lead ? 1 : 0;
  raw.play_out_evenly = config.play_out_evenly ? 1 : 0;
  raw.handshake_us = config.timeouts.handshake_us;
  raw.drop_us = config.timeouts.drop_us;
  return raw;
}

net::ClientConfig config_of(const lks_client_def& raw) {
  net::ClientConfig config;
  config.insecure = flag(raw.insecure, "def.insecure");
  config.wanted_slot = narrow<std::uint8_t>(raw.wanted_slot, "def.wanted_slot");
  config.prediction_ticks = narrow<std::uint8_t>(raw.prediction_ticks, "def.prediction_ticks");
  config.prediction_delay_ticks =
      narrow<std::uint8_t>(raw.prediction_delay_ticks, "def.prediction_delay_ticks");
  config.sync_test = flag(raw.sync_test, "def.sync_test");
  config.history_ticks = raw.history_ticks;
  config.snapshot_ticks = raw.snapshot_ticks;
  config.adapt_lead = flag(raw.adapt_lead, "def.adapt_lead");
  config.play_out_evenly = flag(raw.play_out_evenly, "def.play_out_evenly");
  config.rejoin_key = raw.rejoin_key;
  config.timeouts.handshake_us = timeout_of(raw.handshake_us, "def.handshake_us");
  config.timeouts.drop_us = timeout_of(raw.drop_us, "def.drop_us");
  config.name = text_in(raw.name, "def.name");
  config.build = text_in(raw.build, "def.build");
  return config;
}

/// A client with all that it uses. Handles of its simulation share it.
struct ClientBox final : net::ClientObserver, net::InputSource, net::InputPredictor {
  std::shared_ptr<const Game> game;
  std::shared_ptr<Carrier> carrier;
  SessionEvents events;
  std::array<std::byte, k_max_input_bytes> input{};
  lks_sample_function sample_input = nullptr;
  void* sample_user = nullptr;
  lks_predict_function predict_input = nullptr;
  void* predict_user = nullptr;
  std::unique_ptr<net::Client> client;
  bool updating = false;
  std::vector<std::byte> config;   ///< of the match, from the server
  std::shared_ptr<LogWriter> log;  ///< null: not recorded
  bool keyframes = true;           ///< the simulation stands at the tick that was confirmed last

  ClientBox() = default;
  ClientBox(const ClientBox&) = delete;
  ClientBox& operator=(const ClientBox&) = delete;
  ~ClientBox() override {
    client.reset();
    if (carrier != nullptr) carrier->in_session = false;
  }

  void sample(std::uint64_t tick, std::span<std::byte> out) override {
    std::copy_n(input.begin(), out.size(), out.begin());
    if (sample_input == nullptr) return;
    sample_input(sample_user, tick, reinterpret_cast<std::uint8_t*>(out.data()), out.size());
  }
  void predict(std::uint64_t tick, std::uint8_t slot, std::span<std::byte> out) override {
    if (predict_input == nullptr) return;
    predict_input(predict_user, tick, slot, reinterpret_cast<std::uint8_t*>(out.data()),
                  out.size());
  }

  void at_tick(std::uint32_t kind, std::uint64_t tick, std::uint64_t hash = 0,
               std::int64_t value = 0) {
    lks_session_event event = event_of(kind);
    event.tick = tick;
    event.hash = hash;
    event.value = value;
    events.add(event);
  }
  void joined(std::uint8_t slot) override {
    lks_session_event event = event_of(LKS_SESSION_JOINED);
    event.slot = slot;
    events.add(event);
    say(LKS_LEVEL_INFO, "joined as player " + std::to_string(slot));
  }
  void match_started() override { events.add(event_of(LKS_SESSION_STARTED)); }
  void tick_stepped(std::uint64_t tick, std::span<const PlayerInput> inputs,
                    std::uint64_t hash) override {
    at_tick(LKS_SESSION_TICK, tick, hash);
    if (log == nullptr) return;
    replay::Recorder& recorder = *log->recorder;
    Status status = recorder.record_tick(tick, inputs, hash);
    if (status == Status::ok && keyframes && recorder.keyframe_due())
      status = recorder.keyframe(*client->simulation());
    if (status != Status::ok) log.reset();
  }
  void commands_stepped(std::uint64_t tick, std::span<const PlayerCommand> commands) override {
    events.add_commands(tick, commands);
    if (log != nullptr && log->recorder->record_commands(commands) != Status::ok) log.reset();
  }
  void command_refused(std::uint64_t number) override {
    at_tick(LKS_SESSION_COMMAND_REFUSED, 0, 0, static_cast<std::int64_t>(number));
  }
  void server_silent(std::int64_t silent_us) override {
    at_tick(LKS_SESSION_SILENT, 0, 0, silent_us);
  }
  void desync_reported(const net::DesyncReport& report) override {
    events.add(event_of(report), report.to_line());
    say(LKS_LEVEL_ERROR, "desync: " + report.to_line());
  }
  void match_finished(net::FinishReason reason, std::uint64_t ticks) override {
    lks_session_event event = event_of(LKS_SESSION_FINISHED);
    event.reason = static_cast<std::uint32_t>(reason);
    event.tick = ticks;
    events.add(event, std::string(to_string(reason)));
  }
  void state_loaded(std::uint64_t ticks) override {
    log.reset();  // its ticks would not follow each other
    at_tick(LKS_SESSION_STATE_LOADED, ticks);
  }
  void player_active(std::uint8_t slot, std::uint64_t tick) override {
    lks_session_event event = event_of(LKS_SESSION_PLAYER_ACTIVE);
    event.slot = slot;
    event.tick = tick;
    events.add(event);
  }
  void player_named(std::uint8_t slot, std::string_view name) override {
    lks_session_event event = event_of(LKS_SESSION_NAMED);
    event.slot = slot;
    events.add(event, std::string(name));
  }
  void pause_changed(bool paused) override { at_tick(LKS_SESSION_PAUSED, 0, 0, paused ? 1 : 0); }
  void input_replaced(std::uint64_t tick) override { at_tick(LKS_SESSION_INPUT_REPLACED, tick); }
  void tick_predicted(std::uint64_t tick, std::span<const PlayerInput>) override {
    at_tick(LKS_SESSION_PREDICTED, tick);
  }
  void rolled_back(std::uint64_t tick, std::uint64_t count) override {
    at_tick(LKS_SESSION_ROLLED_BACK, tick, 0, static_cast<std::int64_t>(count));
  }
};

}  // namespace

struct lks_client {
  std::shared_ptr<ClientBox> box;
};

namespace {

const ClientBox& read(const lks_client* client) {
  return *required(client, "client").box;
}

ClientBox& write(lks_client* client) {
  ClientBox& box = *required(client, "client").box;
  if (box.updating) throw_status(LKS_READ_ONLY, "the client is being updated");
  return box;
}

std::string reason_of(const net::Client& client) {
  if (client.state() == net::ClientState::refused) return client.refusal().to_line();
  if (client.state() != net::ClientState::failed) return {};
  std::string text(to_string(client.failure()));
  if (client.failure() == net::ClientFailure::dropped)
    text += ": " + std::string(to_string(client.leave_reason()));
  return text;
}

lks_session_stats raw_of(const net::ClientStats& stats) {
  lks_session_stats raw = traffic_of(stats);
  raw.rollbacks = stats.rollbacks;
  raw.ticks_stepped_again = stats.ticks_stepped_again;
  raw.states_loaded = stats.states_loaded;
  raw.islands_computed_again = stats.islands_computed_again;
  raw.islands_recalled = stats.islands_recalled;
  raw.jitter_us = stats.jitter_us;
  return raw;
}

}  // namespace

lks_status lks_client_def_init(lks_client_def* def, size_t size) {
  return call([&] { give(raw_def(net::ClientConfig{}), def, size, "def"); });
}

lks_status lks_client_create(const lks_client_def* def, const lks_game* game,
                             lks_transport* transport, lks_connection connection,
                             lks_client** out) {
  return call([&] {
    required(out, "out");
    const net::ClientConfig config = config_of(take(def, raw_def(net::ClientConfig{}), "def"));
    auto box = std::make_shared<ClientBox>();
    box->game = required(game, "game").game;
    claim(transport);
    box->carrier = transport->carrier;
    net::ClientParts parts;
    parts.transport = box->carrier->session;
    parts.connection = connection;
    parts.factory = [owner = box.get()](ByteView bytes) {
      owner->config.assign(bytes.begin(), bytes.end());
      return owner->game->make(bytes);
    };
    box->keyframes = config.prediction_ticks == 0;
    parts.inputs = box.get();
    parts.observer = box.get();
    parts.predictor = box.get();
    net::Client::Created created = net::Client::create(config, std::move(parts));
    if (created.client == nullptr) throw_invalid("def", to_string(created.error));
    box->client = std::move(created.client);
    *out = new lks_client{std::move(box)};
  });
}

void lks_client_destroy(lks_client* client) {
  delete client;
}

lks_status lks_client_set_input(lks_client* client, const void* input, size_t bytes) {
  return call([&] {
    ClientBox& box = write(client);
    if (bytes > k_max_input_bytes) throw_invalid("bytes", "must be at most 64");
    const ByteView given = bytes_of(input, bytes, "input");
    box.input.fill(std::byte{0});
    std::ranges::copy(given, box.input.begin());
  });
}

lks_status lks_client_on_sample(lks_client* client, lks_sample_function sample, void* user) {
  return call([&] {
    ClientBox& box = write(client);
    box.sample_input = sample;
    box.sample_user = user;
  });
}

lks_status lks_client_on_predict(lks_client* client, lks_predict_function predict, void* user) {
  return call([&] {
    ClientBox& box = write(client);
    box.predict_input = predict;
    box.predict_user = user;
  });
}

lks_status lks_client_update(lks_client* client, int64_t now_us) {
  return call([&] {
    ClientBox& box = write(client);
    if (now_us < 0) throw_invalid("now_us", "must not be negative");
    box.events.clear();
    const Updating during(box.updating);
    box.client->update(now_us);
  });
}

lks_status lks_client_events(const lks_client* client, lks_session_event* out, size_t capacity,
                             size_t* count) {
  return call([&] { read(client).events.give(out, capacity, count); });
}

lks_status lks_client_event_text(const lks_client* client, size_t index, char* out,
                                 size_t capacity) {
  return call([&] { read(client).events.give_text(index, out, capacity); });
}

lks_status lks_client_event_bytes(const lks_client* client, size_t index, void* out,
                                  size_t capacity, size_t* count) {
  return call([&] { read(client).events.give_command(index, out, capacity, count); });
}

lks_status lks_client_send_command(lks_client* client, const void* bytes, size_t count,
                                   uint64_t* number) {
  return call([&] {
    const ByteView command = bytes_of(bytes, count, "bytes");
    const Result<std::uint64_t> sent = write(client).client->send_command(command);
    if (!sent) throw_failure(sent.status());
    if (number != nullptr) *number = sent.value();
  });
}

lks_status lks_client_get(const lks_client* client, lks_client_view* view) {
  return call([&] {
    const net::Client& source = *read(client).client;
    lks_client_view raw{};
    raw.state = static_cast<std::uint32_t>(source.state());
    raw.ticks_stepped = source.ticks_stepped();
    raw.ticks_predicted = source.ticks_predicted();
    raw.rejoin_key = source.rejoin_key();
    raw.slot = source.slot();
    raw.finish_reason = static_cast<std::uint32_t>(source.finish_reason());
    raw.may_reconnect = source.may_reconnect() ? 1 : 0;
    raw.paused = source.paused() ? 1 : 0;
    raw.waiting = source.waiting_mask();
    raw.waiting_mask = static_cast<std::uint32_t>(raw.waiting);
    give(raw, view, required(view, "view").size, "view");
  });
}

lks_status lks_client_reason(const lks_client* client, char* out, size_t capacity) {
  return call([&] {
    const net::Client& source = *read(client).client;
    write_text(reason_of(source), array(out, capacity, "out"), capacity);
  });
}

lks_status lks_client_player_name(const lks_client* client, uint32_t slot, char* out,
                                  size_t capacity) {
  return call([&] {
    if (slot >= k_max_players) throw_invalid("slot", "there is no such slot");
    const net::Client& source = *read(client).client;
    write_text(source.player_name(static_cast<std::uint8_t>(slot)), array(out, capacity, "out"),
               capacity);
  });
}

lks_status lks_client_simulation(const lks_client* client, lks_simulation** out) {
  return call([&] {
    const std::shared_ptr<ClientBox>& box = required(client, "client").box;
    required(out, "out");
    Simulation* simulation = box->client->simulation();
    if (simulation == nullptr) throw_status(LKS_NOT_FOUND, "the match is not known yet");
    *out = new lks_simulation{nullptr, {box, simulation}};
  });
}

lks_status lks_client_stats(const lks_client* client, lks_session_stats* stats) {
  return call([&] {
    const net::ClientStats source = read(client).client->stats();
    give(raw_of(source), stats, required(stats, "stats").size, "stats");
  });
}

lks_status lks_client_ask(lks_client* client, uint32_t kind, uint32_t topic, uint32_t choice) {
  return call([&] {
    ClientBox& box = write(client);
    box.client->ask(enumerator(kind, net::AskKind::pause, net::AskKind::vote, "kind"),
                    narrow<std::uint8_t>(topic, "topic"), narrow<std::uint8_t>(choice, "choice"));
  });
}

lks_status lks_client_reconnect(lks_client* client, lks_connection connection) {
  return call([&] {
    if (!write(client).client->reconnect(connection))
      throw_status(LKS_INCOMPATIBLE, "the client's state allows no new connection");
  });
}

lks_status lks_client_leave(lks_client* client) {
  return call([&] { write(client).client->leave(); });
}

lks_status lks_client_record(lks_client* client, const lks_recorder_def* def, lks_recorder** out) {
  return call([&] {
    ClientBox& box = write(client);
    required(out, "out");
    const Simulation* simulation = box.client->simulation();
    if (simulation == nullptr) throw_status(LKS_NOT_FOUND, "the match is not known yet");
    if (box.log != nullptr) throw_invalid("client", "is recorded already");
    if (!box.keyframes && simulation->tick() > 0)
      throw_status(LKS_INCOMPATIBLE, "the client predicts, and has stepped ticks");
    auto match = std::make_shared<Match>();
    match->game = box.game;
    match->config = box.config;
    auto sink = std::make_unique<replay::MemorySink>();
    const replay::MemorySink* memory = sink.get();
    auto made = std::make_unique<lks_recorder>();
    made->log = LogWriter::begin(def, std::move(match), *simulation, std::move(sink));
    made->log->memory = memory;
    box.log = made->log;
    *out = made.release();
  });
}
