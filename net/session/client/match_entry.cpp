#include "net/session/client/match_entry.h"

#include <algorithm>
#include <span>

#include <lockstone/assert.h>

namespace lockstone::net {

void MatchEntry::begin(std::uint64_t ticks) {
  const std::int64_t now_us = data_.status.now_us;
  data_.status.state = ClientState::running;
  data_.progress.stepped = ticks;
  data_.ticks.restart(ticks, now_us);
  data_.commands.clear();
  data_.progress.hashes.restart(ticks);
  data_.progress.hashes_acknowledged = ticks;
  sender_.restart(ticks);
  data_.playout = PlayoutClock(data_.game.info.tick_rate);
  data_.progress.news = true;
  prediction_.restart(ticks);
}

bool MatchEntry::on_start(ByteView packet) {
  Start start;
  if (decode(packet, start) != Status::ok) return false;
  if (data_.status.state != ClientState::lobby) return false;
  begin(0);
  ClientPlace& place = data_.place;
  if (has_slot(start.present_mask, place.welcome.slot)) place.active_tick = 0;
  place.present_mask = start.present_mask;
  data_.observer->match_started();
  return true;
}

bool MatchEntry::on_snapshot(ByteView packet) {
  Snapshot piece;
  if (decode(packet, piece) != Status::ok) return false;
  if (!data_.place.seated || piece.total_bytes > snapshot_.size()) return false;
  if (piece.offset_bytes == 0) {
    data_.status.state = ClientState::joining;
    data_.place.active_tick = ClientPlace::k_never;
    received_bytes_ = 0;
    ticks_ = piece.ticks;
  }
  const bool next = data_.status.state == ClientState::joining && piece.ticks == ticks_ &&
                    piece.offset_bytes == received_bytes_;
  if (!next) return false;
  LKS_ASSERT(received_bytes_ + piece.chunk.size() <= snapshot_.size());
  std::copy(piece.chunk.begin(), piece.chunk.end(),
            std::span(snapshot_).subspan(received_bytes_).begin());
  received_bytes_ += piece.chunk.size();
  if (received_bytes_ == piece.total_bytes) load(piece);
  return true;
}

void MatchEntry::load(const Snapshot& last_piece) {
  const ByteView bytes = ByteView(snapshot_).first(last_piece.total_bytes);
  Simulation& simulation = *data_.game.simulation;
  const bool good = simulation.load(SnapshotKind::canonical, bytes) == Status::ok &&
                    simulation.tick() == last_piece.ticks && simulation.hash() == last_piece.hash;
  received_bytes_ = 0;
  data_.server.send(SnapshotTaken{last_piece.ticks, good});
  if (!good) return;
  ++data_.stats.states_loaded;
  data_.ticks.clear(last_piece.ticks);
  // The match went back: a server that was started again has lost the last ticks.
  if (last_piece.ticks < data_.progress.stepped) data_.inputs.forget();
  data_.progress.state_hash = last_piece.hash;
  begin(last_piece.ticks);
  data_.observer->state_loaded(last_piece.ticks);
}

bool MatchEntry::on_activate(ByteView packet) {
  Activate message;
  if (decode(packet, message) != Status::ok || !data_.place.seated) return false;
  if (message.slot >= data_.game.info.player_count) return false;
  const bool own = message.slot == data_.place.welcome.slot;
  if (own && data_.status.state == ClientState::running) {
    data_.place.active_tick = message.tick;
    data_.inputs.activate(message.tick);
  }
  data_.observer->player_active(message.slot, message.tick);
  return true;
}

}  // namespace lockstone::net
