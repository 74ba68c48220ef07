// IPv6 beside ENet; the way of a datagram is told in ipv6_side.h.
#include <algorithm>

#include "net/transport/enet_state.h"

namespace lockstone::net {
namespace {

std::byte wake_byte{0x57};

ENetBuffer wake_buffer() {
  ENetBuffer buffer{};
  buffer.data = &wake_byte;
  buffer.dataLength = 1;
  return buffer;
}

bool equal(const ENetAddress& a, const ENetAddress& b) {
  return a.host == b.host && a.port == b.port;
}

}  // namespace

bool Ipv6Side::fetch(EnetCounters& counters) {
  while (!waits_ && left_ > 0) {
    const std::optional<std::size_t> size = socket_->receive(source_, bytes_);
    if (!size) return false;
    --left_;
    waits_ = *size < bytes_.size();
    if (!waits_) ++counters.oversized;
    size_ = *size;
  }
  return waits_;
}

ByteView Ipv6Side::take(DatagramSource& source) {
  waits_ = false;
  source = source_;
  return ByteView(bytes_).first(size_);
}

// Binds ENet's socket if nothing has, since wakes need its port. Without a local address the system
// chooses one. The reason for a failure is in errno.
bool EnetTransport::State::add_ipv6(const DatagramSource* local) {
  if (ipv6 != nullptr) return true;
  ENetAddress own{};
  if (enet_socket_get_address(host->socket, &own) != 0 || own.port == 0) {
    const ENetAddress any{ENET_HOST_ANY, 0};
    if (enet_socket_bind(host->socket, &any) != 0) return false;
    if (enet_socket_get_address(host->socket, &own) != 0) return false;
  }
  if (own.host == ENET_HOST_ANY) enet_address_set_host_ip(&own, "127.0.0.1");
  std::unique_ptr<Udp6Socket> socket = Udp6Socket::open(local);
  if (socket == nullptr) return false;
  ipv6 = std::make_unique<Ipv6Side>(std::move(socket), own);
  return true;
}

bool EnetTransport::State::is_wake() const {
  return ipv6 != nullptr && equal(host->receivedAddress, ipv6->own());
}

// Puts the next good datagram in the place of a wake. False if there is none.
bool EnetTransport::State::admit_ipv6() {
  while (ipv6->fetch(counters)) {
    const ByteView bytes = ipv6->take(source);
    const std::span datagram = std::as_writable_bytes(std::span(host->packetData[0]));
    std::copy(bytes.begin(), bytes.end(), datagram.begin());
    host->receivedData = host->packetData[0];
    host->receivedDataLength = bytes.size();
    if (!admit(datagram.first(bytes.size()))) continue;
    if (ipv6->fetch(counters)) wake_for_ipv6();
    return true;
  }
  return false;
}

void EnetTransport::State::wake_for_ipv6() {
  const ENetBuffer buffer = wake_buffer();
  enet_socket_send(host->socket, &ipv6->own(), &buffer, 1);
}

void EnetTransport::State::send_over_ipv6(const Entry& entry, ByteView datagram) {
  ipv6->send(entry.remote, datagram);
  host->buffers[0] = wake_buffer();
  host->bufferCount = 1;
}

bool EnetTransport::State::wait(enet_uint32 limit_ms) const {
  if (ipv6->waits() || waits_behind(host->socket, ipv6->own())) return true;
  return wait_for_either(host->socket, ipv6->socket().handle(), limit_ms);
}

}  // namespace lockstone::net
