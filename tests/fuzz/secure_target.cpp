// A server's side of the secure layer against one client's packets. The input is a run of
// packets, each a channel (u8), a length (u16) and its bytes.

#include <algorithm>

#include <lockstone/assert.h>
#include <lockstone/net/transport_sim.h>

#include "net/transport/enet/enet_datagram.h"
#include "tests/fuzz/target.h"
#include "tests/net/security/secure_fixture.h"

namespace lockstone::fuzz {
namespace {

using namespace net;

// One connection that brings the packets of the input.
class Script final : public Transport {
 public:
  explicit Script(ByteView bytes) : reader_(bytes) {}

  bool poll(std::int64_t, TransportEvent& event) override {
    event = {};
    event.connection = 1;
    event.kind = TransportEventKind::connected;
    if (!began_) return began_ = true;
    event.kind = TransportEventKind::received;
    if (!open_ || reader_.remaining() == 0) return false;
    const auto channel = reader_.get<std::uint8_t>();
    const auto size = reader_.get<std::uint16_t>();
    event.channel = channel % 2 == 0 ? Channel::reliable : Channel::unreliable;
    event.bytes = reader_.get_bytes(size);
    return reader_.ok();
  }
  Status send(ConnectionId, Channel, ByteView) override { return Status::ok; }
  void flush() override {}
  void disconnect(ConnectionId) override { open_ = false; }
  [[nodiscard]] TransportStats stats(ConnectionId) const override { return {}; }

 private:
  ByteReader reader_;
  bool began_ = false;
  bool open_ = true;
};

// The same server for every input, down to its random numbers.
struct Peer {
  explicit Peer(Transport& carrier) : transport(test::serve_securely(carrier, random)) {}
  test::TestRandom random{1};
  std::unique_ptr<SecureTransport> transport;
};

bool run(ByteView bytes) {
  if (const auto head = read_head(bytes)) static_cast<void>(read_connect(bytes, *head));
  static_cast<void>(decode_link_refusal(bytes));
  if (!security_available()) return bytes.size() > 100;
  Script script(bytes);
  Peer server(script);
  bool connected = false;
  TransportEvent event;
  while (server.transport->poll(0, event)) {
    LKS_CHECK(connected || event.kind == TransportEventKind::connected);
    connected = true;
  }
  // A proof of keys that the fuzzer cannot have would be a break: the seeds have theirs.
  return connected;
}

void append(Bytes& input, Channel channel, ByteView packet) {
  Bytes head(3);
  ByteWriter writer(head);
  writer.put(static_cast<std::uint8_t>(channel));
  writer.put(static_cast<std::uint16_t>(packet.size()));
  input.insert(input.end(), head.begin(), head.end());
  input.insert(input.end(), packet.begin(), packet.end());
}

// The packets of an honest client to that server.
Bytes honest_session() {
  if (!security_available()) return Bytes(200);
  SimNetwork network(1);
  SimTransport& server_end = network.add_endpoint();
  SimTransport& client_end = network.add_endpoint();
  const ConnectionId connection = network.connect(client_end, server_end, {});
  Peer server(server_end);
  test::TestRandom random(2);
  test::TapTransport tap(client_end);
  const auto client = test::join_securely(tap, 0, random);
  TransportEvent event;
  for (std::int64_t now_us = 1; now_us < 5; ++now_us) {
    while (server.transport->poll(now_us, event)) {
    }
    if (!client->poll(now_us, event)) continue;
    const Bytes word(20, std::byte{1});
    for (const Channel channel : {Channel::reliable, Channel::unreliable})
      LKS_CHECK(client->send(connection, channel, word) == Status::ok);
  }
  Bytes input;
  for (const auto& sent : tap.sent)
    append(input, sent.channel, sent.bytes);
  return input;
}

std::vector<Bytes> seeds() {
  return {honest_session()};
}

const Registration k_registration{{.name = "secure", .seeds = seeds, .run = run}};

}  // namespace
}  // namespace lockstone::fuzz
