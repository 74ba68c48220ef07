// The server's connections, its time-outs, and the end of a match.
#include <algorithm>
#include <limits>

#include <lockstone/assert.h>

#include "net/session/server_impl.h"
#include "net/session/setup.h"

namespace lockstone::net {
namespace {

constexpr std::size_t k_spare_links = 4;  // for those who are refused
constexpr std::uint32_t k_max_spectators = 256;
constexpr std::uint32_t k_max_spectator_delay_s = 180;
constexpr std::size_t k_input_ring_ticks = 4 * k_input_window_ticks;

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

std::size_t snapshot_bytes(const Simulation* simulation) {
  return simulation == nullptr ? 0 : simulation->snapshot_bytes_max(SnapshotKind::canonical);
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
  return impl_->state;
}
FinishReason Server::finish_reason() const {
  return impl_->finish_reason;
}
std::uint64_t Server::ticks_closed() const {
  return impl_->closed;
}
std::uint16_t Server::present_mask() const {
  return impl_->present_mask();
}
std::uint16_t Server::waiting_mask() const {
  return impl_->waiting;
}
PlayerStats Server::stats(std::uint8_t slot) const {
  return impl_->stats_of(slot);
}

bool Server::paused() const {
  return impl_->paused;
}
void Server::pause() {
  impl_->set_paused(true);
}
void Server::resume() {
  impl_->set_paused(false);
}
const ServerCounters& Server::counters() const {
  return impl_->counters;
}
ConnectionCounts Server::connections() const {
  return impl_->connections();
}
std::size_t Server::spectators() const {
  return static_cast<std::size_t>(
      std::count_if(impl_->watchers.begin(), impl_->watchers.end(),
                    [](const auto& watcher) { return watcher.link != nullptr; }));
}

void Server::stop() {
  if (impl_->state > ServerState::running) return;
  impl_->finish_reason = FinishReason::stopped;
  impl_->end_tick = impl_->closed;
  impl_->begin_finishing();
}

Server::Impl::Impl(const ServerConfig& server_config, const ServerParts& server_parts)
    : config(server_config),
      parts(server_parts),
      observer(parts.observer == nullptr ? &silent_observer : parts.observer),
      info(parts.simulation == nullptr ? config.info : parts.simulation->info()),
      shape{info.player_count, info.input_bytes},
      tick_us(1'000'000 / info.tick_rate),
      links(info.player_count + config.max_spectators + k_spare_links),
      seats(info.player_count),
      watchers(config.max_spectators),
      end_tick(config.tick_count == 0 ? k_max_tick : config.tick_count),
      records(config.history_ticks, shape.record_bytes()),
      snapshots(parts.simulation == nullptr ? 0 : config.snapshot_ticks,
                snapshot_bytes(parts.simulation)),
      judge(info.player_count, config.history_ticks, parts.simulation != nullptr),
      parts_judge(parts.simulation != nullptr),
      out(k_max_message_bytes) {
  for (Seat& place : seats)
    place.inputs = TickRing(k_input_ring_ticks, info.input_bytes);
  if (parts.simulation == nullptr) return;
  entry.bytes.resize(snapshot_bytes(parts.simulation));
  if (config.max_spectators > 0 && config.spectator_delay_ticks > 0) {
    const std::size_t count = config.spectator_delay_ticks / keyframe_ticks_of(config) + 4;
    keyframes = TickRing(count, entry.bytes.size());
    keyframe_hashes.resize(count);
  }
}

// As if it had closed all ticks so far, and lost all players.
void Server::Impl::resume() {
  closed = parts.simulation->tick();
  judge.begin_after(closed, parts.simulation->hash());
  awaited = *config.resume_mask;
  state = ServerState::running;
  expected_until_us = now_us + config.timeouts.rejoin_us;
}

// Not for long: from the first one on that is back, the others have as long as a lost one.
bool Server::Impl::awaits_players() {
  if (awaited == 0) return false;
  unsigned back = 0;
  for (std::size_t slot = 0; slot < seats.size(); ++slot)
    back |= seats[slot].link != nullptr && seats[slot].active_tick != k_never ? 1U << slot : 0U;
  if (back != 0 && first_back_us < 0) first_back_us = now_us;
  const bool enough = first_back_us >= 0 && now_us - first_back_us > config.timeouts.drop_us;
  if (enough || (back & awaited) == awaited) awaited = 0;
  if (awaited == 0) rebase_schedule(now_us);
  return awaited != 0;
}

void Server::Impl::update(std::int64_t now) {
  LKS_ASSERT(now >= now_us);
  if (state == ServerState::over) return;
  now_us = now;
  if (config.resume_mask && state == ServerState::lobby) resume();
  receive();
  watch_peers();
  end_if_deserted();
  if (state == ServerState::lobby) try_start();
  if (state == ServerState::running) {
    drop_secretive();
    close_due_ticks();
    advance_entries();
  }
  judge_hashes();
  advance_cases();
  if (state == ServerState::finishing) try_finish();
  if (state == ServerState::closing) try_end();
  send_due_ticks();
  serve_spectators();
  parts.transport->flush();
}

void Server::Impl::receive() {
  TransportEvent event;
  while (parts.transport->poll(now_us, event)) {
    if (event.kind == TransportEventKind::connected) {
      accept(event.connection);
      continue;
    }
    Link* link = find_link(event.connection);
    if (link == nullptr) continue;
    if (event.kind == TransportEventKind::received) {
      receive_packet(*link, event);
    } else {
      const std::uint8_t slot = link->slot;
      const bool flooding = event.reason == RefuseReason::flooding;
      release(*link);
      if (slot < seats.size()) {
        seat_lost(slot, flooding ? LeaveReason::flooding : LeaveReason::disconnected);
      }
    }
  }
}

void Server::Impl::receive_packet(Link& link, const TransportEvent& event) {
  link.watch.heard(now_us);
  if (dispatch(link, event.bytes)) return;
  const bool too_many = link.watch.malformed(now_us);
  ++counters.malformed_packets;
  const bool seated = link.slot < seats.size();
  if (seated) ++seats[link.slot].stats.malformed_packets;
  if (!too_many) return;
  // Without encryption the packets may be anybody's.
  if (seated && link.identity.authenticated) return expel(link.slot, LeaveReason::malformed);
  drop(link, LeaveReason::malformed);
}

// False for a packet that breaks the format or comes out of turn; then it had no effect at all.
bool Server::Impl::dispatch(Link& link, ByteView packet) {
  const Result<MessageType> type = message_type(packet);
  if (!type) return refuse_secure_hello(link, packet);
  Bye bye;
  switch (type.value()) {
    case MessageType::hello:
      return link.stage == Stage::connected && on_hello(link, packet);
    case MessageType::answer:
      return link.stage == Stage::offered && on_answer(link, packet);
    case MessageType::inputs:
      return link.stage >= Stage::seated && on_inputs(link, packet);
    case MessageType::resend:
      return link.stage >= Stage::seated && on_resend(link, packet);
    case MessageType::dump:
      return link.stage == Stage::seated && on_dump(link, packet);
    case MessageType::snapshot_taken:
      return link.stage >= Stage::seated && on_snapshot_taken(link, packet);
    case MessageType::parts:
      return link.stage == Stage::seated && on_parts(link, packet);
    case MessageType::ask:
      return link.stage == Stage::seated && on_ask(link, packet);
    case MessageType::bye:
      if (decode(packet, bye) != Status::ok) return false;
      drop(link, LeaveReason::left);
      return true;
    default:
      return false;
  }
}

void Server::Impl::watch_peers() {
  for (Link& link : links) {
    if (link.stage == Stage::unused) continue;
    if (link.stage < Stage::seated) {
      if (now_us - link.since_us > config.timeouts.handshake_us) {
        refuse(link, {RefuseReason::handshake_timeout, RefuseField::none, 0, 0});
      }
      continue;
    }
    const std::int64_t silent_us = link.watch.silent_us(now_us);
    const bool warns = link.watch.warn(now_us, config.timeouts.silence_warning_us);
    if (warns && link.stage == Stage::seated) {
      observer->player_silent(link.slot, silent_us);
    }
    if (silent_us > config.timeouts.drop_us) drop(link, LeaveReason::timed_out);
  }
}

// Forgets a connection without a word.
void Server::Impl::release(Link& link) {
  if (link.slot < seats.size()) {
    PlayerStats& stats = seats[link.slot].stats;
    stats = stats_of(link.slot);
    seats[link.slot].link = nullptr;
  }
  for (Watcher& watcher : watchers) {
    if (watcher.link == &link) watcher.link = nullptr;
  }
  link = {};
}

void Server::Impl::drop(Link& link, LeaveReason reason) {
  const std::uint8_t slot = link.slot;
  send(link, Bye{reason});
  const ConnectionId connection = link.connection;
  release(link);
  parts.transport->disconnect(connection);
  if (slot < seats.size()) seat_lost(slot, reason);
}

// It does not come back to this match.
void Server::Impl::expel(std::uint8_t slot, LeaveReason reason) {
  Seat& place = seats[slot];
  if (!place.expelled) ++counters.expelled;
  place.expelled = true;
  offenders.bar(place.identity, slot);
  place.rejoin_key = 0;
  if (place.link != nullptr) drop(*place.link, reason);
}

void Server::Impl::seat_lost(std::uint8_t slot, LeaveReason reason) {
  if (state >= ServerState::closing) return;
  judge.set_present(slot, false);
  Seat& place = seats[slot];
  place.active_tick = k_never;
  const bool may_return = reason == LeaveReason::disconnected || reason == LeaveReason::timed_out ||
                          reason == LeaveReason::too_far_behind;
  // A client that was lost before it heard of its key cannot show it.
  if (!may_return || state == ServerState::lobby || !place.confirmed) place.rejoin_key = 0;
  place.reserved_until_us = place.rejoin_key == 0 ? now_us : now_us + config.timeouts.rejoin_us;
  for (DesyncCase& found : cases) {
    for (DumpTransfer* transfer : {&found.here, &found.there}) {
      if (transfer->slot == slot && !transfer->done) *transfer = {slot, {}, 0, true, now_us};
    }
  }
  ++counters.left[static_cast<std::size_t>(reason)];
  observer->player_left(slot, reason);
  end_if_deserted();
}

// Nobody plays, and nobody is expected back.
void Server::Impl::end_if_deserted() {
  const bool playing = state == ServerState::running || state == ServerState::finishing;
  if (!playing || !cases.empty() || present_mask() != 0) return;
  const bool running = state == ServerState::running;
  const bool expected = std::any_of(seats.begin(), seats.end(), [this](const Seat& place) {
    return now_us < place.reserved_until_us;
  });
  if (running && (expected || now_us < expected_until_us)) return;
  finish(running ? FinishReason::no_players : finish_reason);
}

void Server::Impl::begin_finishing() {
  const bool began = state == ServerState::running;
  state = ServerState::finishing;
  state_since_us = now_us;
  waiting = 0;
  if (!began) finish(finish_reason);
}

// Waits for everybody's last hash, so that a difference in the last tick is found too.
void Server::Impl::try_finish() {
  const bool all_judged = judge.judged_ticks() >= closed;
  const bool timed_out = now_us - state_since_us > config.timeouts.finish_us;
  const bool complete = cases.empty() && all_judged;
  if (frozen() || (!complete && !timed_out)) return;
  finish(finish_reason);
}

void Server::Impl::finish(FinishReason reason) {
  if (state >= ServerState::closing) return;
  while (!cases.empty())
    static_cast<void>(report_case());
  finish_reason = reason;
  state = ServerState::closing;
  state_since_us = now_us;
  waiting = 0;
  const std::optional<std::uint64_t> hash = final_hash();
  for (const Seat& place : seats) {
    if (place.link != nullptr) {
      send(*place.link, Finish{reason, closed, hash.has_value(), hash.value_or(0)});
    }
  }
  observer->match_finished(reason, closed, hash);
}

// The clients leave; those that do not are left.
void Server::Impl::try_end() {
  const bool timed_out = now_us - state_since_us > config.timeouts.finish_us;
  bool anybody = false;
  for (Link& link : links) {
    if (link.stage == Stage::unused) continue;
    if (link.stage >= Stage::seated && !timed_out) {
      anybody = true;
    } else {
      drop(link, LeaveReason::match_over);
    }
  }
  if (!anybody) state = ServerState::over;
}

Server::Impl::Link* Server::Impl::find_link(ConnectionId connection) {
  const auto found = std::find_if(links.begin(), links.end(), [connection](const Link& link) {
    return link.stage != Stage::unused && link.connection == connection;
  });
  return found == links.end() ? nullptr : &*found;
}

std::uint16_t Server::Impl::present_mask() const {
  unsigned mask = 0;
  for (std::size_t slot = 0; slot < seats.size(); ++slot) {
    if (seats[slot].link != nullptr) mask |= 1U << slot;
  }
  return static_cast<std::uint16_t>(mask);
}

PlayerStats Server::Impl::stats_of(std::uint8_t slot) const {
  if (slot >= seats.size()) misused("Server: the slot must be below the player count");
  PlayerStats stats = seats[slot].stats;
  stats.hashes_compared = judge.compared(slot);
  stats.hashes_equal = judge.equal(slot);
  stats.parts_equal = parts_judge.equal(slot);
  if (seats[slot].link == nullptr) return stats;
  const TransportStats traffic = parts.transport->stats(seats[slot].link->connection);
  stats.bytes_sent = traffic.bytes_sent;
  stats.bytes_received = traffic.bytes_received;
  stats.packets_sent = traffic.packets_sent;
  stats.packets_received = traffic.packets_received;
  stats.round_trip_us = traffic.round_trip_us;
  return stats;
}

ConnectionCounts Server::Impl::connections() const {
  ConnectionCounts counts;
  for (const Link& link : links) {
    const bool condemned = link.stage == Stage::seated && seats[link.slot].condemned;
    if (link.stage == Stage::connected || link.stage == Stage::offered) ++counts.greeting;
    if (link.stage == Stage::seated && !condemned) ++counts.players;
    if (condemned) ++counts.condemned;
    if (link.stage == Stage::watching) ++counts.spectators;
  }
  return counts;
}

std::optional<std::uint64_t> Server::Impl::final_hash() const {
  if (closed == 0 || judge.right_hash_ticks() != closed) return std::nullopt;
  return judge.right_hash(closed - 1);
}

void ServerObserver::tick_closed(std::uint64_t, std::span<const PlayerInput>,
                                 std::optional<std::uint64_t>) {}
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
