// Refusals of connections, on both sides: a datagram that says why there will be none.
#pragma once

#include <cstdint>
#include <span>

#include "net/transport/enet/enet_connections.h"
#include "net/transport/enet/enet_data.h"
#include "net/transport/enet/enet_datagram.h"
#include "net/transport/enet/refusal_limit.h"

namespace lockstone::net {

/// Refuses callers of another kind or match, seldom enough to drown nobody; and believes a refusal
/// of an own call only after a time in which the server said nothing else.
class EnetRefusals {
 public:
  EnetRefusals(EnetData& data, EnetConnections& connections)
      : data_(data), connections_(connections) {}

  /// Tells the sender of a request with a wrong checksum why it is refused, if that can be told.
  void refuse(const Word& connect, std::span<std::byte> request, const DatagramHead& head);

  /// A refusal of an own call has come, from anybody.
  void note(const LinkRefusal& refusal);

  /// Ends the own calls that were refused and not answered.
  void believe();

 private:
  [[nodiscard]] RefuseReason reason_against(std::span<std::byte> request,
                                            const DatagramHead& head) const;

  EnetData& data_;
  EnetConnections& connections_;
  LinkChecksum open_checksum_{std::nullopt};
  RefusalLimit limit_;
};

}  // namespace lockstone::net
