// The IPv6 half of a transport. ENet 1.3 reads and writes IPv4 addresses only, so datagrams over
// IPv6 have a socket of ours:
// - In: ENet calls its interceptor for each datagram of its own socket. A datagram of one byte that
//   this socket sends to itself (a wake) makes it call; the interceptor then puts the next datagram
//   of the IPv6 socket in its place. A wake carries nothing, so a false one does no harm.
// - Out: ENet has its checksum computed right before it sends. There a datagram for an IPv6 peer
//   goes out by the IPv6 socket, and ENet sends a wake instead.
// For ENet all IPv6 peers have the address of its own socket; the gate tells them apart. The other
// ways were worse: a relay with a socket for each peer costs a descriptor and two more system calls
// a datagram, and hides addresses from the limits; replacing ENet's socket functions works with
// some linkers only.
#pragma once

#include <array>
#include <cstddef>
#include <memory>
#include <span>

#include <enet/enet.h>

#include <lockstone/net/transport_enet.h>

#include "net/transport/udp/udp6_socket.h"

namespace lockstone::net {

class Ipv6Side {
 public:
  /// As many as ENet takes from its own socket.
  static constexpr unsigned k_max_datagrams_a_poll = 256;

  /// `own`: ENet's socket on the loopback.
  Ipv6Side(std::unique_ptr<Udp6Socket> socket, const ENetAddress& own)
      : socket_(std::move(socket)), own_(own) {}

  /// Opens the side beside a host of ENet's. Binds ENet's socket if nothing has, since wakes need
  /// its port. Without a local address the system chooses one. Null, with the reason in errno, when
  /// the system refuses.
  [[nodiscard]] static std::unique_ptr<Ipv6Side> open(const ENetHost& host,
                                                      const DatagramSource* local);

  [[nodiscard]] const Udp6Socket& socket() const { return *socket_; }
  [[nodiscard]] const ENetAddress& own() const { return own_; }
  void send(const DatagramSource& to, ByteView bytes) const { socket_->send(to, bytes); }

  /// Sends ENet's current datagram over IPv6, and puts a wake in its place.
  void send_instead(ENetHost& host, const DatagramSource& to, ByteView datagram) const;

  /// Whether ENet has just received a wake.
  [[nodiscard]] bool is_wake(const ENetHost& host) const;
  void wake(const ENetHost& host) const;

  /// Sleeps until a datagram has come for either half.
  [[nodiscard]] bool wait(const ENetHost& host, enet_uint32 limit_ms) const;

  void begin_poll() { left_ = k_max_datagrams_a_poll; }

  /// Whether a datagram waits here, for which the socket is read if need be.
  [[nodiscard]] bool fetch(EnetCounters& counters);

  /// Puts the one that waits in the place of the datagram that ENet has received.
  [[nodiscard]] std::span<std::byte> take(ENetHost& host, DatagramSource& source);

 private:
  std::unique_ptr<Udp6Socket> socket_;
  ENetAddress own_;
  unsigned left_ = k_max_datagrams_a_poll;
  bool waits_ = false;
  std::size_t size_ = 0;
  DatagramSource source_;
  std::array<std::byte, ENET_PROTOCOL_MAXIMUM_MTU + 1> bytes_{};
};

}  // namespace lockstone::net
