// The transport that a MatchRouter gives to one match.
#pragma once

#include <atomic>
#include <cstddef>
#include <vector>

#include <lockstone/net/match_router.h>
#include <lockstone/net/transport.h>

#include "net/routing/mailbox.h"

namespace lockstone::net {

/// The match's end of two mailboxes. It knows the connections that the match has heard of.
class RoutedTransport final : public Transport {
 public:
  explicit RoutedTransport(const MatchRouterOptions& options);

  bool poll(std::int64_t now_us, TransportEvent& event) override;
  Status send(ConnectionId connection, Channel channel, ByteView bytes) override;
  void flush() override {}
  void disconnect(ConnectionId connection) override;
  [[nodiscard]] TransportStats stats(ConnectionId connection) const override;
  [[nodiscard]] bool secure() const override { return true; }
  [[nodiscard]] PeerIdentity identity(ConnectionId connection) const override;
  void trust(ConnectionId connection) override;

  /// As new. Only while neither side uses it.
  void reset();

  Mailbox inbox;                        ///< the router writes, the match reads
  Mailbox outbox;                       ///< the match writes, the router reads
  std::atomic<bool> order_lost{false};  ///< the match's connections must end

 private:
  struct Known {
    ConnectionId connection = k_no_connection;
    bool trusted = false;
    PeerIdentity identity;
    TransportStats received;  ///< as the carrier had them with the last packet
  };

  [[nodiscard]] const Known* find(ConnectionId connection) const;
  [[nodiscard]] Known* find(ConnectionId connection);
  void order(ParcelKind kind, ConnectionId connection);
  [[nodiscard]] bool translate(const Parcel& parcel, ByteView bytes, TransportEvent& event);

  std::vector<Known> known_;  ///< never resized
};

}  // namespace lockstone::net
