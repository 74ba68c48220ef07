// Sends the server a snapshot of an earlier state, to explain a difference.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <lockstone/bytes.h>

#include "net/session/client/client_data.h"
#include "net/session/client/prediction.h"

namespace lockstone::net {

/// Holds one snapshot, and sends it in pieces, a few an update.
class DumpSender {
 public:
  DumpSender(ClientData& data, Prediction& prediction) : data_(data), prediction_(prediction) {}

  /// Takes the memory for a snapshot; 0: no snapshot is ever sent.
  void reserve(std::size_t snapshot_bytes) { dump_.resize(snapshot_bytes); }

  /// Forgets the snapshot that is being sent.
  void cancel() { size_ = 0; }

  /// The server's request. False for a packet that breaks the format or comes out of turn.
  [[nodiscard]] bool on_request(ByteView packet);

  void send_pieces();

 private:
  ClientData& data_;
  Prediction& prediction_;
  std::vector<std::byte> dump_;  ///< snapshot_bytes_max
  std::size_t size_ = 0;
  std::size_t sent_ = 0;
  std::uint64_t tick_ = 0;
};

}  // namespace lockstone::net
