// Input logs: everything that reads one.

#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/replay/log_compare.h>
#include <lockstone/replay/log_edit.h>
#include <lockstone/replay/log_info.h>
#include <lockstone/replay/log_map.h>
#include <lockstone/replay/seek.h>
#include <lockstone/replay/signature.h>
#include <lockstone/replay/verifier.h>

#include "replay/codec/header_codec.h"
#include "tests/fuzz/target.h"
#include "tests/replay/log_tools.h"

namespace lockstone::fuzz {
namespace {

using namespace replay;

// Of two bodies, so that an input takes little time.
test::ToyMatch sample_match() {
  return {.config = {.body_count = 2}, .ticks = 12, .keyframe_interval = 4, .chunk_ticks = 3};
}

std::vector<Bytes> seeds() {
  test::ToyMatch match = sample_match();
  std::vector<Bytes> all{test::record(match)};
  match.index = true;
  all.push_back(test::record(match));
  match.finishes = false;
  match.start_tick = 5;
  all.push_back(test::record(match));
  match.command_every = 2;
  all.push_back(test::record(match));
  match.compress = compression_available();
  all.push_back(test::record(match));
  return all;
}

// Of a frame as bytes; see encode_chunk_frame.
constexpr std::size_t k_sequence_offset = 8, k_stored_offset = 28, k_previous_offset = 32;

// Puts the chunk that begins at `rest` right, with a payload that ends where the log does at the
// latest; answers its length.
std::size_t mend_chunk(std::span<std::byte> rest, std::uint32_t sequence, std::uint64_t& previous) {
  const auto frame = rest.first<k_chunk_header_bytes>();
  const auto limit = static_cast<std::uint32_t>(rest.size() - frame.size());
  const auto stored = ByteReader(frame.subspan(k_stored_offset)).get<std::uint32_t>();
  const std::uint32_t bytes = std::min(stored, limit);
  ByteWriter(frame).put(k_chunk_sync);
  ByteWriter(frame.subspan(k_sequence_offset)).put(sequence);
  ByteWriter(frame.subspan(k_stored_offset)).put(bytes);
  ByteWriter link(frame.subspan(k_previous_offset));
  link.put(previous);
  link.put(payload_checksum(rest.subspan(frame.size(), bytes)));
  previous = seal_chunk_frame(frame);
  return frame.size() + bytes;
}

void mend(Bytes& bytes) {
  static const Bytes good = test::record(sample_match());
  constexpr std::size_t k_same = 10;  // magic and version
  if (bytes.size() < k_file_prefix_bytes) return;
  std::copy_n(good.begin(), k_same, bytes.begin());
  std::size_t offset = 0;
  const auto prefix = std::span(bytes).first(k_file_prefix_bytes);
  if (!decode_file_prefix(prefix, offset).ok() || offset > bytes.size()) return;
  std::uint64_t previous = seal_file_header(std::span(bytes).first(offset));
  for (std::uint32_t i = 0; bytes.size() - offset >= k_chunk_header_bytes; ++i)
    offset += mend_chunk(std::span(bytes).subspan(offset), i, previous);
}

// The saved part of a log is good, up to its end.
void save_what_is_good(ByteView bytes) {
  MemorySource source(bytes);
  MemorySink sink;
  if (repair(source, sink).status != Status::ok) return;
  MemorySource repaired(sink.bytes());
  const Result<LogInfo> info = read_log_info(repaired);
  LKS_CHECK(info.ok() && info.value().complete && !info.value().damage);
}

void go_into(ByteView bytes) {
  MemorySource source(bytes);
  (void)seek(source, toy::toy_factory(), 9);
  MemorySink sink;
  (void)cut(source, toy::toy_factory(), 3, 6, sink);
}

// Several threads give the same verdict as one.
bool check(ByteView bytes) {
  MemorySource source(bytes);
  const VerifyReport report = verify(source, toy::toy_factory());
  const std::vector<SourceOpener> openers{[bytes]() -> Result<std::unique_ptr<Source>> {
    return std::unique_ptr<Source>(std::make_unique<MemorySource>(bytes));
  }};
  const std::vector<VerifyReport> reports = verify_all(openers, toy::toy_factory());
  LKS_CHECK(reports[0].to_line() == report.to_line());
  return report.outcome == VerifyOutcome::same;
}

bool run(ByteView bytes) {
  static const Bytes good = test::record(sample_match());
  MemorySource source(bytes), other(good);
  (void)read_log_info(source);
  (void)map_log(source);
  (void)read_index(source);
  (void)find_keyframe(source, 7);
  (void)compare_logs(source, other);
  (void)check_signatures(source);
  save_what_is_good(bytes);
  go_into(bytes);
  return check(bytes);
}

const Registration k_registration{{.name = "log", .seeds = seeds, .mend = mend, .run = run}};

}  // namespace
}  // namespace lockstone::fuzz
