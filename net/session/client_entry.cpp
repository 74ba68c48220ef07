// Entering a match that runs: from a snapshot, or from the state that is still here.
#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/hash.h>

#include "net/session/client_impl.h"

namespace lockstone::net {

bool Client::Impl::may_reconnect() const {
  if (state == ClientState::refused) return refusal.reason == RefuseReason::handshake_timeout;
  if (state != ClientState::failed) return false;
  if (failure == ClientFailure::dropped) {
    return leave_reason == LeaveReason::disconnected || leave_reason == LeaveReason::timed_out ||
           leave_reason == LeaveReason::too_far_behind;
  }
  return failure == ClientFailure::connection_lost || failure == ClientFailure::server_silent ||
         failure == ClientFailure::handshake_timed_out;
}

bool Client::Impl::reconnect(ConnectionId connection) {
  const bool refused =
      state == ClientState::refused && refusal.reason == RefuseReason::handshake_timeout;
  if (state != ClientState::failed && !refused) return false;
  const bool lost = refused || failure == ClientFailure::connection_lost ||
                    failure == ClientFailure::server_silent ||
                    failure == ClientFailure::handshake_timed_out ||
                    failure == ClientFailure::dropped;
  if (!lost) return false;
  if (head > stepped) roll_back(stepped);
  parts.connection = connection;
  state = ClientState::connecting;
  failure = ClientFailure::none;
  refusal = {};
  watch = {};
  updated = false;
  seated = false;
  offered = false;
  paused = false;
  waiting = 0;
  entry_received = 0;
  dump_size = 0;
  active_tick = k_never;
  records.clear();  // a server that was started again may close other ticks
  received_end = 0;
  return true;
}

// The state here is one of the match that is offered.
bool Client::Impl::knows_state(ByteView offered_config) const {
  return simulation != nullptr && rejoin_key != 0 && offered_hash == hash64(offered_config);
}

// The simulation stands after `ticks` ticks, and the next one is to come.
void Client::Impl::begin_running(std::uint64_t ticks) {
  state = ClientState::running;
  stepped = ticks;
  head = ticks;
  received = ticks;
  received_end = std::max(received_end, ticks);
  gap_tick = ticks;
  gap_since_us = now_us;
  hashes.restart(ticks);
  hashes_acked = ticks;
  while (records.has(received))
    ++received;
  clock_us = 0;
  clock_set_us = now_us;
  clock_origin_us = 0;
  clock_tick = ticks;
  playout = PlayoutClock(info.tick_rate);
  news = true;
  keep_state();
}

bool Client::Impl::on_snapshot(ByteView packet) {
  Snapshot piece;
  if (decode(packet, piece) != Status::ok) return false;
  if (!seated || piece.total_bytes > entry.size()) return false;
  if (piece.offset_bytes == 0) {
    state = ClientState::joining;
    active_tick = k_never;
    entry_received = 0;
    entry_ticks = piece.ticks;
  }
  const bool next = state == ClientState::joining && piece.ticks == entry_ticks &&
                    piece.offset_bytes == entry_received;
  if (!next) return false;
  std::copy(piece.chunk.begin(), piece.chunk.end(),
            std::span(entry).subspan(entry_received).begin());
  entry_received += piece.chunk.size();
  if (entry_received == piece.total_bytes) take_snapshot(piece);
  return true;
}

void Client::Impl::take_snapshot(const Snapshot& last_piece) {
  const ByteView bytes = ByteView(entry).first(last_piece.total_bytes);
  const bool good = simulation->load(SnapshotKind::canonical, bytes) == Status::ok &&
                    simulation->tick() == last_piece.ticks && simulation->hash() == last_piece.hash;
  entry_received = 0;
  send(SnapshotTaken{last_piece.ticks, good});
  if (!good) return;
  ++stats.states_loaded;
  received_end = last_piece.ticks;
  records.clear();
  // The match went back: a server that was started again has lost the last ticks.
  if (last_piece.ticks < stepped) {
    sampled = 0;
    inputs_acked = 0;
  }
  state_hash = last_piece.hash;
  begin_running(last_piece.ticks);
  observer->state_loaded(last_piece.ticks);
}

bool Client::Impl::on_activate(ByteView packet) {
  Activate message;
  if (decode(packet, message) != Status::ok || !seated) return false;
  if (message.slot >= info.player_count) return false;
  if (message.slot == seat.slot && state == ClientState::running) {
    active_tick = message.tick;
    inputs_acked = message.tick;
    sampled = std::max(sampled, message.tick);
  }
  observer->player_active(message.slot, message.tick);
  return true;
}

bool Client::Impl::on_paused(ByteView packet) {
  Paused message;
  if (decode(packet, message) != Status::ok || !seated) return false;
  paused = message.paused;
  observer->pause_changed(paused);
  return true;
}

}  // namespace lockstone::net
