#include <algorithm>
#include <utility>
#include <vector>

#include <lockstone/replay/log_edit.h>
#include <lockstone/replay/log_reader.h>
#include <lockstone/replay/recorder.h>
#include <lockstone/replay/seek.h>

#include "replay/chunks/chunk_reader.h"
#include "replay/chunks/chunk_writer.h"
#include "replay/codec/header_codec.h"
#include "replay/codec/index_codec.h"
#include "replay/codec/record_codec.h"

namespace lockstone::replay {
namespace {

// The good beginning of a log, up to its last complete tick.
struct GoodPart {
  bool has_scene = false;
  std::uint64_t bytes = 0;
  LogEnd totals;
  IndexBuilder index;
  std::uint32_t next_sequence = 0;
};

// Reads as far as the log is good. `part` follows each item but COMMAND and INPUT, which are
// nothing without the hashes, and the items between them.
LogItem measure(LogReader& reader, GoodPart& part) {
  bool awaits_hashes = false;
  LogItem item = reader.next();
  for (; !is_last(item) && item != LogItem::end; item = reader.next()) {
    awaits_hashes = item == LogItem::inputs || item == LogItem::commands ||
                    (awaits_hashes && item == LogItem::skipped);
    if (awaits_hashes) continue;
    if (item == LogItem::scene) part.has_scene = true;
    const ChunkHeader& chunk = reader.chunk();
    if (item == LogItem::hashes) {
      part.totals.ticks += chunk.count;
      part.totals.final_hash = reader.hashes().back();
      part.totals.final_tick = chunk.first_tick + chunk.count;
      part.totals.transcript = reader.transcript();
    }
    if (item == LogItem::events) part.totals.events += chunk.count;
    if (item == LogItem::keyframe) {
      part.index.add({chunk.first_tick, reader.chunk_offset()});
      ++part.totals.keyframes;
    }
    part.bytes = reader.chunk_offset() + k_chunk_header_bytes + chunk.stored_bytes;
    part.next_sequence = chunk.sequence + 1;
  }
  return item;
}

// After the END.
bool ends_well(LogReader& reader) {
  LogItem item = reader.next();
  while (item == LogItem::skipped)
    item = reader.next();
  return item == LogItem::finished;
}

Status copy(Source& source, std::uint64_t bytes, Sink& sink) {
  std::vector<std::byte> buffer(1U << 16);
  for (std::uint64_t done = 0; done < bytes;) {
    const auto size =
        static_cast<std::size_t>(std::min<std::uint64_t>(bytes - done, buffer.size()));
    const std::span<std::byte> piece = std::span(buffer).first(size);
    Status status = source.read_at(done, piece);
    if (status == Status::ok) status = sink.append(piece);
    if (status != Status::ok) return status;
    done += size;
  }
  return Status::ok;
}

// The frame checksum of the last chunk of the good part.
std::uint64_t last_checksum(Source& source, std::uint64_t bytes) {
  ChunkReader chunks(source);
  if (chunks.open() != Walk::good) return 0;
  while (chunks.next_offset() < bytes && chunks.next_frame() == Walk::good) {
  }
  return chunks.last_checksum();
}

Status close(Source& source, const GoodPart& part, const std::string& reason, Sink& sink) {
  ChunkWriter writer(sink);
  writer.continue_at(part.bytes, part.next_sequence, last_checksum(source, part.bytes));
  std::vector<std::byte> room(k_chunk_header_bytes + k_max_index_bytes);
  const Status status = writer.append(seal_index(writer, part.index, part.totals.final_tick, room));
  if (status != Status::ok) return status;
  return writer.append(seal_end(writer, part.totals, reason, room));
}

}  // namespace

RepairReport repair(Source& damaged, Sink& sink) {
  RepairReport report;
  LogReader reader(damaged);
  report.status = reader.open();
  if (report.status != Status::ok) {
    report.what = reader.damage().what;
    return report;
  }
  GoodPart part;
  part.totals.final_tick = reader.header().match.start_tick;
  part.totals.kind = EndKind::repaired;
  part.totals.transcript = reader.transcript();
  const LogItem last = measure(reader, part);
  if (!part.has_scene) {
    report.status = Status::malformed;
    const std::string& cause = reader.damage().what;
    report.what = "nothing of it is good: " + (cause.empty() ? "it has no scene" : cause);
    return report;
  }
  report.was_whole = last == LogItem::end && ends_well(reader);
  if (reader.damage().status != Status::ok) report.damage = reader.damage();
  report.kept_ticks = part.totals.ticks;
  report.kept_bytes = report.was_whole ? damaged.size() : part.bytes;
  report.lost_bytes = damaged.size() - report.kept_bytes;
  report.status = copy(damaged, report.kept_bytes, sink);
  if (report.status == Status::ok && !report.was_whole) {
    const std::string cause = report.damage ? report.damage->what : "it had no end";
    report.status = close(damaged, part, "repaired: " + cause, sink);
  }
  return report;
}

namespace {

// Records the ticks before `end`, and the items between them.
void copy_ticks(TickReader& ticks, std::uint64_t end, Recorder& recorder, CutReport& report) {
  std::uint64_t hash = 0;
  while (report.status == Status::ok && ticks.next() && ticks.tick() < end) {
    if (report.ticks > 0 && ticks.at_keyframe()) {
      report.status = recorder.keyframe(ticks.tick(), hash, ticks.snapshot());
    }
    if (report.status != Status::ok) return;
    hash = ticks.hash();
    report.status = recorder.record_commands(ticks.commands());
    if (report.status != Status::ok) return;
    report.status = recorder.record_tick(ticks.tick(), ticks.inputs(), hash);
    ++report.ticks;
  }
}

// Why there are fewer ticks than were asked for. A log may just end, also in a torn tail.
void judge_end(const TickReader& ticks, CutReport& report) {
  if (report.status != Status::ok) return;
  const Damage& damage = ticks.reader().damage();
  if (damage.status != Status::ok && damage.status != Status::truncated) {
    report.status = damage.status;
    report.what = damage.what;
  } else if (report.ticks == 0) {
    report.status = Status::not_found;
    report.what = "the log ends before the first tick of the cut";
  }
}

}  // namespace

CutReport cut(Source& source, const SimulationFactory& factory, std::uint64_t begin,
              std::uint64_t end, Sink& sink, bool compress) {
  if (begin >= end) {
    return {Status::invalid_argument, "the first tick of the cut must lie before its end", 0};
  }
  SeekResult found = seek(source, factory, begin);
  if (found.status != Status::ok) return {found.status, std::move(found.what), 0};
  if (!found.same_canary) return {Status::incompatible, "this build has another canary", 0};
  if (found.diverged) {
    return {Status::incompatible,
            "this build goes another way at tick " + std::to_string(found.diverged_tick), 0};
  }
  const LogHeader& header = found.ticks->reader().header();
  MatchMetadata match = header.match;
  match.start_tick = begin;
  Recorder recorder(
      sink, {.keyframe_bytes_max = found.simulation->snapshot_bytes_max(SnapshotKind::canonical),
             .compress = compress});
  CutReport report;
  report.status = recorder.begin(header.info, found.ticks->config(), match);
  if (report.status == Status::ok) report.status = recorder.keyframe(*found.simulation);
  copy_ticks(*found.ticks, end, recorder, report);
  judge_end(*found.ticks, report);
  if (report.status == Status::ok) report.status = recorder.finish("cut", EndKind::cut);
  return report;
}

}  // namespace lockstone::replay
