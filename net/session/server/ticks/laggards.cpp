#include "net/session/server/ticks/laggards.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

constexpr std::uint64_t k_owed_hashes = 64;  // more than these are not merely on their way

}  // namespace

SlotMask Laggards::missing_inputs_mask() const {
  const std::uint64_t tick = data_.match.confirmed;
  SlotMask mask = 0;
  for (std::uint8_t slot = 0; slot < data_.roster.seats().size(); ++slot) {
    const Seat& seat = data_.roster.seat(slot);
    if (seat.plays(tick) && seat.inputs_next <= tick) mask |= slot_bit(slot);
  }
  return mask;
}

// How many ticks, or their hashes, the player has not confirmed.
std::uint64_t Laggards::ticks_behind(std::uint8_t slot) const {
  const std::uint64_t has =
      std::min(data_.roster.seat(slot).ticks_received, data_.judge.wanted(slot));
  LKS_ASSERT(has <= data_.match.confirmed);
  return data_.match.confirmed - has;
}

// Where the match may wait, it does so before a player loses ticks or snapshots. For newcomers it
// waits only if nothing else would slow it down. A player that holds it without a sign of progress
// is dropped in the end, as one that sends no inputs is.
SlotMask Laggards::behind_mask() const {
  SlotMask mask = 0;
  for (std::uint8_t slot = 0; slot < data_.roster.seats().size(); ++slot) {
    const Seat& seat = data_.roster.seat(slot);
    if (!seat.needs_ticks()) continue;
    const bool plays = seat.active_tick <= data_.match.confirmed;
    if (!plays && data_.config.pacing != Pacing::fast) continue;
    if (ticks_behind(slot) >= data_.config.history_ticks / 2) mask |= slot_bit(slot);
  }
  return mask;
}

void Laggards::drop_waited_for() {
  const SlotMask mask = data_.match.waiting;
  data_.match.waiting = 0;
  for (Seat& seat : data_.roster.seats()) {
    if (seat.peer == nullptr || !has_slot(mask, seat.peer->slot)) continue;
    // A state that is still being sent is no fault of its receiver.
    if (seat.loading && !states_.is_sent(seat)) continue;
    departures_.drop(*seat.peer, LeaveReason::timed_out);
  }
}

// The server never waits for them (deadline), so they would ask for ticks that are gone.
void Laggards::drop_behind() {
  const std::uint32_t history_ticks = data_.config.history_ticks;
  for (std::uint8_t slot = 0; slot < data_.roster.seats().size(); ++slot) {
    const Seat& seat = data_.roster.seat(slot);
    if (!seat.needs_ticks() || ticks_behind(slot) + 1 < history_ticks) continue;
    if (data_.match.confirmed - seat.ticks_received < history_ticks / 4) {
      departures_.expel(slot, LeaveReason::no_hashes);  // it has the ticks
    } else {
      departures_.drop(*seat.peer, LeaveReason::too_far_behind);
    }
  }
}

// A player that takes ticks owes the hashes of the states after them: without these nobody could be
// judged, and in a relay nobody else either. One that is silent takes no ticks: it is dropped as
// such, and may come back.
void Laggards::drop_without_hashes() {
  const std::int64_t now_us = data_.match.now_us;
  for (std::uint8_t slot = 0; slot < data_.roster.seats().size(); ++slot) {
    Seat& seat = data_.roster.seat(slot);
    if (seat.peer == nullptr || seat.loading) continue;
    const std::uint64_t had = data_.judge.wanted(slot);
    const bool owes = seat.ticks_received > had + k_owed_hashes && data_.judge.can_push(slot);
    if (!owes || had != seat.hashes_had) {
      seat.hashes_had = had;
      seat.hashes_since_us = now_us;
      seat.hashes_since_tick = seat.ticks_received;
    } else if (now_us - seat.hashes_since_us > data_.config.timeouts.drop_us &&
               seat.ticks_received > seat.hashes_since_tick + k_owed_hashes) {
      departures_.expel(slot, LeaveReason::no_hashes);
    }
  }
}

}  // namespace lockstone::net
