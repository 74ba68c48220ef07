#include "net/session/server/comparison/desync_response.h"

#include <algorithm>
#include <vector>

#include <lockstone/assert.h>

#include "net/wire/tick_record.h"

namespace lockstone::net {
namespace {

bool is_decided(Verdict verdict) {
  return verdict == Verdict::client_diverged || verdict == Verdict::minority;
}

}  // namespace

void DesyncResponse::open(const Mismatch& mismatch, const std::string& part) {
  DesyncCases& cases = uses_.cases;
  if (cases.full()) close_first();
  if (data_.match.state >= ServerState::closing) return;
  const bool first = cases.empty();
  DesyncCase& found = cases.add();
  found.mismatch = mismatch;
  found.part = part;
  if (server_is_wrong(mismatch)) found.mismatch.verdict = Verdict::server_diverged;
  found.ends_match =
      !is_decided(found.mismatch.verdict) || data_.config.desync_policy == DesyncPolicy::end_match;
  if (mismatch.reference == k_no_slot) {
    const ByteView own = data_.snapshots.find(mismatch.tick);
    found.here = {k_no_slot, {own.begin(), own.end()}, own.size(), true, data_.match.now_us};
  } else {
    found.here.slot = mismatch.reference;
  }
  uses_.dumps.request(found.there, mismatch.slot, mismatch.tick);
  if (found.ends_match) {
    data_.match.waiting = 0;
  } else {
    condemn(mismatch.slot);
  }
  if (first) ask_reference();
}

// It gets no ticks, has no say, and nobody waits for it. The sentence holds even if it leaves.
void DesyncResponse::condemn(std::uint8_t slot) {
  Seat& seat = data_.roster.seat(slot);
  MatchStatus& match = data_.match;
  seat.condemned = true;
  seat.await_state(0);
  seat.active_tick = k_never;
  data_.judge.set_present(slot, false);
  match.waiting &= ~slot_bit(slot);
  const bool again = data_.offenders.was_resynced(seat.identity, slot);
  if (data_.config.desync_policy == DesyncPolicy::resync && !again) {
    data_.offenders.note_resync(seat.identity, slot);
    return;
  }
  seat.expelled = true;
  seat.rejoin_key = 0;
  seat.reserved_until_us = std::min(seat.reserved_until_us, match.now_us);
  data_.offenders.ban(seat.identity, slot);
  ++data_.counters.expelled;
}

// A relay asks the player that speaks for the others, one case at a time: it has one dump to send.
void DesyncResponse::ask_reference() {
  DesyncCase& found = uses_.cases.first();
  if (found.here.done) return;
  uses_.states.release_donor(found.here.slot);
  uses_.dumps.request(found.here, found.here.slot, found.mismatch.tick);
}

void DesyncResponse::advance() {
  while (!uses_.cases.empty() && data_.match.state < ServerState::closing) {
    if (uses_.cases.first_waits()) return;
    close_first();
  }
}

void DesyncResponse::close_first() {
  const DesyncCase found = uses_.cases.report_first();
  if (found.ends_match) return uses_.end.finish(FinishReason::desync);
  const std::uint8_t slot = found.mismatch.slot;
  Seat& seat = data_.roster.seat(slot);
  if (seat.peer != nullptr && seat.condemned) {
    if (seat.expelled || data_.match.state != ServerState::running) {
      uses_.departures.drop(*seat.peer, LeaveReason::desync);
    } else {
      uses_.entry.resync(slot);
    }
  }
  uses_.end.finish_if_deserted();
  if (!uses_.cases.empty()) ask_reference();
}

// The judge may have been hit itself: it steps the tick again from the state that was kept before,
// and believes the player if that gives the player's state.
bool DesyncResponse::server_is_wrong(const Mismatch& mismatch) {
  if (mismatch.reference != k_no_slot || mismatch.tick == 0) return false;
  const ByteView before = data_.snapshots.find(mismatch.tick - 1);
  const ByteView record = data_.records.find(mismatch.tick);
  if (before.empty() || record.empty()) return false;
  Simulation& simulation = *data_.parts.simulation;
  std::vector<std::byte> now(simulation.snapshot_bytes_max(SnapshotKind::native));
  const std::size_t size = simulation.save(SnapshotKind::native, now);
  bool wrong = false;
  if (simulation.load(SnapshotKind::canonical, before) == Status::ok) {
    step_tick(simulation, RecordInputs(record, data_.shape).view(),
              data_.commands.of(mismatch.tick));
    wrong = simulation.hash() == mismatch.hash_there;
  }
  LKS_CHECK(simulation.load(SnapshotKind::native, ByteView(now).first(size)) == Status::ok);
  return wrong;
}

}  // namespace lockstone::net
