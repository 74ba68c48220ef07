// Two states differ: at which tick, in whom, in what.
//
// The match freezes while the snapshots of the first bad tick are fetched. They are the ones that
// were kept when the tick was stepped: stepping again from an older one would not bring back a bit
// that flipped in memory.
#include <algorithm>

#include <lockstone/assert.h>

#include "net/session/server_impl.h"
#include "net/wire/tick_record.h"

namespace lockstone::net {

void Server::Impl::judge_hashes() {
  const bool judging = state == ServerState::running || state == ServerState::finishing;
  if (!judging || desync) return;
  const std::optional<Mismatch> found = judge.advance();
  if (parts.simulation == nullptr) {
    const bool undecided = found && found->verdict == Verdict::undecided;
    const std::uint64_t end = undecided ? found->tick : judge.judged_ticks();
    for (; agreed_told < end; ++agreed_told) {
      observer->hash_agreed(agreed_told, judge.right_hash(agreed_told));
    }
  }
  if (found) {
    parts_judge.forget();
    return open_case(*found);
  }
  judge_parts();
}

// Only what the hashes of every tick are blind to.
void Server::Impl::judge_parts() {
  const std::optional<PartMismatch> found = parts_judge.found();
  if (!found || judge.judged_ticks() < found->ticks) return;
  parts_judge.forget();
  const bool judges = found->reference == k_no_slot;
  open_case({found->ticks - 1, found->slot, found->reference,
             judges ? Verdict::client_diverged : Verdict::undecided, found->here.low,
             found->there.low});
  desync->part = name_of_part(found->part);
}

void Server::Impl::note_own_parts() {
  if (parts.simulation->tick() % k_parts_interval_ticks != 0) return;
  parts_judge.note_own(parts_of(*parts.simulation));
}

bool Server::Impl::on_parts(const Link& link, ByteView packet) {
  Parts message;
  if (decode(packet, message) != Status::ok || message.ticks > closed) return false;
  Seat& place = seats[link.slot];
  if (place.loading || desync) return true;
  const bool has_own = parts.simulation != nullptr;
  if (parts_judge.compare(link.slot, message, has_own)) ++place.stats.parts_equal;
  return true;
}

std::string Server::Impl::name_of_part(std::size_t part) const {
  const Simulation* known = parts.simulation == nullptr ? parts.describer : parts.simulation;
  std::array<PartHash, k_max_state_parts> hashed{};
  const std::size_t count = known == nullptr ? 0 : known->part_hashes(hashed);
  return part < count ? std::string(hashed[part].name) : "part " + std::to_string(part);
}

void Server::Impl::open_case(const Mismatch& mismatch) {
  desync.emplace();
  desync->mismatch = mismatch;
  desync->since_us = now_us;
  waiting = 0;
  entry.fetching = false;  // a player has one dump to send at a time
  if (mismatch.reference == k_no_slot) {
    const ByteView own = snapshots.find(mismatch.tick);
    desync->here = {k_no_slot, {own.begin(), own.end()}, own.size(), true};
  } else {
    request_dump(desync->here, mismatch.reference);
  }
  request_dump(desync->there, mismatch.slot);
}

void Server::Impl::request_dump(DumpTransfer& transfer, std::uint8_t slot) {
  transfer.slot = slot;
  transfer.done = seats[slot].link == nullptr;
  if (!transfer.done) send(*seats[slot].link, DumpRequest{desync->mismatch.tick});
}

bool Server::Impl::on_dump(Link& link, ByteView packet) {
  Dump dump;
  if (decode(packet, dump) != Status::ok) return false;
  const bool for_entry = entry.fetching && entry.transfer.slot == link.slot &&
                         dump.tick + 1 == entry.ticks && !entry.transfer.done;
  if (for_entry) return take_chunk(entry.transfer, dump);
  if (!desync || dump.tick != desync->mismatch.tick) return true;  // asked for, but too late
  for (DumpTransfer* transfer : {&desync->here, &desync->there}) {
    if (transfer->slot == link.slot && !transfer->done) return take_chunk(*transfer, dump);
  }
  return false;
}

bool Server::Impl::take_chunk(DumpTransfer& transfer, const Dump& dump) const {
  const Simulation* known = parts.simulation == nullptr ? parts.describer : parts.simulation;
  const std::size_t limit =
      known == nullptr ? config.max_dump_bytes : known->snapshot_bytes_max(SnapshotKind::canonical);
  if (dump.total_bytes > limit || dump.offset_bytes != transfer.received_bytes) return false;
  if (transfer.received_bytes == 0) transfer.bytes.resize(dump.total_bytes);
  if (dump.total_bytes != transfer.bytes.size()) return false;
  std::copy(dump.chunk.begin(), dump.chunk.end(),
            std::span(transfer.bytes).subspan(dump.offset_bytes).begin());
  transfer.received_bytes += dump.chunk.size();
  transfer.done = transfer.received_bytes == transfer.bytes.size();
  return true;
}

void Server::Impl::advance_case() {
  if (!desync || state >= ServerState::closing) return;
  const bool timed_out = now_us - desync->since_us > config.timeouts.dump_us;
  if (!timed_out && !(desync->here.done && desync->there.done)) return;
  for (DumpTransfer* transfer : {&desync->here, &desync->there}) {
    if (!transfer->done) transfer->bytes.clear();
  }
  const DesyncReport report = report_of_case();
  observer->desync_found(report);
  send_notice(report);
  desync.reset();
  const bool decided =
      report.verdict == Verdict::client_diverged || report.verdict == Verdict::minority;
  if (!decided || config.desync_policy == DesyncPolicy::end_match) {
    return finish(FinishReason::desync);
  }
  Seat& place = seats[report.slot];
  const bool again = config.desync_policy == DesyncPolicy::resync && !place.resynced;
  if (place.link != nullptr && again && state == ServerState::running) {
    resync(report.slot);
  } else if (place.link != nullptr) {
    drop(*place.link, LeaveReason::desync);
  }
  end_if_deserted();
  rebase_schedule(now_us);
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

// The views in the answer point into the case.
DesyncReport Server::Impl::report_of_case() {
  const Mismatch& mismatch = desync->mismatch;
  DesyncReport report;
  report.tick = mismatch.tick;
  report.slot = mismatch.slot;
  report.verdict = mismatch.verdict;
  report.hash_here = mismatch.hash_here;
  report.hash_there = mismatch.hash_there;
  report.part = desync->part;
  report.build_here = build_of(mismatch.reference);
  report.build_there = build_of(mismatch.slot);
  if (server_is_wrong(mismatch)) report.verdict = Verdict::server_diverged;
  report.dump_here = desync->here.bytes;
  report.dump_there = desync->there.bytes;
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
