// The calls of a server, and the order in which its parts act in an update.
#include <algorithm>

#include <lockstone/assert.h>

#include "net/session/server/server_impl.h"
#include "net/session/setup.h"

namespace lockstone::net {
namespace {

constexpr std::uint32_t k_max_spectators = 256;
constexpr std::uint32_t k_max_spectator_delay_s = 180;

// Ticks that a delayed spectator may lack are still there.
bool spectators_fit(const ServerConfig& config, std::uint32_t tick_rate) {
  if (config.max_spectators == 0) return true;
  if (config.max_spectators > k_max_spectators) return false;
  if (config.spectator_delay_ticks > k_max_spectator_delay_s * tick_rate) return false;
  const std::uint64_t lack = std::uint64_t{config.spectator_delay_ticks} +
                             config.spectator_queue_ticks + 2 * keyframe_ticks_of(config);
  return config.entry_bytes_per_s > 0 && lack < config.history_ticks;
}

SetupError check(const ServerConfig& config, const SimulationInfo& info) {
  if (config.match_config.size() > k_max_config_bytes) return SetupError::match_config_too_long;
  if (config.input_delay_ticks > k_max_input_delay_ticks) {
    return SetupError::input_delay_out_of_range;
  }
  if (config.tick_count > k_max_tick) return SetupError::history_out_of_range;
  const SetupError info_error = check_info(info);
  if (info_error != SetupError::none) return info_error;
  if (!spectators_fit(config, info.tick_rate)) return SetupError::spectators_out_of_range;
  return check_common(config.history_ticks, config.snapshot_ticks, config.timeouts);
}

}  // namespace

Server::Created Server::create(const ServerConfig& config, const ServerParts& parts) {
  if (parts.transport == nullptr) misused("Server::create: ServerParts::transport is null");
  const bool simulates = parts.simulation != nullptr;
  SetupError error = check_security(config.insecure, *parts.transport);
  if (error != SetupError::none) return {nullptr, error};
  error = check(config, simulates ? parts.simulation->info() : config.info);
  if (error != SetupError::none) return {nullptr, error};
  const bool stepped = simulates && parts.simulation->tick() != 0;
  if (stepped != config.resume_mask.has_value()) {
    return {nullptr, SetupError::simulation_already_stepped};
  }
  return {std::unique_ptr<Server>(new Server(std::make_unique<Impl>(config, parts))),
          SetupError::none};
}

Server::Server(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}
Server::~Server() = default;
void Server::update(std::int64_t now_us) {
  impl_->update(now_us);
}
ServerState Server::state() const {
  return impl_->data.match.state;
}
FinishReason Server::finish_reason() const {
  return impl_->data.match.finish_reason;
}
std::uint64_t Server::ticks_confirmed() const {
  return impl_->data.match.confirmed;
}
SlotMask Server::present_mask() const {
  return impl_->data.roster.present_mask();
}
SlotMask Server::waiting_mask() const {
  return impl_->data.match.waiting;
}
PlayerStats Server::stats(std::uint8_t slot) const {
  return player_stats(impl_->data, slot);
}
std::string_view Server::player_name(std::uint8_t slot) const {
  if (!impl_->data.roster.is_slot(slot)) misused("Server: the slot must be below the player count");
  return impl_->data.roster.seat(slot).name.view();
}
bool Server::paused() const {
  return impl_->data.match.paused;
}
void Server::pause() {
  impl_->set_paused(true);
}
void Server::resume() {
  impl_->set_paused(false);
}
Status Server::send_command(ByteView bytes) {
  return impl_->taking.commands.give(bytes);
}
void Server::stop() {
  impl_->stop();
}
const ServerCounters& Server::counters() const {
  return impl_->data.counters;
}
ConnectionCounts Server::connections() const {
  return connection_counts(impl_->data);
}
std::size_t Server::spectators() const {
  return impl_->data.roster.watching();
}

Server::Impl::Impl(const ServerConfig& config, const ServerParts& parts)
    : data(config, parts),
      dumps(data),
      cases(data, dumps),
      end(data, cases),
      departures(data, cases, end),
      states(data, dumps, cases),
      entry(data, states, departures),
      sending(data),
      spectators(data, {states, entry, sending.ticks, departures}),
      admission(data, departures, entry, spectators),
      response(data, {dumps, cases, states, entry, departures, end}),
      comparison(data, cases, response),
      taking(data),
      laggards(data, states, departures),
      confirmer(data, {cases, states, taking.inputs, taking.commands, laggards, end}) {}

void Server::Impl::update(std::int64_t now_us) {
  MatchStatus& match = data.match;
  LKS_ASSERT(now_us >= match.now_us);
  if (match.state == ServerState::over) return;
  match.now_us = now_us;
  if (data.config.resume_mask && match.state == ServerState::lobby) confirmer.resume();
  receive();
  departures.drop_silent();
  end.finish_if_deserted();
  if (match.state == ServerState::lobby) admission.try_start();
  if (match.state == ServerState::running) {
    laggards.drop_without_hashes();
    confirmer.advance();
    entry.advance();
  }
  comparison.advance();
  response.advance();
  if (match.state == ServerState::finishing) end.try_finish();
  if (match.state == ServerState::closing) departures.close_all();
  sending.ticks.send_to_players();
  sending.commands.send();
  spectators.serve();
  data.parts.transport->flush();
}

void Server::Impl::stop() {
  MatchStatus& match = data.match;
  if (match.state > ServerState::running) return;
  match.finish_reason = FinishReason::stopped;
  match.end_tick = match.confirmed;
  end.begin_finishing();
}

void Server::Impl::set_paused(bool paused) {
  MatchStatus& match = data.match;
  if (match.state > ServerState::running || paused == match.paused) return;
  match.paused = paused;
  match.waiting = 0;
  if (match.state == ServerState::running) {
    data.schedule.rebase(match.confirmed, match.now_us + data.tick_us);
  }
  data.peers.send_to_admitted(Paused{paused});
}

void Server::Impl::receive() {
  TransportEvent event;
  while (data.parts.transport->poll(data.match.now_us, event)) {
    if (event.kind == TransportEventKind::connected) {
      admission.accept(event.connection);
      continue;
    }
    Peer* peer = data.peers.find(event.connection);
    if (peer == nullptr) continue;
    if (event.kind == TransportEventKind::received) {
      receive_packet(*peer, event.bytes);
    } else {
      departures.connection_ended(*peer, event.reason);
    }
  }
}

void Server::Impl::receive_packet(Peer& peer, ByteView packet) {
  peer.watch.heard(data.match.now_us);
  if (!dispatch(peer, packet)) departures.note_malformed(peer);
}

// False for a packet that breaks the format or comes out of turn; then it had no effect at all.
bool Server::Impl::dispatch(Peer& peer, ByteView packet) {
  const Result<MessageType> type = message_type(packet);
  if (!type) return admission.refuse_secure_hello(peer, packet);
  switch (type.value()) {
    case MessageType::hello:
      return peer.stage == Stage::connected && admission.on_hello(peer, packet);
    case MessageType::answer:
      return peer.stage == Stage::offered && admission.on_answer(peer, packet);
    case MessageType::inputs:
      return peer.is_admitted() && taking.inputs.on_inputs(peer, packet);
    case MessageType::resend:
      return peer.is_admitted() && sending.ticks.on_resend(peer, packet);
    case MessageType::dump:
      return peer.stage == Stage::seated && on_dump(peer, packet);
    case MessageType::snapshot_taken:
      return peer.is_admitted() && entry.on_snapshot_taken(peer, packet);
    case MessageType::parts:
      return peer.stage == Stage::seated && comparison.on_parts(peer, packet);
    case MessageType::command:
      return peer.stage == Stage::seated && taking.commands.on_command(peer, packet);
    case MessageType::ask:
      return peer.stage == Stage::seated && on_ask(peer, packet);
    case MessageType::bye:
      return on_bye(peer, packet);
    default:
      return false;
  }
}

// More than was asked for is malformed. A late packet is only ignored.
bool Server::Impl::on_dump(const Peer& peer, ByteView packet) {
  Dump dump;
  if (decode(packet, dump) != Status::ok) return false;
  if (!DumpRequests::admit(data.roster.seat(peer.slot), dump)) return false;
  DumpTransfer* transfer = states.transfer_of(peer.slot, dump.tick);
  if (transfer == nullptr) transfer = cases.transfer_of(peer.slot, dump.tick);
  return transfer == nullptr || transfer->append(dump, dumps.limit_bytes());
}

bool Server::Impl::on_ask(const Peer& peer, ByteView packet) {
  Ask ask;
  if (decode(packet, ask) != Status::ok) return false;
  const bool plays = !data.roster.seat(peer.slot).condemned;
  if (plays && data.match.state <= ServerState::running) {
    data.observer->player_asks(peer.slot, ask.kind, ask.topic, ask.choice);
  }
  return true;
}

bool Server::Impl::on_bye(Peer& peer, ByteView packet) {
  Bye bye;
  if (decode(packet, bye) != Status::ok) return false;
  departures.drop(peer, LeaveReason::left);
  return true;
}

void ServerObserver::tick_confirmed(std::uint64_t, std::span<const PlayerInput>,
                                    std::optional<std::uint64_t>) {}
void ServerObserver::commands_confirmed(std::uint64_t, std::span<const PlayerCommand>) {}
void ServerObserver::hash_agreed(std::uint64_t, std::uint64_t) {}
void ServerObserver::player_joined(std::uint8_t, std::string_view) {}
void ServerObserver::player_left(std::uint8_t, LeaveReason) {}
void ServerObserver::player_silent(std::uint8_t, std::int64_t) {}
void ServerObserver::player_refused(const Refusal&) {}
void ServerObserver::desync_found(const DesyncReport&) {}
void ServerObserver::match_started() {}
void ServerObserver::player_active(std::uint8_t, std::uint64_t) {}
void ServerObserver::player_asks(std::uint8_t, AskKind, std::uint8_t, std::uint8_t) {}
void ServerObserver::match_finished(FinishReason, std::uint64_t, std::optional<std::uint64_t>) {}

}  // namespace lockstone::net
