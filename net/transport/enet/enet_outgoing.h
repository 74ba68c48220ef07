// Datagrams on their way out of ENet: they get their checksum or seal, and the ones for IPv6 peers
// leave by the other socket.
#pragma once

#include <array>
#include <cstddef>
#include <span>

#include <enet/enet.h>

#include "net/transport/enet/enet_connections.h"
#include "net/transport/enet/enet_data.h"
#include "net/transport/enet/enet_datagram.h"

namespace lockstone::net {

/// Gathers a datagram from ENet's buffers, right before ENet sends it, and puts the finished one in
/// their place. The system takes one buffer in much less time than 33.
class EnetOutgoing {
 public:
  EnetOutgoing(EnetData& data, EnetConnections& connections)
      : data_(data), connections_(connections) {}

  /// Returns the checksum; 0 for buffers that are longer than any datagram.
  [[nodiscard]] enet_uint32 finish(std::span<const ENetBuffer> buffers);

 private:
  [[nodiscard]] Word seal(std::size_t size);
  [[nodiscard]] EnetConnection* receiver_of(ByteView datagram, const DatagramHead& head);

  EnetData& data_;
  EnetConnections& connections_;
  std::array<std::byte, ENET_PROTOCOL_MAXIMUM_MTU> gathered_{};
};

}  // namespace lockstone::net
