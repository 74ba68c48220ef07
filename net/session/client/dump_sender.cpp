#include "net/session/client/dump_sender.h"

#include <algorithm>

#include <lockstone/assert.h>

namespace lockstone::net {
namespace {

constexpr int k_pieces_per_update = 8;

}  // namespace

bool DumpSender::on_request(ByteView packet) {
  DumpRequest request;
  if (decode(packet, request) != Status::ok) return false;
  if (data_.status.state != ClientState::running) return false;
  if (request.tick >= data_.progress.stepped) return false;
  tick_ = request.tick;
  sent_ = 0;
  size_ = data_.predicts() ? prediction_.save_kept_state(request.tick + 1, dump_) : 0;
  const ByteView kept = data_.progress.snapshots.find(request.tick);
  if (!kept.empty()) {
    std::copy(kept.begin(), kept.end(), dump_.begin());
    size_ = kept.size();
  }
  if (size_ == 0) data_.server.send(Dump{request.tick, 0, 0, {}});
  return true;
}

void DumpSender::send_pieces() {
  LKS_ASSERT(size_ <= dump_.size());
  for (int i = 0; i < k_pieces_per_update && sent_ < size_; ++i) {
    const std::size_t size = std::min(k_max_chunk_bytes, size_ - sent_);
    data_.server.send(Dump{tick_, static_cast<std::uint32_t>(size_),
                           static_cast<std::uint32_t>(sent_),
                           ByteView(dump_).subspan(sent_, size)});
    sent_ += size;
  }
}

}  // namespace lockstone::net
