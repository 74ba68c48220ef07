// An insider who has the match's link key and sees a player's datagrams cannot act in its name.
#include <algorithm>
#include <array>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/net/transport_enet.h>

#include "net/transport/enet/enet_datagram.h"
#include "tests/net/security/secure_fixture.h"
#include "tests/support/await.h"
#include "tools/relay/udp_socket.h"

namespace lockstone::net::test {
namespace {

using relay::Endpoint;
using relay::UdpSocket;
using Bytes = std::vector<std::byte>;

Bytes bytes_of(std::initializer_list<unsigned> values) {
  Bytes bytes;
  for (const unsigned value : values)
    bytes.push_back(static_cast<std::byte>(value));
  return bytes;
}

// One direction of the wire, as the insider sees it.
struct Way {
  Bytes last;               // datagram
  std::vector<Bytes> seen;  // all
  Bytes held;               // back, to come after the next one
};

// A server and a client, and between them the insider.
struct Wire {
  Wire() {
    EnetOptions options;
    options.limits = DatagramLimits::none();
    options.link_key = link_key;
    server_socket = std::move(EnetTransport::listen(options).value());
    client_socket = std::move(EnetTransport::open(options).value());
    server = serve_securely(*server_socket, random);
    client = join_securely(*client_socket, 0, random);
    at_client = client_socket->connect("127.0.0.1", middle->port()).value();
  }

  void forward(Way& way, ByteView datagram, const Endpoint& to) {
    way.last.assign(datagram.begin(), datagram.end());
    way.seen.push_back(way.last);
    if (loss_percent > 0 && faults.below(100) < loss_percent) return;
    if (loss_percent > 0 && way.held.empty() && faults.below(100) < loss_percent) {
      way.held = way.last;
      return;
    }
    EXPECT_TRUE(middle->send(to, datagram));
    if (!way.held.empty()) {
      EXPECT_TRUE(middle->send(to, way.held));
    }
    way.held.clear();
  }

  void relay() {
    std::array<std::byte, 2048> buffer{};
    Endpoint from;
    const Endpoint to_server = Endpoint::loopback(server_socket->port());
    while (const auto datagram = middle->receive(from, buffer)) {
      if (from == to_server) {
        forward(down, *datagram, client_end);
      } else {
        client_end = from;
        if (cut && caught.empty()) caught.assign(datagram->begin(), datagram->end());
        if (!cut) forward(up, *datagram, to_server);
      }
    }
  }

  void hear(SecureTransport& end, ConnectionId& connection, std::vector<Bytes>& heard) {
    TransportEvent event;
    while (end.poll(0, event)) {
      if (event.kind == TransportEventKind::connected) connection = event.connection;
      if (event.kind == TransportEventKind::disconnected) ++ended;
      if (event.kind == TransportEventKind::received) {
        heard.emplace_back(event.bytes.begin(), event.bytes.end());
      }
    }
    end.flush();
  }

  void step() {
    hear(*client, open_at_client, heard_by_client);
    relay();
    hear(*server, at_server, heard_by_server);
    relay();
  }

  bool connect() {
    lockstone::test::await([&] {
      step();
      return (at_server != 0 && open_at_client != 0) || ended > 0;
    });
    return ended == 0 && exchange(3);
  }

  // Some reliable packets in both directions.
  bool exchange(unsigned count) {
    heard_by_client.clear();
    heard_by_server.clear();
    std::vector<Bytes> sent;
    for (unsigned i = 0; i < count; ++i) {
      sent.push_back(bytes_of({7, i, 9}));
      static_cast<void>(client->send(at_client, Channel::reliable, sent.back()));
      static_cast<void>(server->send(at_server, Channel::reliable, sent.back()));
    }
    lockstone::test::await([&] {
      step();
      return ended > 0 || (heard_by_client.size() >= count && heard_by_server.size() >= count);
    });
    return ended == 0 && heard_by_client == sent && heard_by_server == sent;
  }

  // A datagram in the name of one end, made of data that all players know or that is seen on the
  // wire.
  Bytes spoof(const Way& way, ByteView commands) const {
    const ByteView connect = up.seen.front();
    Bytes datagram(8 + commands.size());
    datagram[0] = way.last[0] | std::byte{0x80};
    datagram[1] = way.last[1];
    std::copy_n(connect.begin() + 48, 4, datagram.begin() + 4);
    std::copy(commands.begin(), commands.end(), datagram.begin() + 8);
    const Word sum = LinkChecksum(link_key).of(datagram);
    std::copy(sum.begin(), sum.end(), datagram.begin() + 4);
    return datagram;
  }

  void inject(ByteView commands) {
    EXPECT_TRUE(middle->send(Endpoint::loopback(server_socket->port()), spoof(up, commands)));
    EXPECT_TRUE(middle->send(client_end, spoof(down, commands)));
    for (int i = 0; i < 20; ++i)
      step();
  }

  TestRandom random{5};
  Random faults{1};
  unsigned loss_percent = 0;
  bool cut = false;  // nothing of the client's gets through
  Bytes caught;      // of that, the first
  LinkKey link_key = make_link_key(backend_key(), k_match);
  std::unique_ptr<UdpSocket> middle = std::move(UdpSocket::open({0x7f000001, 0})).value();
  std::unique_ptr<EnetTransport> server_socket, client_socket;
  std::unique_ptr<SecureTransport> server, client;
  ConnectionId at_client = 0, open_at_client = 0, at_server = 0;
  Endpoint client_end;
  Way up, down;
  std::vector<Bytes> heard_by_client, heard_by_server;
  unsigned ended = 0;
};

TEST(EnetSpoof, ReliableJunkInAPlayersNameEndsNothing) {
  Wire wire;
  ASSERT_TRUE(wire.connect());
  for (unsigned number = 1; number < 20; ++number)
    wire.inject(bytes_of({0x86, 0, 0, number, 0, 3, 1, 2, 3}));
  EXPECT_TRUE(wire.exchange(20));
  EXPECT_GE(wire.server_socket->counters().forged, 19U);
  EXPECT_GE(wire.client_socket->counters().forged, 19U);
}

TEST(EnetSpoof, ADisconnectInAPlayersNameEndsNothing) {
  Wire wire;
  ASSERT_TRUE(wire.connect());
  wire.inject(bytes_of({0x84, 0xff, 0, 3, 0, 0, 0, 0}));
  wire.inject(bytes_of({0x44, 0xff, 0, 0, 0, 0, 0, 0}));
  EXPECT_TRUE(wire.exchange(20));
}

TEST(EnetSpoof, AnAcknowledgementInAPlayersNameLosesNoPacket) {
  Wire wire;
  ASSERT_TRUE(wire.connect());
  wire.cut = true;
  const Bytes lost = bytes_of({1, 2, 3});
  wire.heard_by_server.clear();
  ASSERT_EQ(wire.client->send(wire.at_client, Channel::reliable, lost), Status::ok);
  wire.step();
  for (unsigned number = 1; number < 20; ++number)
    wire.inject(bytes_of({0x01, 0, 0, 0, 0, number, 0, 0}));
  wire.cut = false;
  const bool acknowledged = wire.ended > 0;
  ASSERT_FALSE(acknowledged);
  lockstone::test::await([&] {
    wire.step();
    return !wire.heard_by_server.empty() || wire.ended > 0;
  });
  EXPECT_EQ(wire.heard_by_server, std::vector<Bytes>{lost});
}

TEST(EnetSpoof, RecordedDatagramsCountOnce) {
  Wire wire;
  ASSERT_TRUE(wire.connect());
  const std::vector<Bytes> up = wire.up.seen, down = wire.down.seen;
  for (const Bytes& datagram : up)
    EXPECT_TRUE(wire.middle->send(Endpoint::loopback(wire.server_socket->port()), datagram));
  for (const Bytes& datagram : down)
    EXPECT_TRUE(wire.middle->send(wire.client_end, datagram));
  EXPECT_TRUE(wire.exchange(20));
  EXPECT_GT(wire.server_socket->counters().replayed, 0U);
  EXPECT_GT(wire.client_socket->counters().replayed, 0U);
}

// Every bit of a datagram that has not come yet, one at a time; then the datagram itself.
void expect_flips_are_dropped(Wire& wire, const Bytes& sealed, const EnetTransport& receiver,
                              const Endpoint& to) {
  const auto dropped = [&receiver] {
    const EnetCounters& all = receiver.counters();
    return all.forged + all.malformed + all.strays + all.replayed;
  };
  const std::uint64_t forged = receiver.counters().forged;
  const std::uint64_t before = dropped();
  for (std::size_t bit = 0; bit < sealed.size() * 8; ++bit) {
    Bytes altered = sealed;
    altered[bit / 8] ^= static_cast<std::byte>(1U << bit % 8);
    EXPECT_TRUE(wire.middle->send(to, altered));
    lockstone::test::await([&] {
      wire.step();
      return dropped() > before + bit;
    });
  }
  EXPECT_EQ(dropped() - before, sealed.size() * 8);
  // All but those of the two bytes that say whose it is.
  EXPECT_GE(receiver.counters().forged - forged, sealed.size() * 8 - 16);
  EXPECT_EQ(wire.ended, 0U);
}

TEST(EnetSpoof, EveryFlippedBitOfASealedDatagramIsDroppedAndEndsNothing) {
  Wire wire;
  ASSERT_TRUE(wire.connect());
  const Bytes word = bytes_of({1, 2, 3});
  wire.cut = true;
  wire.heard_by_server.clear();
  ASSERT_EQ(wire.client->send(wire.at_client, Channel::unreliable, word), Status::ok);
  wire.step();
  const Bytes up = wire.caught;
  ASSERT_FALSE(up.empty());
  const Endpoint to_server = Endpoint::loopback(wire.server_socket->port());
  expect_flips_are_dropped(wire, up, *wire.server_socket, to_server);
  EXPECT_TRUE(wire.heard_by_server.empty());
  EXPECT_TRUE(wire.middle->send(to_server, up));
  lockstone::test::await([&] {
    wire.step();
    return !wire.heard_by_server.empty();
  });
  EXPECT_EQ(wire.heard_by_server, std::vector<Bytes>{word});
  wire.cut = false;

  // The other way the datagrams have come already, and would count as replayed.
  expect_flips_are_dropped(wire, wire.down.last, *wire.client_socket, wire.client_end);
  EXPECT_TRUE(wire.exchange(20));
}

TEST(EnetSpoof, LossAndReorderingDuringTheHandshakeLoseNoConnection) {
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    Wire wire;
    wire.faults = Random(seed);
    wire.loss_percent = 20;
    EXPECT_TRUE(wire.connect()) << "seed " << seed;
    wire.loss_percent = 0;
    EXPECT_TRUE(wire.exchange(10)) << "seed " << seed;
  }
}

}  // namespace
}  // namespace lockstone::net::test
