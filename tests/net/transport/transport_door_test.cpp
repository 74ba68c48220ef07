// Who gets a place of a listening socket, for how long, and that no stranger can keep it from
// working.
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include <lockstone/net/transport_enet.h>

#include "net/transport/enet/refusal_limit.h"
#include "tests/net/transport/door_support.h"
#include "tests/support/await.h"
#include "tools/relay/udp_socket.h"

namespace lockstone::net::test {
namespace {

using relay::Endpoint;
using relay::UdpSocket;

// Asks for a connection and never says anything else. True if the server answers.
bool is_answered(EnetTransport& server, const UdpSocket& socket, std::byte id,
                 std::int64_t now_us) {
  const std::uint64_t before = server.counters().datagrams;
  EXPECT_TRUE(socket.send(Endpoint::loopback(server.port()), open_connect(id)));
  poll_until_judged(server, before, now_us);
  std::array<std::byte, 2048> buffer{};
  Endpoint from;
  return socket.receive(from, buffer).has_value();
}

std::unique_ptr<UdpSocket> caller(std::uint32_t last = 1) {
  return std::move(UdpSocket::open({0x7f000000 + last, 0})).value();
}

TEST(EnetDoor, OneAddressCannotTakeAllPlaces) {
  const auto server = listening({.max_connections = 32});
  std::vector<std::unique_ptr<UdpSocket>> sockets;
  unsigned taken = 0;
  for (unsigned i = 0; i < 17; ++i) {
    sockets.push_back(caller());
    if (is_answered(*server, *sockets.back(), static_cast<std::byte>(i + 1), 0)) ++taken;
  }
  EXPECT_EQ(taken, EnetOptions{}.max_strangers_per_address);
  EXPECT_GT(server->counters().crowded, 0U);
  EXPECT_TRUE(is_answered(*server, *caller(2), std::byte{99}, 0));
}

TEST(EnetDoor, WhoNeverConfirmsHoldsAPlaceForTwoSeconds) {
  const auto server = listening({.max_connections = 1});
  const auto first = caller(), second = caller(2);
  ASSERT_TRUE(is_answered(*server, *first, std::byte{1}, 0));
  EXPECT_FALSE(is_answered(*server, *second, std::byte{2}, 1'999'999));
  TransportEvent event;
  static_cast<void>(server->poll(2'000'000, event));
  EXPECT_TRUE(is_answered(*server, *second, std::byte{2}, 2'000'001));
}

TEST(EnetDoor, ThePlaceOfWhoWasSentAwayIsFreeAtOnce) {
  const auto server = listening({.max_connections = 1});
  const auto client = std::move(EnetTransport::open({})).value();
  ASSERT_TRUE(client->connect("127.0.0.1", server->port()).ok());
  TransportEvent event, heard;
  lockstone::test::await([&] {
    static_cast<void>(client->poll(0, heard));
    return server->poll(0, event);
  });
  const std::array<std::byte, 4> no{};
  EXPECT_EQ(server->send(event.connection, Channel::reliable, no), Status::ok);
  server->disconnect(event.connection);  // the client never confirms
  EXPECT_TRUE(is_answered(*server, *caller(2), std::byte{2}, 0));
}

TEST(EnetDoor, OversizedDatagramsDoNotEndAPoll) {
  const auto server = listening({});
  const auto rude = caller(2), polite = caller();
  const std::vector<std::byte> huge(9000);
  for (int i = 0; i < 20; ++i)
    ASSERT_TRUE(rude->send(Endpoint::loopback(server->port()), huge));
  std::vector<std::byte> bytes(60);
  ASSERT_TRUE(polite->send(Endpoint::loopback(server->port()), bytes));
  TransportEvent event;
  EXPECT_FALSE(server->poll(0, event));
  EXPECT_EQ(server->counters().oversized, 20U);
  EXPECT_EQ(server->counters().datagrams, 1U);
}

TEST(EnetDoor, EmptyDatagramsDoNotEndAPoll) {
  const auto server = listening({});
  const auto rude = caller(2), polite = caller();
  for (int i = 0; i < 20; ++i)
    ASSERT_TRUE(rude->send(Endpoint::loopback(server->port()), {}));
  const std::vector<std::byte> bytes(60);
  ASSERT_TRUE(polite->send(Endpoint::loopback(server->port()), bytes));
  TransportEvent event;
  EXPECT_FALSE(server->poll(0, event));
  EXPECT_EQ(server->counters().datagrams, 1U);
}

TEST(EnetDoor, APollTakesABoundedNumberOfDatagrams) {
  const auto server = listening({});
  const auto rude = caller(2);
  const std::array<std::byte, 1> byte{};
  for (int i = 0; i < 270; ++i)
    ASSERT_TRUE(rude->send(Endpoint::loopback(server->port()), byte));
  TransportEvent event;
  EXPECT_FALSE(server->poll(0, event));
  EXPECT_LE(server->counters().datagrams, 256U);
  EXPECT_FALSE(server->poll(0, event));
}

// A client, and somebody between it and the server.
struct Eavesdropped {
  // The client's request for a connection, which has come to the one between.
  std::vector<std::byte> request() {
    std::array<std::byte, 2048> buffer{};
    std::vector<std::byte> bytes;
    lockstone::test::await([&] {
      EXPECT_FALSE(client->poll(0, event));
      if (const auto datagram = middle->receive(client_end, buffer))
        bytes.assign(datagram->begin(), datagram->end());
      return !bytes.empty();
    });
    return bytes;
  }

  // The true server's answer is on its way to the client after this.
  void pass_on(ByteView request) {
    EXPECT_TRUE(middle->send(Endpoint::loopback(server->port()), request));
    std::array<std::byte, 2048> buffer{};
    Endpoint from;
    lockstone::test::await([&] {
      static_cast<void>(server->poll(0, event));
      const auto answer = middle->receive(from, buffer);
      return answer && from.port == server->port() && middle->send(client_end, *answer);
    });
  }

  void refuse(ByteView request, RefuseReason reason) {
    Word id;
    std::copy_n(request.begin() + 48, id.size(), id.begin());
    EXPECT_TRUE(middle->send(client_end, encode(LinkRefusal{reason, id})));
    const std::uint64_t before = client->counters().datagrams;
    lockstone::test::await([&] {
      EXPECT_FALSE(client->poll(0, event));
      return client->counters().datagrams > before;
    });
  }

  std::unique_ptr<EnetTransport> server = listening({});
  std::unique_ptr<EnetTransport> client = std::move(EnetTransport::open({})).value();
  std::unique_ptr<UdpSocket> middle = caller();
  ConnectionId connection = client->connect("127.0.0.1", middle->port()).value();
  Endpoint client_end;
  TransportEvent event;
};

TEST(EnetDoor, AForgedRefusalDoesNotKeepAClientOut) {
  for (const RefuseReason reason :
       {RefuseReason::insecure_not_allowed, RefuseReason::wrong_match}) {
    Eavesdropped pair;
    const std::vector<std::byte> request = pair.request();
    pair.refuse(request, reason);
    EXPECT_FALSE(pair.client->poll(1'999'999, pair.event));
    pair.pass_on(request);
    lockstone::test::await([&] { return pair.client->poll(1'999'999, pair.event); });
    EXPECT_EQ(pair.event.kind, TransportEventKind::connected);
    EXPECT_FALSE(pair.client->poll(9'000'000, pair.event));
  }
}

TEST(EnetDoor, ARefusalIsTheCauseWhereTheServerSaysNothingForTwoSeconds) {
  Eavesdropped pair;
  pair.refuse(pair.request(), RefuseReason::wrong_match);
  ASSERT_TRUE(pair.client->poll(2'000'000, pair.event));
  EXPECT_EQ(pair.event.kind, TransportEventKind::disconnected);
  EXPECT_EQ(pair.event.reason, RefuseReason::wrong_match);
}

DatagramSource source_at(const char* text, std::uint16_t port = 7) {
  const auto ipv4 = ipv4_from_text(text);
  return {.address = ipv4 ? map_ipv4(*ipv4) : *ipv6_from_text(text), .port = port};
}

TEST(RefusalLimit, OneAddressDoesNotUseUpTheRefusalsOfOthers) {
  RefusalLimit limit;
  unsigned taken = 0;
  for (int i = 0; i < 1000; ++i)
    taken += limit.take(source_at("10.0.0.1", static_cast<std::uint16_t>(i)), 0) ? 1U : 0U;
  EXPECT_EQ(taken, RefusalLimit::k_source_burst);
  EXPECT_TRUE(limit.take(source_at("10.0.0.2"), 0));
  EXPECT_TRUE(limit.take(source_at("10.0.0.1"), 1'000'000));
}

TEST(RefusalLimit, AllAddressesTogetherAreLimited) {
  RefusalLimit limit;
  unsigned taken = 0;
  for (int i = 0; i < 1000; ++i) {
    const std::string text = "10.0." + std::to_string(i / 250) + "." + std::to_string(i % 250);
    taken += limit.take(source_at(text.c_str()), 0) ? 1U : 0U;
  }
  EXPECT_EQ(taken, RefusalLimit::k_per_second);
}

TEST(RefusalLimit, ANetworkOfIpv6CountsAsOneAddress) {
  RefusalLimit limit;
  unsigned taken = 0;
  for (int i = 1; i < 1000; ++i) {
    const std::string text = "2001:db8:1:2:" + std::to_string(i) + "::" + std::to_string(i);
    taken += limit.take(source_at(text.c_str()), 0) ? 1U : 0U;
  }
  EXPECT_EQ(taken, RefusalLimit::k_source_burst);
  EXPECT_TRUE(limit.take(source_at("2001:db8:1:3::1"), 0));
  EXPECT_TRUE(limit.take(source_at("10.0.0.1"), 0));
}

TEST(EnetDoor, APortInUseIsNamed) {
  const auto first = listening({});
  EnetOptions options;
  options.port = first->port();
  std::string problem;
  EXPECT_EQ(EnetTransport::listen(options, &problem).status(), Status::io_error);
  EXPECT_EQ(problem, "127.0.0.1:" + std::to_string(first->port()) + ": Address already in use");
}

}  // namespace
}  // namespace lockstone::net::test
