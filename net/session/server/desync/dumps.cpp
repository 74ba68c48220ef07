#include "net/session/server/desync/dumps.h"

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

constexpr std::size_t k_piece_overhead_bytes = 64;

}  // namespace

bool DumpTransfer::append(const Dump& piece, std::size_t limit_bytes) {
  if (piece.total_bytes > limit_bytes) return false;
  if (piece.offset_bytes != bytes.size()) return false;
  if (bytes.empty()) total_bytes = piece.total_bytes;
  if (piece.total_bytes != total_bytes) return false;
  bytes.insert(bytes.end(), piece.chunk.begin(), piece.chunk.end());
  done = bytes.size() == total_bytes;
  return true;
}

void DumpTransfer::give_up(std::int64_t now_us) {
  *this = {slot, {}, 0, true, now_us};
}

std::size_t DumpRequests::limit_bytes() const {
  const Simulation* known = data_.describer();
  return known == nullptr ? data_.config.max_dump_bytes
                          : known->snapshot_bytes_max(SnapshotKind::canonical);
}

void DumpRequests::request(DumpTransfer& transfer, std::uint8_t slot, std::uint64_t tick) {
  LKS_ASSERT(tick < data_.match.confirmed);
  Seat& seat = data_.roster.seat(slot);
  transfer = {};
  transfer.slot = slot;
  transfer.asked_us = data_.match.now_us;
  transfer.done = seat.peer == nullptr;
  if (transfer.done) return;
  const std::size_t pieces = limit_bytes() / k_max_chunk_bytes + 2;
  seat.dump_bytes_allowed += limit_bytes() + pieces * k_piece_overhead_bytes;
  data_.peers.tell(*seat.peer, DumpRequest{tick});
}

bool DumpRequests::admit(Seat& seat, const Dump& piece) {
  const std::size_t size = piece.chunk.size() + k_piece_overhead_bytes;
  if (size > seat.dump_bytes_allowed) return false;
  seat.dump_bytes_allowed -= size;
  return true;
}

bool DumpRequests::is_awaited(const DumpTransfer& transfer) const {
  return !transfer.done && data_.match.now_us - transfer.asked_us <= data_.config.timeouts.dump_us;
}

}  // namespace lockstone::net
