// The messages of a WebSocket that a program carries for a client. The input is a run of steps, each a
// kind (u8), a length (u16) and so many bytes: a new call, its opening, a message, its end, or a packet
// to send. After kinds from 128 all that waits comes out.
#include <algorithm>
#include <array>

#include <lockstone/assert.h>
#include <lockstone/net/transport_messages.h>

#include "tests/fuzz/target.h"

namespace lockstone::fuzz {
namespace {

using net::Channel;
using net::MessageTransport;

constexpr std::size_t k_step_head = 3;

bool is_good(ByteView message) {
  const std::size_t most =
      message.front() == std::byte{0} ? net::k_max_reliable_bytes : net::k_max_datagram_bytes;
  return message.size() > 1 && message.size() <= 1 + most + net::k_carrier_reserve_bytes;
}

// All that comes out was a good message; all that goes out is one.
bool drain(MessageTransport& transport) {
  bool any = false;
  net::TransportEvent event;
  while (transport.poll(0, event)) {
    const bool received = event.kind == net::TransportEventKind::received;
    LKS_CHECK(received != event.bytes.empty());
    any = any || received;
  }
  for (ByteView out = transport.next_message(); !out.empty(); out = transport.next_message()) {
    LKS_CHECK(is_good(out));
    transport.take_message();
  }
  return any;
}

void take_step(MessageTransport& transport, net::ConnectionId& number, unsigned kind, ByteView bytes) {
  switch (kind % 6) {
    case 0:
      number = transport.open();
      break;
    case 1:
      transport.opened();
      break;
    case 2:
      static_cast<void>(transport.receive(bytes));
      break;
    case 3:
      transport.closed(static_cast<unsigned>(4000 + bytes.size()));
      break;
    case 4:
      transport.disconnect(number);
      break;
    default:
      static_cast<void>(transport.send(number, bytes.size() % 2 == 0 ? Channel::reliable
                                                                    : Channel::unreliable, bytes));
  }
}

bool run(ByteView bytes) {
  MessageTransport transport;
  net::ConnectionId number = net::k_no_connection;
  bool any = false;
  while (bytes.size() >= k_step_head) {
    const auto kind = std::to_integer<unsigned>(bytes[0]);
    const std::size_t size = std::min(bytes.size() - k_step_head,
                                      std::to_integer<std::size_t>(bytes[1]) << 8 |
                                          std::to_integer<std::size_t>(bytes[2]));
    take_step(transport, number, kind, bytes.subspan(k_step_head, size));
    bytes = bytes.subspan(k_step_head + size);
    if (kind >= 128) any = drain(transport) || any;
  }
  return drain(transport) || any;
}

std::vector<Bytes> seeds() {
  // 128 is 2 more than a multiple of 6: a message, after which all comes out.
  const std::array<std::uint8_t, 28> steps{0, 0, 0, 1, 0, 0, 2, 0, 3, 0, 5, 6, 128, 0, 2, 1,
                                           9, 5, 0, 3, 1, 2, 3, 4, 0, 0, 3, 0};
  Bytes bytes;
  for (const std::uint8_t step : steps)
    bytes.push_back(std::byte{step});
  return {bytes};
}

const Registration k_registration{{.name = "messages", .seeds = seeds, .run = run}};

}  // namespace
}  // namespace lockstone::fuzz
