#include "net/transport/udp/ipv6_side.h"

#include <algorithm>

#include <lockstone/assert.h>

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

std::span<std::byte> Ipv6Side::take(ENetHost& host, DatagramSource& source) {
  LKS_ASSERT(waits_);
  waits_ = false;
  source = source_;
  const ByteView bytes = ByteView(bytes_).first(size_);
  const std::span<std::byte> place = std::as_writable_bytes(std::span(host.packetData[0]));
  std::copy(bytes.begin(), bytes.end(), place.begin());
  host.receivedData = host.packetData[0];
  host.receivedDataLength = bytes.size();
  return place.first(bytes.size());
}

std::unique_ptr<Ipv6Side> Ipv6Side::open(const ENetHost& host, const DatagramSource* local) {
  ENetAddress own{};
  if (enet_socket_get_address(host.socket, &own) != 0 || own.port == 0) {
    const ENetAddress any{ENET_HOST_ANY, 0};
    if (enet_socket_bind(host.socket, &any) != 0) return nullptr;
    if (enet_socket_get_address(host.socket, &own) != 0) return nullptr;
  }
  if (own.host == ENET_HOST_ANY) enet_address_set_host_ip(&own, "127.0.0.1");
  std::unique_ptr<Udp6Socket> socket = Udp6Socket::open(local);
  if (socket == nullptr) return nullptr;
  return std::make_unique<Ipv6Side>(std::move(socket), own);
}

bool Ipv6Side::is_wake(const ENetHost& host) const {
  return equal(host.receivedAddress, own_);
}

void Ipv6Side::wake(const ENetHost& host) const {
  const ENetBuffer buffer = wake_buffer();
  enet_socket_send(host.socket, &own_, &buffer, 1);
}

void Ipv6Side::send_instead(ENetHost& host, const DatagramSource& to, ByteView datagram) const {
  send(to, datagram);
  host.buffers[0] = wake_buffer();
  host.bufferCount = 1;
}

bool Ipv6Side::wait(const ENetHost& host, enet_uint32 limit_ms) const {
  if (waits_ || waits_behind(host.socket, own_)) return true;
  return wait_for_either(host.socket, socket_->handle(), limit_ms);
}

}  // namespace lockstone::net
