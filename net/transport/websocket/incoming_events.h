// Events of a WebSocketTransport that the session has not seen yet.
#pragma once

#include <cstddef>
#include <vector>

#include <lockstone/net/transport.h>

namespace lockstone::net {

/// A queue that gives its memory back never, and is empty most of the time: it is filled by one
/// round of the network, and read to its end before the next.
class IncomingEvents {
 public:
  void add(const TransportEvent& event) {
    entries_.push_back({event, bytes_.size(), event.bytes.size()});
    bytes_.insert(bytes_.end(), event.bytes.begin(), event.bytes.end());
  }

  void add(TransportEventKind kind, ConnectionId connection,
           RefuseReason reason = RefuseReason::none) {
    TransportEvent event;
    event.kind = kind;
    event.connection = connection;
    event.reason = reason;
    add(event);
  }

  /// The session wants to hear no more of it.
  void forget(ConnectionId connection) {
    for (Entry& entry : entries_) {
      if (entry.event.connection == connection) entry.event.connection = k_no_connection;
    }
  }

  /// False when there is none. The bytes are valid until the next call of `take`.
  [[nodiscard]] bool take(TransportEvent& event) {
    while (next_ < entries_.size()) {
      const Entry& entry = entries_[next_++];
      if (entry.event.connection == k_no_connection) continue;
      event = entry.event;
      const auto begin = bytes_.begin() + static_cast<std::ptrdiff_t>(entry.offset);
      current_.assign(begin, begin + static_cast<std::ptrdiff_t>(entry.size));
      event.bytes = current_;
      return true;
    }
    entries_.clear();
    bytes_.clear();
    next_ = 0;
    return false;
  }

 private:
  struct Entry {
    TransportEvent event;
    std::size_t offset;
    std::size_t size;
  };
  std::vector<Entry> entries_;
  std::vector<std::byte> bytes_;
  std::vector<std::byte> current_;  ///< of the event taken last
  std::size_t next_ = 0;
};

}  // namespace lockstone::net
