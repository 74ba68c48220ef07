// A UDP socket for IPv6 alone, and numeric addresses as the system reads them.
#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>

#include <enet/enet.h>

#include <lockstone/bytes.h>
#include <lockstone/status.h>

#include "net/transport/udp/datagram_source.h"

namespace lockstone::net {

/// Windows counts start-ups of its sockets per process; each user pairs its own with one shutdown.
class SocketLibrary {
 public:
  SocketLibrary() : ready_(enet_initialize() == 0) {}
  ~SocketLibrary() {
    if (ready_) enet_deinitialize();
  }
  SocketLibrary(const SocketLibrary&) = delete;
  SocketLibrary& operator=(const SocketLibrary&) = delete;
  [[nodiscard]] bool ready() const { return ready_; }

 private:
  bool ready_;
};

/// A numeric IPv6 address, with or without a zone (`fe80::1%eth0`). Nothing: another text.
[[nodiscard]] std::optional<DatagramSource> read_ipv6(const std::string& address,
                                                      std::uint16_t port);

class Udp6Socket {
 public:
  /// Never blocks, and takes no IPv4. Null, with the reason in errno, when the system refuses.
  /// Without an address it is bound by the first `send`, and does not tell which of its addresses
  /// were called.
  [[nodiscard]] static std::unique_ptr<Udp6Socket> open(const DatagramSource* local);
  ~Udp6Socket();
  Udp6Socket(const Udp6Socket&) = delete;
  Udp6Socket& operator=(const Udp6Socket&) = delete;

  [[nodiscard]] ENetSocket handle() const { return socket_; }
  [[nodiscard]] std::uint16_t port() const;

  /// A datagram that the system does not take is lost, as on a full network.
  void send(const DatagramSource& to, ByteView bytes) const;

  /// The size of the next datagram; that of the whole buffer if it was at least that long. Nothing
  /// if none waits.
  [[nodiscard]] std::optional<std::size_t> receive(DatagramSource& from,
                                                   std::span<std::byte> buffer) const;

 private:
  explicit Udp6Socket(ENetSocket socket) : socket_(socket) {}
  ENetSocket socket_;
};

/// Removes the datagrams at the head of an IPv4 socket that come from `own`. Whether another one
/// waits behind them.
[[nodiscard]] bool waits_behind(ENetSocket socket, const ENetAddress& own);

/// Until one of the two can be read; false if neither can within the limit.
[[nodiscard]] bool wait_for_either(ENetSocket a, ENetSocket b, enet_uint32 limit_ms);

}  // namespace lockstone::net
