// The client's connection, handshake and end.
#include <algorithm>
#include <utility>

#include <lockstone/assert.h>
#include <lockstone/hash.h>

#include "net/session/client_impl.h"
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
  return impl_->state;
}
ClientFailure Client::failure() const {
  return impl_->failure;
}
LeaveReason Client::leave_reason() const {
  return impl_->leave_reason;
}
const Refusal& Client::refusal() const {
  return impl_->refusal;
}
FinishReason Client::finish_reason() const {
  return impl_->finish_reason;
}
std::uint8_t Client::slot() const {
  return impl_->seated ? impl_->seat.slot : k_no_slot;
}
std::uint64_t Client::ticks_stepped() const {
  return impl_->stepped;
}
std::uint16_t Client::waiting_mask() const {
  return impl_->waiting;
}
std::uint64_t Client::ticks_predicted() const {
  return std::max(impl_->head, impl_->stepped);
}
std::optional<std::uint64_t> Client::active_tick() const {
  if (impl_->active_tick == Impl::k_never) return std::nullopt;
  return impl_->active_tick;
}
std::uint64_t Client::rejoin_key() const {
  return impl_->rejoin_key;
}
bool Client::reconnect(ConnectionId connection) {
  return impl_->reconnect(connection);
}
bool Client::may_reconnect() const {
  return impl_->may_reconnect();
}
bool Client::paused() const {
  return impl_->paused;
}
void Client::ask(AskKind kind, std::uint8_t topic, std::uint8_t choice) {
  const bool votes = kind == AskKind::vote;
  if (!impl_->seated || !impl_->active() || impl_->spectates()) return;
  impl_->send(Ask{kind, votes ? topic : std::uint8_t{0}, votes ? choice : std::uint8_t{0}});
}
Simulation* Client::simulation() const {
  return impl_->simulation.get();
}
ClientStats Client::stats() const {
  return impl_->current_stats();
}

void Client::leave() {
  if (impl_->active()) impl_->hang_up(ClientState::finished, LeaveReason::left);
}

Client::Impl::Impl(const ClientConfig& client_config, ClientParts client_parts)
    : config(client_config),
      parts(std::move(client_parts)),
      observer(parts.observer == nullptr ? &silent_observer : parts.observer),
      rejoin_key(config.rejoin_key),
      out(k_max_message_bytes) {}

void Client::Impl::update(std::int64_t now) {
  LKS_ASSERT(!updated || now >= now_us);
  now_us = now;
  if (!updated) {
    begun_us = now;
    watch.heard(now);
    updated = true;
  }
  receive();
  if (active()) watch_server();
  if (state == ClientState::running) {
    step_ticks(unacknowledged_limit());
    sample_inputs();
    if (predicts()) predict_ticks();
    request_missing();
    send_dump_chunks();
  }
  if (state >= ClientState::lobby && state <= ClientState::running) send_due_inputs();
  parts.transport->flush();
}

void Client::Impl::receive() {
  TransportEvent event;
  while (parts.transport->poll(now_us, event)) {
    if (event.connection != parts.connection || !active()) continue;
    switch (event.kind) {
      case TransportEventKind::connected:
        say_hello();
        break;
      case TransportEventKind::disconnected:
        connection_ended(event.reason);
        break;
      case TransportEventKind::received:
        receive_packet(event.bytes);
        break;
    }
  }
}

void Client::Impl::receive_packet(ByteView packet) {
  watch.heard(now_us);
  if (dispatch(packet)) return;
  ++stats.malformed_packets;
  if (watch.malformed(now_us)) {
    hang_up(ClientState::failed, LeaveReason::malformed);
    failure = ClientFailure::server_malformed;
  }
}

// False for a packet that breaks the format or comes out of turn; then it had no effect at all.
bool Client::Impl::dispatch(ByteView packet) {
  const Result<MessageType> type = message_type(packet);
  if (!type) return false;
  switch (type.value()) {
    case MessageType::offer:
      return on_offer(packet);
    case MessageType::welcome:
      return on_welcome(packet);
    case MessageType::refuse:
      return on_refuse(packet);
    case MessageType::start:
      return on_start(packet);
    case MessageType::ticks:
      return on_ticks(packet);
    case MessageType::desync:
      return on_desync(packet);
    case MessageType::dump_request:
      return on_dump_request(packet);
    case MessageType::snapshot:
      return on_snapshot(packet);
    case MessageType::activate:
      return on_activate(packet);
    case MessageType::paused:
      return on_paused(packet);
    case MessageType::finish:
      return on_finish(packet);
    case MessageType::bye:
      return on_bye(packet);
    default:
      return false;
  }
}

void Client::Impl::watch_server() {
  if (!seated) {
    if (now_us - begun_us > config.timeouts.handshake_us) fail(ClientFailure::handshake_timed_out);
    return;
  }
  const std::int64_t silent_us = watch.silent_us(now_us);
  if (watch.warn(now_us, config.timeouts.silence_warning_us)) observer->server_silent(silent_us);
  if (silent_us > config.timeouts.drop_us) fail(ClientFailure::server_silent);
}

void Client::Impl::say_hello() {
  if (state != ClientState::connecting) return;
  state = ClientState::handshaking;
  Hello hello;
  hello.insecure = config.insecure;
  const bool seated_before = rejoin_key != 0 && seat.slot < info.player_count;
  hello.wanted_slot = seated_before ? seat.slot : config.wanted_slot;
  hello.name = NameText(config.name);
  hello.build = BuildText(config.build);
  hello.rejoin_key = rejoin_key;
  hello.ticks_stepped = stepped;
  hello.state_hash = state_hash;
  send(hello);
}

bool Client::Impl::on_offer(ByteView packet) {
  Offer offer;
  if (decode(packet, offer) != Status::ok) return false;
  const bool expected = state == ClientState::handshaking && !offered;
  if (!expected || offer.insecure != config.insecure) return false;
  offered = true;
  if (knows_state(offer.config)) {
    send(Answer{info});
    return true;
  }
  if (stepped > 0) {  // the state that Hello spoke of is of another match
    fail(ClientFailure::config_not_understood);
    return true;
  }
  Result<std::unique_ptr<Simulation>> made = parts.factory(offer.config);
  if (!made || check_info(made.value()->info()) != SetupError::none) {
    fail(ClientFailure::config_not_understood);
    return true;
  }
  simulation = std::move(made).value();
  info = simulation->info();
  shape = {info.player_count, info.input_bytes};
  tick_us = 1'000'000 / info.tick_rate;
  offered_hash = hash64(offer.config);
  reserve_memory();
  send(Answer{info});
  return true;
}

void Client::Impl::reserve_memory() {
  const std::size_t snapshot_bytes = simulation->snapshot_bytes_max(SnapshotKind::canonical);
  const bool keeps = snapshot_bytes <= config.max_snapshot_bytes;
  records = TickRing(config.history_ticks, shape.record_bytes());
  own_inputs = TickRing(std::size_t{4} * k_input_window_ticks, info.input_bytes);
  hashes = HashRing(config.history_ticks);
  snapshots = TickRing(keeps && !predicts() ? config.snapshot_ticks : 0, snapshot_bytes);
  dump.resize(keeps ? snapshot_bytes : 0);
  entry.resize(keeps ? snapshot_bytes : 0);
  if (!predicts()) return;
  const std::size_t guessed = std::size_t{config.prediction_ticks} + 2;
  states = TickRing((keeps ? config.snapshot_ticks : 0) + guessed,
                    simulation->snapshot_bytes_max(SnapshotKind::native));
  guesses = TickRing(guessed, shape.record_bytes());
  guess_hashes.resize(guessed);
}

bool Client::Impl::on_welcome(ByteView packet) {
  Welcome welcome;
  if (decode(packet, welcome) != Status::ok) return false;
  if (state != ClientState::handshaking || simulation == nullptr) return false;
  if (welcome.player_count != info.player_count) return false;
  if (welcome.entry == Entry::lobby && stepped > 0) return false;
  seat = welcome;
  seated = true;
  rejoin_key = welcome.rejoin_key;
  lead = LeadControl(config.max_lead_ticks);
  sampled = std::max<std::uint64_t>(sampled, seat.input_delay_ticks);
  inputs_acked = sampled;
  state = welcome.entry == Entry::lobby ? ClientState::lobby : ClientState::joining;
  observer->joined(seat.slot);
  if (welcome.entry == Entry::ticks) begin_running(stepped);
  return true;
}

bool Client::Impl::on_refuse(ByteView packet) {
  Refuse refuse;
  if (decode(packet, refuse) != Status::ok || state != ClientState::handshaking) return false;
  refusal = {refuse.reason, refuse.field, refuse.here, refuse.there};
  hang_up(ClientState::refused, LeaveReason::left);
  return true;
}

void Client::Impl::connection_ended(RefuseReason reason) {
  const bool refused = reason != RefuseReason::none && !seated;
  if (!refused) return fail(ClientFailure::connection_lost);
  refusal = {reason, RefuseField::none, 0, 0};
  hang_up(ClientState::refused, LeaveReason::left);
}

bool Client::Impl::on_start(ByteView packet) {
  Start start;
  if (decode(packet, start) != Status::ok || state != ClientState::lobby) return false;
  begin_running(0);
  const bool plays = seat.slot < k_max_players;
  if (plays && ((start.present_mask >> seat.slot) & 1) != 0) active_tick = 0;
  present_mask = start.present_mask;
  observer->match_started();
  return true;
}

bool Client::Impl::on_desync(ByteView packet) {
  DesyncNotice notice;
  if (decode(packet, notice) != Status::ok || state != ClientState::running) return false;
  DesyncReport report;
  report.tick = notice.tick;
  report.slot = notice.slot;
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
  observer->desync_reported(report);
  return true;
}

bool Client::Impl::on_finish(ByteView packet) {
  Finish finish;
  if (decode(packet, finish) != Status::ok || !seated) return false;
  const bool played =
      finish.reason == FinishReason::completed || finish.reason == FinishReason::stopped;
  over = true;
  if (played && state == ClientState::running) step_rest();
  finish_reason = finish.reason;
  hang_up(ClientState::finished, LeaveReason::match_over);
  observer->match_finished(finish.reason, finish.ticks);
  return true;
}

bool Client::Impl::on_bye(ByteView packet) {
  Bye bye;
  if (decode(packet, bye) != Status::ok) return false;
  leave_reason = bye.reason;
  fail(ClientFailure::dropped);
  return true;
}

void Client::Impl::fail(ClientFailure why) {
  failure = why;
  hang_up(ClientState::failed, LeaveReason::left);
}

void Client::Impl::hang_up(ClientState final_state, LeaveReason reason) {
  stats = current_stats();
  state = final_state;
  send(Bye{reason});
  parts.transport->disconnect(parts.connection);
}

ClientStats Client::Impl::current_stats() const {
  ClientStats current = stats;
  if (!active()) return current;
  const TransportStats traffic = parts.transport->stats(parts.connection);
  current.bytes_sent = traffic.bytes_sent;
  current.bytes_received = traffic.bytes_received;
  current.packets_sent = traffic.packets_sent;
  current.packets_received = traffic.packets_received;
  current.round_trip_us = traffic.round_trip_us;
  current.margin_quarters = lead.last_margin();
  current.lead_ticks = lead.lead_ticks();
  current.rate_trim_ppm = lead.trim_ppm();
  current.jitter_us = playout.depth_us();
  return current;
}

void ClientObserver::joined(std::uint8_t) {}
void ClientObserver::match_started() {}
void ClientObserver::tick_stepped(std::uint64_t, std::span<const PlayerInput>, std::uint64_t) {}
void ClientObserver::server_silent(std::int64_t) {}
void ClientObserver::desync_reported(const DesyncReport&) {}
void ClientObserver::match_finished(FinishReason, std::uint64_t) {}
void ClientObserver::state_loaded(std::uint64_t) {}
void ClientObserver::player_active(std::uint8_t, std::uint64_t) {}
void ClientObserver::pause_changed(bool) {}
void ClientObserver::input_replaced(std::uint64_t) {}
void ClientObserver::tick_predicted(std::uint64_t, std::span<const PlayerInput>) {}
void ClientObserver::rolled_back(std::uint64_t, std::uint64_t) {}

}  // namespace lockstone::net
