#include "net/session/server/desync/desync_cases.h"

#include <algorithm>
#include <array>
#include <utility>

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

std::string build_of(const ServerData& data, std::uint8_t slot) {
  const bool seated = data.roster.is_slot(slot) && data.roster.seat(slot).peer != nullptr;
  return seated ? std::string(data.roster.seat(slot).peer->build.view()) : std::string();
}

// The views in the report point into the case.
DesyncReport report_of(const ServerData& data, const DesyncCase& found) {
  const Mismatch& mismatch = found.mismatch;
  DesyncReport report;
  report.tick = mismatch.tick;
  report.slot = mismatch.slot;
  report.verdict = mismatch.verdict;
  report.hash_here = mismatch.hash_here;
  report.hash_there = mismatch.hash_there;
  report.name = data.roster.seat(mismatch.slot).name.view();
  report.part = found.part;
  report.build_here = build_of(data, mismatch.reference);
  report.build_there = build_of(data, mismatch.slot);
  report.dump_here = found.here.bytes;
  report.dump_there = found.there.bytes;
  const Simulation* describer = data.describer();
  if (describer != nullptr && !report.dump_here.empty() && !report.dump_there.empty()) {
    report.difference = describer->describe(report.dump_here, report.dump_there);
  }
  return report;
}

DesyncNotice notice_of(const DesyncReport& report) {
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
  return notice;
}

}  // namespace

bool DesyncCases::freeze_match() const {
  return std::any_of(cases_.begin(), cases_.end(),
                     [](const DesyncCase& found) { return found.ends_match; });
}

bool DesyncCases::concern(std::uint8_t slot) const {
  return std::any_of(cases_.begin(), cases_.end(), [slot](const DesyncCase& found) {
    return found.here.slot == slot || found.there.slot == slot;
  });
}

DumpTransfer* DesyncCases::transfer_of(std::uint8_t slot, std::uint64_t tick) {
  for (DesyncCase& found : cases_) {
    if (found.mismatch.tick != tick) continue;
    for (DumpTransfer* transfer : {&found.here, &found.there}) {
      if (transfer->slot == slot && !transfer->done) return transfer;
    }
  }
  return nullptr;
}

void DesyncCases::give_up_on(std::uint8_t slot) {
  for (DesyncCase& found : cases_) {
    for (DumpTransfer* transfer : {&found.here, &found.there}) {
      if (transfer->slot == slot && !transfer->done) transfer->give_up(data_.match.now_us);
    }
  }
}

bool DesyncCases::first_waits() const {
  const DesyncCase& found = cases_.front();
  return dumps_.is_awaited(found.here) || dumps_.is_awaited(found.there);
}

DesyncCase DesyncCases::report_first() {
  LKS_ASSERT(!cases_.empty());
  DesyncCase found = std::move(cases_.front());
  cases_.erase(cases_.begin());
  for (DumpTransfer* transfer : {&found.here, &found.there}) {
    if (!transfer->done) transfer->bytes.clear();
  }
  const DesyncReport report = report_of(data_, found);
  ++data_.counters.verdicts[static_cast<std::size_t>(report.verdict)];
  data_.observer->desync_found(report);
  const DesyncNotice notice = notice_of(report);
  for (const Seat& seat : data_.roster.seats()) {
    if (seat.peer != nullptr) data_.peers.tell(*seat.peer, notice);
  }
  return found;
}

void DesyncCases::report_all() {
  while (!empty())
    static_cast<void>(report_first());
}

}  // namespace lockstone::net
