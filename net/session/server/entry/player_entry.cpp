#include "net/session/server/entry/player_entry.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

constexpr unsigned k_max_bad_snapshots = 3;
constexpr std::uint64_t k_max_round_trip_ticks = 30;

}  // namespace

void PlayerEntry::begin(std::uint8_t slot, const Peer& peer) {
  Seat& seat = data_.roster.seat(slot);
  LKS_ASSERT(seat.peer == &peer && data_.match.state != ServerState::lobby);
  ++seat.stats.entries;
  seat.active_tick = k_never;
  seat.inputs_next = 0;
  seat.margin = k_no_margin;
  const std::uint64_t confirmed = data_.match.confirmed;
  const std::uint64_t has = peer.ticks_stepped;
  const bool ticks_alone = has <= confirmed && confirmed - has < data_.config.history_ticks / 2 &&
                           (has == confirmed || data_.records.has(has)) && has_right_state(peer);
  data_.peers.tell(peer, welcome_of(data_, slot, ticks_alone ? Entry::ticks : Entry::snapshot));
  if (ticks_alone) {
    seat.ticks_received = has;
    data_.judge.restart(slot, has);
  } else {
    seat.await_state(0);
  }
  if (data_.match.paused) data_.peers.tell(peer, Paused{true});
}

// Not a state that was wrong, nor one of ticks that a server confirmed which was killed before it
// had them in its log. A relay that knows no better believes the client.
bool PlayerEntry::has_right_state(const Peer& peer) const {
  if (peer.ticks_stepped == 0) return true;
  const std::uint64_t last = peer.ticks_stepped - 1;
  if (!data_.judge.right().knows(last)) return !data_.simulates();
  return data_.judge.right().at(last) == peer.state_hash;
}

void PlayerEntry::resync(std::uint8_t slot) {
  Seat& seat = data_.roster.seat(slot);
  seat.condemned = false;
  ++data_.counters.resyncs;
  seat.await_state(data_.match.confirmed);
}

void PlayerEntry::advance() {
  states_.advance();
  for (std::uint8_t slot = 0; slot < data_.roster.seats().size(); ++slot) {
    Seat& seat = data_.roster.seat(slot);
    if (seat.peer == nullptr || seat.condemned) continue;
    if (seat.loading && !seat.offered) states_.offer(seat, slot);
    if (seat.loading && seat.offered) states_.send_pieces(seat);
    if (!seat.loading && seat.active_tick == k_never) try_activate(slot);
  }
}

bool PlayerEntry::on_snapshot_taken(Peer& peer, ByteView packet) {
  SnapshotTaken message;
  if (decode(packet, message) != Status::ok) return false;
  Follower* follower = data_.roster.follower_of(peer);
  if (follower == nullptr || !follower->offered) return false;
  if (message.ticks != follower->ticks_received) return true;  // an earlier one
  follower->offered = false;
  if (message.good) {
    follower->loading = false;
    return true;
  }
  const std::uint64_t better_ticks = states_.reject();
  if (++follower->bad_snapshots < k_max_bad_snapshots) {
    follower->await_state(better_ticks);
  } else if (data_.simulates() && data_.roster.is_slot(peer.slot)) {
    departures_.expel(peer.slot, LeaveReason::desync);
  } else {
    departures_.drop(peer, LeaveReason::desync);
  }
  return true;
}

// Caught up: there will be time for its first input to arrive.
void PlayerEntry::try_activate(std::uint8_t slot) {
  Seat& seat = data_.roster.seat(slot);
  const std::uint64_t confirmed = data_.match.confirmed;
  LKS_ASSERT(seat.ticks_received <= confirmed);
  const std::uint64_t lag = std::max<std::uint64_t>(data_.info.tick_rate / 4, 2);
  const std::int64_t round_trip_us =
      data_.parts.transport->stats(seat.peer->connection).round_trip_us;
  const auto trip_ticks =
      static_cast<std::uint64_t>(std::max<std::int64_t>(0, round_trip_us) / data_.tick_us);
  if (confirmed - seat.ticks_received > lag + trip_ticks) return;
  seat.active_tick = confirmed + data_.config.input_delay_ticks + lag +
                     std::min(trip_ticks, k_max_round_trip_ticks);
  seat.inputs_next = seat.active_tick;
  seat.inputs.clear();  // of a former life, which was ahead
  data_.judge.set_present(slot, true);
  data_.peers.send_to_admitted(Activate{slot, seat.active_tick});
  data_.observer->player_active(slot, seat.active_tick);
}

}  // namespace lockstone::net
