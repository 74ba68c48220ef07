// Two states differ: finds the tick, the player and the field.
//
// A player that is found wrong is out from that moment on, and the match goes on without it while
// the snapshots of the first bad tick are fetched. Only where nobody can tell who is right, or the
// policy is to end the match, does the match stand still. The snapshots are the ones that were kept
// when the tick was stepped: stepping again from an older one would not bring back a bit that
// flipped in memory.
#include <algorithm>
#include <utility>

#include <lockstone/assert.h>

#include "net/session/server_impl.h"
#include "net/wire/tick_record.h"

namespace lockstone::net {
namespace {

constexpr std::size_t k_chunk_overhead_bytes = 64;

bool is_decided(Verdict verdict) {
  return verdict == Verdict::client_diverged || verdict == Verdict::minority;
}

}  // namespace

void Server::Impl::judge_hashes() {
  const bool judging = state == ServerState::running || state == ServerState::finishing;
  while (judging && !frozen()) {
    const std::optional<Mismatch> found = judge.advance();
    tell_agreed(found);
    if (!found) break;
    parts_judge.forget(found->slot);
    open_case(*found, {});
  }
  if (judging && !frozen()) judge_parts();
}

// In a relay: the hash that all players agree on.
void Server::Impl::tell_agreed(const std::optional<Mismatch>& found) {
  if (parts.simulation != nullptr) return;
  const bool undecided = found && found->verdict == Verdict::undecided;
  const std::uint64_t end = undecided ? found->tick : judge.judged_ticks();
  for (; agreed_told < end; ++agreed_told)
    observer->hash_agreed(agreed_told, judge.right_hash(agreed_told));
}

// Only differences that the hashes of every tick miss.
void Server::Impl::judge_parts() {
  unsigned voters = 0;
  for (std::uint8_t slot = 0; slot < seats.size(); ++slot) {
    const Seat& place = seats[slot];
    if (place.link != nullptr && place.active_tick <= closed) voters |= 1U << slot;
  }
  parts_judge.vote(static_cast<std::uint16_t>(voters), closed);
  for (std::uint8_t slot = 0; slot < seats.size() && !frozen(); ++slot) {
    const std::optional<PartMismatch> found = parts_judge.found(slot);
    if (!found || judge.judged(slot) < found->ticks) continue;
    parts_judge.forget(slot);
    if (seats[slot].condemned) continue;
    judge.ignore(slot);
    open_case({found->ticks - 1, slot, found->reference, found->verdict, found->here.low,
               found->there.low},
              name_of_part(found->part));
  }
}

void Server::Impl::note_own_parts() {
  if (parts.simulation->tick() % k_parts_interval_ticks != 0) return;
  parts_judge.note_own(parts_of(*parts.simulation));
}

bool Server::Impl::on_parts(const Link& link, ByteView packet) {
  Parts message;
  if (decode(packet, message) != Status::ok || message.ticks > closed) return false;
  if (!seats[link.slot].loading && !frozen()) parts_judge.take(link.slot, message);
  return true;
}

std::string Server::Impl::name_of_part(std::size_t part) const {
  const Simulation* known = parts.simulation == nullptr ? parts.describer : parts.simulation;
  std::array<PartHash, k_max_state_parts> hashed{};
  const std::size_t count = known == nullptr ? 0 : known->part_hashes(hashed);
  return part < count ? std::string(hashed[part].name) : "part " + std::to_string(part);
}

// Nobody can tell who is right, or the match is to end: then it stands still until it is explained.
bool Server::Impl::frozen() const {
  return std::any_of(cases.begin(), cases.end(),
                     [](const DesyncCase& found) { return found.ends_match; });
}

void Server::Impl::open_case(const Mismatch& mismatch, const std::string& part) {
  if (cases.size() >= seats.size()) close_case();
  if (state >= ServerState::closing) return;
  const bool first = cases.empty();
  DesyncCase& found = cases.emplace_back();
  found.mismatch = mismatch;
  found.part = part;
  if (server_is_wrong(mismatch)) found.mismatch.verdict = Verdict::server_diverged;
  found.ends_match =
      !is_decided(found.mismatch.verdict) || config.desync_policy == DesyncPolicy::end_match;
  if (mismatch.reference == k_no_slot) {
    const ByteView own = snapshots.find(mismatch.tick);
    found.here = {k_no_slot, {own.begin(), own.end()}, own.size(), true, now_us};
  } else {
    found.here.slot = mismatch.reference;
  }
  request_dump(found.there, mismatch.slot, mismatch.tick);
  if (found.ends_match) {
    waiting = 0;
  } else {
    condemn(mismatch.slot);
  }
  if (first) begin_case();
}

// It gets no ticks, has no say, and nobody waits for it. The sentence holds even if it leaves.
void Server::Impl::condemn(std::uint8_t slot) {
  Seat& place = seats[slot];
  place.condemned = true;
  load_anew(place, 0);
  place.active_tick = k_never;
  judge.set_present(slot, false);
  waiting = static_cast<std::uint16_t>(waiting & ~(1U << slot));
  const bool again = offenders.was_resynced(place.identity, slot);
  if (config.desync_policy == DesyncPolicy::resync && !again) {
    offenders.note_resync(place.identity, slot);
    return;
  }
  place.expelled = true;
  place.rejoin_key = 0;
  place.reserved_until_us = std::min(place.reserved_until_us, now_us);
  offenders.bar(place.identity, slot);
  ++counters.expelled;
}

// A relay asks the player that speaks for the others, one case at a time: it has one dump to send.
void Server::Impl::begin_case() {
  DesyncCase& found = cases.front();
  if (found.here.done) return;
  const bool donates = entry.fetching && entry.transfer.slot == found.here.slot;
  if (donates) entry.fetching = false;
  request_dump(found.here, found.here.slot, found.mismatch.tick);
}

void Server::Impl::request_dump(DumpTransfer& transfer, std::uint8_t slot, std::uint64_t tick) {
  transfer = {};
  transfer.slot = slot;
  transfer.asked_us = now_us;
  transfer.done = seats[slot].link == nullptr;
  if (transfer.done) return;
  const std::size_t chunks = dump_limit_bytes() / k_max_chunk_bytes + 2;
  seats[slot].dump_room_bytes += dump_limit_bytes() + chunks * k_chunk_overhead_bytes;
  send(*seats[slot].link, DumpRequest{tick});
}

std::size_t Server::Impl::dump_limit_bytes() const {
  const Simulation* known = parts.simulation == nullptr ? parts.describer : parts.simulation;
  return known == nullptr ? config.max_dump_bytes
                          : known->snapshot_bytes_max(SnapshotKind::canonical);
}

// Whether `slot` has a dump to send for a case.
bool Server::Impl::dumps(std::uint8_t slot) const {
  return std::any_of(cases.begin(), cases.end(), [slot](const DesyncCase& found) {
    return found.here.slot == slot || found.there.slot == slot;
  });
}

DumpTransfer* Server::Impl::transfer_of(std::uint8_t slot, std::uint64_t tick) {
  const bool for_entry = entry.fetching && entry.transfer.slot == slot && tick + 1 == entry.ticks;
  if (for_entry && !entry.transfer.done) return &entry.transfer;
  for (DesyncCase& found : cases) {
    if (found.mismatch.tick != tick) continue;
    for (DumpTransfer* transfer : {&found.here, &found.there}) {
      if (transfer->slot == slot && !transfer->done) return transfer;
    }
  }
  return nullptr;
}

// More than was asked for is malformed. A late packet is only ignored.
bool Server::Impl::on_dump(Link& link, ByteView packet) {
  Dump dump;
  if (decode(packet, dump) != Status::ok) return false;
  Seat& place = seats[link.slot];
  const std::size_t size = dump.chunk.size() + k_chunk_overhead_bytes;
  if (size > place.dump_room_bytes) return false;
  place.dump_room_bytes -= size;
  DumpTransfer* transfer = transfer_of(link.slot, dump.tick);
  return transfer == nullptr || take_chunk(*transfer, dump);
}

bool Server::Impl::take_chunk(DumpTransfer& transfer, const Dump& dump) const {
  if (dump.total_bytes > dump_limit_bytes()) return false;
  if (dump.offset_bytes != transfer.bytes.size()) return false;
  if (transfer.bytes.empty()) transfer.total_bytes = dump.total_bytes;
  if (dump.total_bytes != transfer.total_bytes) return false;
  transfer.bytes.insert(transfer.bytes.end(), dump.chunk.begin(), dump.chunk.end());
  transfer.done = transfer.bytes.size() == transfer.total_bytes;
  return true;
}

void Server::Impl::advance_cases() {
  while (!cases.empty() && state < ServerState::closing) {
    const DesyncCase& found = cases.front();
    if (is_awaited(found.here) || is_awaited(found.there)) return;
    close_case();
  }
}

bool Server::Impl::is_awaited(const DumpTransfer& transfer) const {
  return !transfer.done && now_us - transfer.asked_us <= config.timeouts.dump_us;
}

// Tells of the first case with the dumps that have come.
DesyncCase Server::Impl::report_case() {
  DesyncCase found = std::move(cases.front());
  cases.erase(cases.begin());
  for (DumpTransfer* transfer : {&found.here, &found.there}) {
    if (!transfer->done) transfer->bytes.clear();
  }
  const DesyncReport report = report_of(found);
  ++counters.verdicts[static_cast<std::size_t>(report.verdict)];
  observer->desync_found(report);
  send_notice(report);
  return found;
}

void Server::Impl::close_case() {
  const DesyncCase found = report_case();
  if (found.ends_match) return finish(FinishReason::desync);
  const std::uint8_t slot = found.mismatch.slot;
  Seat& place = seats[slot];
  if (place.link != nullptr && place.condemned) {
    if (place.expelled || state != ServerState::running) {
      drop(*place.link, LeaveReason::desync);
    } else {
      resync(slot);
    }
  }
  end_if_deserted();
  if (!cases.empty()) begin_case();
}

std::string Server::Impl::build_of(std::uint8_t slot) const {
  const bool seated = slot < seats.size() && seats[slot].link != nullptr;
  return seated ? std::string(seats[slot].link->build.view()) : std::string();
}

// The judge may have been hit itself: it steps the tick again from the state that was kept before,
// and believes the player if that gives the player's state.
bool Server::Impl::server_is_wrong(const Mismatch& mismatch) {
  const ByteView before = mismatch.tick == 0 ? ByteView{} : snapshots.find(mismatch.tick - 1);
  const ByteView record = records.find(mismatch.tick);
  if (mismatch.reference != k_no_slot || before.empty() || record.empty()) return false;
  Simulation& simulation = *parts.simulation;
  std::vector<std::byte> now(simulation.snapshot_bytes_max(SnapshotKind::native));
  const std::size_t size = simulation.save(SnapshotKind::native, now);
  bool wrong = false;
  if (simulation.load(SnapshotKind::canonical, before) == Status::ok) {
    simulation.step(RecordInputs(record, shape).view());
    wrong = simulation.hash() == mismatch.hash_there;
  }
  LKS_CHECK(simulation.load(SnapshotKind::native, ByteView(now).first(size)) == Status::ok);
  return wrong;
}

// The views in the report point into the case.
DesyncReport Server::Impl::report_of(const DesyncCase& found) const {
  const Mismatch& mismatch = found.mismatch;
  DesyncReport report;
  report.tick = mismatch.tick;
  report.slot = mismatch.slot;
  report.verdict = mismatch.verdict;
  report.hash_here = mismatch.hash_here;
  report.hash_there = mismatch.hash_there;
  report.part = found.part;
  report.build_here = build_of(mismatch.reference);
  report.build_there = build_of(mismatch.slot);
  report.dump_here = found.here.bytes;
  report.dump_there = found.there.bytes;
  const Simulation* describer = parts.simulation == nullptr ? parts.describer : parts.simulation;
  if (describer != nullptr && !report.dump_here.empty() && !report.dump_there.empty()) {
    report.difference = describer->describe(report.dump_here, report.dump_there);
  }
  return report;
}

void Server::Impl::send_notice(const DesyncReport& report) {
  DesyncNotice notice;
  notice.tick = report.tick;
  notice.slot = report.slot;
  notice.verdict = report.verdict;
  notice.hash_here = report.hash_here;
  notice.hash_there = report.hash_there;
  notice.differs = report.difference.differs;
  notice.object = report.difference.object;
  notice.store = FieldText(report.difference.store);
  notice.name = FieldText(report.difference.name);
  notice.field = FieldText(report.difference.field);
  notice.here = FieldText(report.difference.here);
  notice.there = FieldText(report.difference.there);
  for (const Seat& place : seats) {
    if (place.link != nullptr) send(*place.link, notice);
  }
}

}  // namespace lockstone::net
