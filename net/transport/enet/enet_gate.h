// The gate in front of ENet: it judges every datagram before ENet reads it.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "net/transport/enet/enet_connections.h"
#include "net/transport/enet/enet_data.h"
#include "net/transport/enet/enet_datagram.h"
#include "net/transport/enet/enet_refusals.h"

namespace lockstone::net {

/// Lets through requests for connections with the match's checksum, where there is a place, and
/// authentic datagrams of peers within their limits.
class EnetGate {
 public:
  EnetGate(EnetData& data, EnetConnections& connections, EnetRefusals& refusals)
      : data_(data), connections_(connections), refusals_(refusals) {}

  /// Judges a datagram from `EnetData::source`. The seal is taken off one that is let through.
  [[nodiscard]] bool admit(std::span<std::byte> datagram);

  /// The checksum of the datagram that was let through last.
  [[nodiscard]] const Word& admitted() const { return admitted_; }

 private:
  static constexpr std::size_t k_remembered_connects = 1024;

  [[nodiscard]] bool admit_stranger(std::span<std::byte> datagram, const DatagramHead& head);
  [[nodiscard]] std::optional<LinkChecksum> checksum_for(ByteView connect) const;
  [[nodiscard]] bool admit_peer(std::span<std::byte> datagram, const DatagramHead& head);
  [[nodiscard]] bool admit_commands(EnetConnection& connection, const ENetPeer& peer,
                                    ByteView commands);
  [[nodiscard]] bool authenticate(EnetConnection& connection, std::span<std::byte>& datagram,
                                  const DatagramHead& head);

  EnetData& data_;
  EnetConnections& connections_;
  EnetRefusals& refusals_;
  ConnectMemory connects_{k_remembered_connects};
  Word admitted_{};
};

}  // namespace lockstone::net
