// A bounded queue from one thread to another.
#pragma once

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>

#include <lockstone/bytes.h>
#include <lockstone/net/transport.h>

namespace lockstone::net {

enum class ParcelKind : std::uint8_t {
  // to a match
  connected,
  disconnected,
  received,
  // from a match
  send,
  trust,
  disconnect,
};

/// An event or an order on its way. The bytes of a packet follow it in the queue.
struct Parcel {
  ParcelKind kind = ParcelKind::received;
  Channel channel = Channel::reliable;
  RefuseReason reason = RefuseReason::none;
  ConnectionId connection = k_no_connection;
  PeerIdentity identity;  ///< of `connected`
  TransportStats stats;   ///< of `received`
  std::size_t size = 0;   ///< of the packet
};

/// The writer fills one buffer while the reader empties the other; they swap when the reader's is
/// empty, so that the lock is held only to copy one parcel.
class Mailbox {
 public:
  /// `capacity` bytes wait at most, besides those that are being read.
  explicit Mailbox(std::size_t capacity);

  /// The writer's. False if less than `spare` parcels without a packet would still fit after it.
  [[nodiscard]] bool put(const Parcel& parcel, ByteView bytes, std::size_t spare);

  /// The reader's. `bytes` are valid until the next call. False if nothing waits.
  [[nodiscard]] bool take(Parcel& parcel, ByteView& bytes);

  /// Forgets everything. Only while neither side uses it.
  void clear();

 private:
  struct Buffer {
    std::unique_ptr<std::byte[]> bytes;  ///< not initialised: unused pages cost no memory
    std::size_t used = 0;
  };

  std::size_t capacity_;
  std::mutex mutex_;
  std::atomic<bool> waiting_{false};  ///< `written_` holds something
  Buffer written_;
  Buffer read_;
  std::size_t position_ = 0;  ///< in `read_`
};

}  // namespace lockstone::net
