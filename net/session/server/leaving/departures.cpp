#include "net/session/server/leaving/departures.h"

namespace lockstone::net {

void Departures::connection_ended(Peer& peer, RefuseReason reason) {
  const std::uint8_t slot = peer.slot;
  const bool flooding = reason == RefuseReason::flooding;
  release(peer);
  if (!data_.roster.is_slot(slot)) return;
  lose_seat(slot, flooding ? LeaveReason::flooding : LeaveReason::disconnected);
}

// Forgets a connection without a word.
void Departures::release(Peer& peer) {
  if (data_.roster.is_slot(peer.slot)) {
    data_.roster.seat(peer.slot).stats = player_stats(data_, peer.slot);
  }
  data_.roster.forget(peer);
  peer = {};
}

void Departures::drop(Peer& peer, LeaveReason reason) {
  const std::uint8_t slot = peer.slot;
  data_.peers.tell(peer, Bye{reason});
  const ConnectionId connection = peer.connection;
  release(peer);
  data_.parts.transport->disconnect(connection);
  if (data_.roster.is_slot(slot)) lose_seat(slot, reason);
}

void Departures::expel(std::uint8_t slot, LeaveReason reason) {
  Seat& seat = data_.roster.seat(slot);
  if (!seat.expelled) ++data_.counters.expelled;
  seat.expelled = true;
  data_.offenders.ban(seat.identity, slot);
  seat.rejoin_key = 0;
  if (seat.peer != nullptr) drop(*seat.peer, reason);
}

void Departures::refuse(Peer& peer, const Refusal& refusal) {
  data_.peers.tell(peer, Refuse{refusal.reason, refusal.field, refusal.here, refusal.there});
  const ConnectionId connection = peer.connection;
  release(peer);
  data_.parts.transport->disconnect(connection);
  ++data_.counters.refused[static_cast<std::size_t>(refusal.reason)];
  data_.observer->player_refused(refusal);
}

void Departures::lose_seat(std::uint8_t slot, LeaveReason reason) {
  const MatchStatus& match = data_.match;
  if (match.state >= ServerState::closing) return;
  data_.judge.set_present(slot, false);
  Seat& seat = data_.roster.seat(slot);
  seat.active_tick = k_never;
  const bool may_return = reason == LeaveReason::disconnected || reason == LeaveReason::timed_out ||
                          reason == LeaveReason::too_far_behind;
  // A client that was lost before it heard of its key cannot show it.
  if (!may_return || match.state == ServerState::lobby || !seat.confirmed) seat.rejoin_key = 0;
  const bool reserved = seat.rejoin_key != 0;
  seat.reserved_until_us = match.now_us + (reserved ? data_.config.timeouts.rejoin_us : 0);
  cases_.give_up_on(slot);
  ++data_.counters.left[static_cast<std::size_t>(reason)];
  data_.observer->player_left(slot, reason);
  end_.finish_if_deserted();
}

void Departures::note_malformed(Peer& peer) {
  const bool too_many = peer.watch.malformed(data_.match.now_us);
  ++data_.counters.malformed_packets;
  const bool seated = data_.roster.is_slot(peer.slot);
  if (seated) ++data_.roster.seat(peer.slot).stats.malformed_packets;
  if (!too_many) return;
  // Without encryption the packets may be anybody's.
  if (seated && peer.identity.authenticated) return expel(peer.slot, LeaveReason::malformed);
  drop(peer, LeaveReason::malformed);
}

void Departures::drop_silent() {
  const std::int64_t now_us = data_.match.now_us;
  const Timeouts& timeouts = data_.config.timeouts;
  for (Peer& peer : data_.peers.all()) {
    if (peer.stage == Stage::unused) continue;
    if (!peer.is_admitted()) {
      if (now_us - peer.since_us > timeouts.handshake_us) {
        refuse(peer, {RefuseReason::handshake_timeout, RefuseField::none, 0, 0});
      }
      continue;
    }
    const std::int64_t silent_us = peer.watch.silent_us(now_us);
    const bool warns = peer.watch.warn(now_us, timeouts.silence_warning_us);
    if (warns && peer.stage == Stage::seated) data_.observer->player_silent(peer.slot, silent_us);
    if (silent_us > timeouts.drop_us) drop(peer, LeaveReason::timed_out);
  }
}

void Departures::close_all() {
  const MatchStatus& match = data_.match;
  const bool timed_out = match.now_us - match.state_since_us > data_.config.timeouts.finish_us;
  bool anybody = false;
  for (Peer& peer : data_.peers.all()) {
    if (peer.stage == Stage::unused) continue;
    if (peer.is_admitted() && !timed_out) {
      anybody = true;
    } else {
      drop(peer, LeaveReason::match_over);
    }
  }
  if (!anybody) data_.match.state = ServerState::over;
}

}  // namespace lockstone::net
