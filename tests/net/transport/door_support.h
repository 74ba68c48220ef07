// Callers at the door of a listening socket.
#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <vector>

#include <lockstone/net/transport_enet.h>

#include "net/transport/enet/enet_datagram.h"
#include "tests/support/await.h"

namespace lockstone::net::test {

inline std::unique_ptr<EnetTransport> listening(const EnetOptions& options) {
  return std::move(EnetTransport::listen(options)).value();
}

/// ENet's request for a connection with this id, under the open checksum.
inline std::vector<std::byte> open_connect(std::byte id) {
  std::vector<std::byte> bytes(56);
  const std::array<std::uint8_t, 40> command{
      0x82, 0xff, 0, 1, 0, 0, 0xff, 0xff, 0, 0, 5,    0x78, 0, 1, 0, 0, 0, 0, 0, 2,
      0,    0,    0, 0, 0, 0, 0,    0,    0, 0, 0x13, 0x88, 0, 0, 0, 2, 0, 0, 0, 2};
  bytes[0] = std::byte{0x8f};
  bytes[1] = std::byte{0xff};
  std::transform(command.begin(), command.end(), bytes.begin() + 8,
                 [](std::uint8_t value) { return std::byte{value}; });
  bytes[48] = id;
  const Word sum = LinkChecksum(std::nullopt).of(bytes);
  std::copy(sum.begin(), sum.end(), bytes.begin() + 4);
  return bytes;
}

/// Until the server has seen a datagram beyond `before`, and once more, for the answer.
inline void poll_until_judged(EnetTransport& server, std::uint64_t before, std::int64_t now_us) {
  TransportEvent event;
  lockstone::test::await([&] {
    static_cast<void>(server.poll(now_us, event));
    return server.counters().datagrams > before;
  });
  static_cast<void>(server.poll(now_us, event));
}

}  // namespace lockstone::net::test
