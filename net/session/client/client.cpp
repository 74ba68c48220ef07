// The calls of a client, and the order in which its parts act in an update.
#include <algorithm>
#include <utility>

#include <lockstone/assert.h>

#include "net/session/client/client_impl.h"
#include "net/session/setup.h"

namespace lockstone::net {
namespace {

constexpr std::uint32_t k_max_lead_ticks = 32;
static_assert(k_max_input_delay_ticks + 2 * k_max_lead_ticks + 1 < k_input_window_ticks,
              "a server refuses inputs beyond its window");

}  // namespace

Client::Created Client::create(const ClientConfig& config, ClientParts parts) {
  if (parts.transport == nullptr) misused("Client::create: ClientParts::transport is null");
  if (parts.inputs == nullptr) misused("Client::create: ClientParts::inputs is null");
  if (parts.factory == nullptr) misused("Client::create: ClientParts::factory is empty");
  if (config.max_steps_per_update == 0)
    misused("Client::create: ClientConfig::max_steps_per_update must be above 0");
  SetupError error = check_security(config.insecure, *parts.transport);
  if (error != SetupError::none) return {nullptr, error};
  error = check_common(config.history_ticks, config.snapshot_ticks, config.timeouts);
  if (config.prediction_ticks > k_max_prediction_ticks ||
      config.prediction_delay_ticks > k_max_input_delay_ticks) {
    error = SetupError::prediction_out_of_range;
  }
  if (config.max_lead_ticks > k_max_lead_ticks) error = SetupError::input_delay_out_of_range;
  if (error != SetupError::none) return {nullptr, error};
  return {std::unique_ptr<Client>(new Client(std::make_unique<Impl>(config, std::move(parts)))),
          SetupError::none};
}

Client::Client(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Client::~Client() = default;
void Client::update(std::int64_t now_us) {
  impl_->update(now_us);
}
ClientState Client::state() const {
  return impl_->data.status.state;
}
ClientFailure Client::failure() const {
  return impl_->data.status.failure;
}
LeaveReason Client::leave_reason() const {
  return impl_->data.status.leave_reason;
}
const Refusal& Client::refusal() const {
  return impl_->data.status.refusal;
}
FinishReason Client::finish_reason() const {
  return impl_->data.status.finish_reason;
}
std::uint8_t Client::slot() const {
  return impl_->data.place.seated ? impl_->data.place.welcome.slot : k_no_slot;
}
std::string_view Client::player_name(std::uint8_t slot) const {
  return slot < k_max_players ? impl_->data.names[slot].view() : std::string_view();
}
std::uint64_t Client::ticks_stepped() const {
  return impl_->data.progress.stepped;
}
SlotMask Client::waiting_mask() const {
  return impl_->data.status.waiting;
}
std::uint64_t Client::ticks_predicted() const {
  return std::max(impl_->prediction.head(), impl_->data.progress.stepped);
}
std::optional<std::uint64_t> Client::active_tick() const {
  if (!impl_->data.place.plays()) return std::nullopt;
  return impl_->data.place.active_tick;
}
std::uint64_t Client::rejoin_key() const {
  return impl_->data.place.rejoin_key;
}
bool Client::reconnect(ConnectionId connection) {
  return impl_->reconnect(connection);
}
bool Client::may_reconnect() const {
  return net::may_reconnect(impl_->data.status);
}
bool Client::paused() const {
  return impl_->data.status.paused;
}
void Client::ask(AskKind kind, std::uint8_t topic, std::uint8_t choice) {
  impl_->ask(kind, topic, choice);
}
Simulation* Client::simulation() const {
  return impl_->data.game.simulation.get();
}
ClientStats Client::stats() const {
  return current_stats(impl_->data);
}
Result<std::uint64_t> Client::send_command(ByteView bytes) {
  return impl_->commands.give(bytes);
}
void Client::leave() {
  if (impl_->data.status.active()) impl_->end.leave();
}

Client::Impl::Impl(const ClientConfig& config, ClientParts parts)
    : data(config, std::move(parts)),
      prediction(data),
      playback(data, prediction),
      receiver(data),
      sender(data),
      commands(data),
      dump(data, prediction),
      end(data, playback),
      entry(data, prediction, sender),
      handshake(data, {prediction, entry, dump, commands, end}) {}

void Client::Impl::update(std::int64_t now_us) {
  LKS_ASSERT(!updated || now_us >= data.status.now_us);
  data.status.now_us = now_us;
  if (!updated) begin(now_us);
  receive();
  if (data.status.active()) watch_server();
  if (data.status.state == ClientState::running) play();
  const ClientState state = data.status.state;
  if (state >= ClientState::lobby && state <= ClientState::running) {
    commands.send_pieces();
    sender.send_due();
  }
  data.server.flush();
}

void Client::Impl::begin(std::int64_t now_us) {
  begun_us = now_us;
  watch.heard(now_us);
  updated = true;
}

void Client::Impl::play() {
  playback.advance();
  sender.sample();
  if (data.predicts()) {
    const bool deterministic = !data.config.sync_test || prediction.passes_sync_test();
    if (!deterministic) end.fail(ClientFailure::not_deterministic);
    prediction.advance();
  }
  receiver.request_missing();
  dump.send_pieces();
}

void Client::Impl::receive() {
  TransportEvent event;
  while (data.parts.transport->poll(data.status.now_us, event)) {
    if (event.connection != data.server.id() || !data.status.active()) continue;
    switch (event.kind) {
      case TransportEventKind::connected:
        handshake.say_hello();
        break;
      case TransportEventKind::disconnected:
        end.connection_ended(event.reason);
        break;
      case TransportEventKind::received:
        receive_packet(event.bytes);
        break;
    }
  }
}

void Client::Impl::receive_packet(ByteView packet) {
  watch.heard(data.status.now_us);
  if (dispatch(packet)) return;
  ++data.stats.malformed_packets;
  if (watch.malformed(data.status.now_us)) end.leave_malformed_server();
}

// False for a packet that breaks the format or comes out of turn; then it had no effect at all.
bool Client::Impl::dispatch(ByteView packet) {
  const Result<MessageType> type = message_type(packet);
  if (!type) return false;
  switch (type.value()) {
    case MessageType::offer:
      return handshake.on_offer(packet);
    case MessageType::welcome:
      return handshake.on_welcome(packet);
    case MessageType::refuse:
      return end.on_refuse(packet);
    case MessageType::start:
      return entry.on_start(packet);
    case MessageType::ticks:
      return receiver.on_ticks(packet);
    case MessageType::desync:
      return on_desync(packet);
    case MessageType::dump_request:
      return dump.on_request(packet);
    case MessageType::snapshot:
      return entry.on_snapshot(packet);
    case MessageType::activate:
      return entry.on_activate(packet);
    case MessageType::paused:
      return on_paused(packet);
    case MessageType::tick_command:
      return commands.on_tick_command(packet);
    case MessageType::command_result:
      return commands.on_result(packet);
    case MessageType::named:
      return on_named(packet);
    case MessageType::finish:
      return end.on_finish(packet);
    case MessageType::bye:
      return end.on_bye(packet);
    default:
      return false;
  }
}

void Client::Impl::watch_server() {
  const std::int64_t now_us = data.status.now_us;
  const Timeouts& timeouts = data.config.timeouts;
  if (!data.place.seated) {
    if (now_us - begun_us > timeouts.handshake_us) end.fail(ClientFailure::handshake_timed_out);
    return;
  }
  const std::int64_t silent_us = watch.silent_us(now_us);
  if (watch.warn(now_us, timeouts.silence_warning_us)) data.observer->server_silent(silent_us);
  if (silent_us > timeouts.drop_us) end.fail(ClientFailure::server_silent);
}

bool Client::Impl::reconnect(ConnectionId connection) {
  ClientStatus& status = data.status;
  const bool refused = status.state == ClientState::refused &&
                       status.refusal.reason == RefuseReason::handshake_timeout;
  if (status.state != ClientState::failed && !refused) return false;
  const bool lost = refused || status.failure == ClientFailure::connection_lost ||
                    status.failure == ClientFailure::server_silent ||
                    status.failure == ClientFailure::handshake_timed_out ||
                    status.failure == ClientFailure::dropped;
  if (!lost) return false;
  prediction.drop_guesses();
  data.server.replace(connection);
  status.state = ClientState::connecting;
  status.failure = ClientFailure::none;
  status.refusal = {};
  status.paused = false;
  status.waiting = 0;
  watch = {};
  updated = false;
  data.place.seated = false;
  data.place.active_tick = ClientPlace::k_never;
  handshake.restart();
  entry.cancel();
  dump.cancel();
  data.ticks.clear(0);  // a server that was started again may confirm other ticks
  return true;
}

void Client::Impl::ask(AskKind kind, std::uint8_t topic, std::uint8_t choice) {
  const bool votes = kind == AskKind::vote;
  if (!data.place.seated || !data.status.active() || data.place.spectates()) return;
  data.server.send(Ask{kind, votes ? topic : std::uint8_t{0}, votes ? choice : std::uint8_t{0}});
}

bool Client::Impl::on_desync(ByteView packet) {
  DesyncNotice notice;
  if (decode(packet, notice) != Status::ok) return false;
  if (data.status.state != ClientState::running) return false;
  DesyncReport report;
  report.tick = notice.tick;
  report.slot = notice.slot;
  report.name = data.names[notice.slot].view();
  report.verdict = notice.verdict;
  report.hash_here = notice.hash_here;
  report.hash_there = notice.hash_there;
  report.difference = {notice.differs,
                       std::string(notice.store.view()),
                       notice.object,
                       std::string(notice.name.view()),
                       std::string(notice.field.view()),
                       std::string(notice.here.view()),
                       std::string(notice.there.view())};
  data.observer->desync_reported(report);
  return true;
}

bool Client::Impl::on_paused(ByteView packet) {
  Paused message;
  if (decode(packet, message) != Status::ok || !data.place.seated) return false;
  data.status.paused = message.paused;
  data.observer->pause_changed(message.paused);
  return true;
}

bool Client::Impl::on_named(ByteView packet) {
  Named message;
  if (decode(packet, message) != Status::ok || !data.place.seated) return false;
  if (message.slot >= data.game.info.player_count) return false;
  data.names[message.slot] = message.name;
  data.observer->player_named(message.slot, message.name.view());
  return true;
}

void ClientObserver::joined(std::uint8_t) {}
void ClientObserver::match_started() {}
void ClientObserver::tick_stepped(std::uint64_t, std::span<const PlayerInput>, std::uint64_t) {}
void ClientObserver::commands_stepped(std::uint64_t, std::span<const PlayerCommand>) {}
void ClientObserver::command_refused(std::uint64_t) {}
void ClientObserver::server_silent(std::int64_t) {}
void ClientObserver::desync_reported(const DesyncReport&) {}
void ClientObserver::match_finished(FinishReason, std::uint64_t) {}
void ClientObserver::state_loaded(std::uint64_t) {}
void ClientObserver::player_active(std::uint8_t, std::uint64_t) {}
void ClientObserver::pause_changed(bool) {}
void ClientObserver::player_named(std::uint8_t, std::string_view) {}
void ClientObserver::input_replaced(std::uint64_t) {}
void ClientObserver::tick_predicted(std::uint64_t, std::span<const PlayerInput>) {}
void ClientObserver::rolled_back(std::uint64_t, std::uint64_t) {}

}  // namespace lockstone::net
