// IPv6 beside ENet: who gets a place, which datagrams are dropped, and that both kinds of addresses
// work together.
#include <array>
#include <fstream>

#include <gtest/gtest.h>

#include "net/security/hexadecimal.h"
#include "tests/net/security/secure_fixture.h"
#include "tests/net/transport/door_support.h"
#include "tests/net/transport/ipv6_support.h"
#include "tests/support/await.h"
#include "tools/relay/udp_socket.h"

namespace lockstone::net::test {
namespace {

// True if the server answers a request for a connection.
bool is_answered(EnetTransport& server, const Udp6Socket& socket, std::byte id) {
  const std::uint64_t before = server.counters().datagrams;
  socket.send(loopback6(server.port()), open_connect(id));
  poll_until_judged(server, before, 0);
  std::array<std::byte, 2048> buffer{};
  DatagramSource from;
  const bool answered = socket.receive(from, buffer).has_value();
  EXPECT_TRUE(!answered || from.address == loopback6(0).address);
  return answered;
}

void poll(EnetTransport& server) {
  TransportEvent event;
  EXPECT_FALSE(server.poll(0, event));
}

TEST(Ipv6, OneSiteIsAnAddressOfIpv4OrA64OfIpv6) {
  const auto one_site = [](const char* a, const char* b) {
    const auto source = [](const char* text) {
      const auto ipv4 = ipv4_from_text(text);
      return DatagramSource{.address = ipv4 ? map_ipv4(*ipv4) : *ipv6_from_text(text)};
    };
    return from_one_site(source(a), source(b));
  };
  EXPECT_TRUE(one_site("2001:db8:1:2::1", "2001:db8:1:2:ffff:ffff:ffff:ffff"));
  EXPECT_FALSE(one_site("2001:db8:1:2::1", "2001:db8:1:3::1"));
  EXPECT_TRUE(one_site("10.0.0.1", "10.0.0.1"));
  EXPECT_FALSE(one_site("10.0.0.1", "10.0.0.2"));
  EXPECT_FALSE(one_site("::1", "127.0.0.1"));  // both begin with eight zeros
}

TEST(Ipv6, ALinkLocalSiteIsOneInterfaces) {
  const Ipv6Bytes address = *ipv6_from_text("fe80::1");
  const auto from = [&address](std::uint32_t interface, std::uint16_t port) {
    return DatagramSource{.address = address, .scope = interface, .port = port};
  };
  EXPECT_TRUE(from_one_site(from(2, 7), from(2, 8)));
  EXPECT_FALSE(from_one_site(from(2, 7), from(3, 7)));
}

TEST(ResolveHost, GivesTheAddressesOfANameAndAnAddressItself) {
  using Texts = std::vector<std::string>;
  EXPECT_EQ(resolve_host("127.0.0.1"), Texts{"127.0.0.1"});
  EXPECT_EQ(resolve_host("::1"), Texts{"::1"});
  EXPECT_EQ(resolve_host("2001:DB8:0::1"), Texts{"2001:db8::1"});
  const Texts found = resolve_host("localhost");
  EXPECT_FALSE(found.empty());
  for (const std::string& address : found)
    EXPECT_TRUE(address == "::1" || address.rfind("127.", 0) == 0) << address;
  for (const char* text : {"", "[::1]", "::1::", "a b"})
    EXPECT_TRUE(resolve_host(text).empty()) << text;
}

TEST(Ipv6, OneSiteCannotTakeAllPlaces) {
  LKS_NEEDS_IPV6();
  const auto server = listening({.bind_address = "::"});
  std::vector<std::unique_ptr<Udp6Socket>> sockets;
  unsigned taken = 0;
  for (unsigned i = 0; i < 9; ++i) {
    sockets.push_back(open_loopback6());
    if (is_answered(*server, *sockets.back(), static_cast<std::byte>(i + 1))) ++taken;
  }
  EXPECT_EQ(taken, EnetOptions{}.max_strangers_per_address);
  EXPECT_EQ(server->counters().crowded, 9 - taken);
  const auto other = std::move(relay::UdpSocket::open({0x7f000001, 0})).value();
  ASSERT_TRUE(other->send(relay::Endpoint::loopback(server->port()), open_connect(std::byte{99})));
  poll_until_judged(*server, server->counters().datagrams, 0);
  std::array<std::byte, 2048> buffer{};
  relay::Endpoint from;
  EXPECT_TRUE(other->receive(from, buffer).has_value());
}

TEST(Ipv6, ARequestSentAgainFromAnotherPortIsDropped) {
  LKS_NEEDS_IPV6();
  const auto server = listening({.bind_address = "::1"});
  const auto first = open_loopback6(), second = open_loopback6();
  EXPECT_TRUE(is_answered(*server, *first, std::byte{1}));
  EXPECT_FALSE(is_answered(*server, *second, std::byte{1}));
  EXPECT_EQ(server->counters().repeated_connects, 1U);
}

TEST(Ipv6, GarbageIsCountedAndNeverAnswered) {
  LKS_NEEDS_IPV6();
  const auto server = listening({.bind_address = "::1"});
  const auto rude = open_loopback6();
  const DatagramSource target = loopback6(server->port());
  TestRandom random(11);
  std::uint64_t sent = 0;
  for (std::size_t size = 0; size <= 1400; size += 50, ++sent) {
    std::vector<std::byte> bytes(size);
    random.fill(bytes);
    rude->send(target, bytes);
    poll(*server);
  }
  for (const std::size_t size : {4097U, 5000U, 9000U})
    rude->send(target, std::vector<std::byte>(size));
  lockstone::test::await([&] {
    poll(*server);
    return server->counters().datagrams >= sent && server->counters().oversized >= 3;
  });
  const EnetCounters& counters = server->counters();
  EXPECT_EQ(counters.datagrams, sent);
  EXPECT_EQ(counters.oversized, 3U);
  EXPECT_EQ(counters.malformed + counters.strays + counters.forged, sent);
  std::array<std::byte, 64> buffer{};
  DatagramSource from;
  EXPECT_FALSE(rude->receive(from, buffer).has_value());
  EXPECT_TRUE(is_answered(*server, *open_loopback6(), std::byte{1}));
}

TEST(Ipv6, APollTakesABoundedNumberOfDatagrams) {
  LKS_NEEDS_IPV6();
  const auto server = listening({.bind_address = "::1"});
  const auto rude = open_loopback6();
  const std::array<std::byte, 1> byte{};
  for (int i = 0; i < 270; ++i)
    rude->send(loopback6(server->port()), byte);
  poll(*server);
  EXPECT_LE(server->counters().datagrams, 256U);
  lockstone::test::await([&] {
    poll(*server);
    return server->counters().datagrams == 270;
  });
}

// Why a client hears that it cannot come in, with 10 ms for each round.
RefuseReason refusal(EnetTransport& server, Transport& client) {
  TransportEvent event;
  std::int64_t now_us = 0;
  lockstone::test::await([&] {
    now_us += 10'000;
    EXPECT_FALSE(server.poll(now_us, event));
    return client.poll(now_us, event);
  });
  EXPECT_EQ(event.kind, TransportEventKind::disconnected);
  return event.reason;
}

EnetOptions options_of_match(std::uint64_t match) {
  EnetOptions options{.bind_address = "::1"};
  options.link_key = make_link_key(backend_key(), match);
  options.match_tag = make_match_tag(match);
  return options;
}

TEST(Ipv6, ARefusalReachesAPeerOfTheOtherKind) {
  LKS_NEEDS_IPV6();
  if (!security_available()) GTEST_SKIP() << "no libsodium";
  const auto server = listening(options_of_match(7));
  const auto client = std::move(EnetTransport::open({})).value();
  ASSERT_TRUE(client->connect("::1", server->port()).ok());
  EXPECT_EQ(refusal(*server, *client), RefuseReason::insecure_not_allowed);
}

TEST(Ipv6, ATokenOfAnotherMatchIsRefusedForThatReason) {
  LKS_NEEDS_IPV6();
  if (!security_available()) GTEST_SKIP() << "no libsodium";
  const auto server = listening(options_of_match(k_match + 1));
  const auto socket = std::move(EnetTransport::open(options_of_match(k_match))).value();
  TestRandom random(6);
  const auto client = join_securely(*socket, 0, random);
  ASSERT_TRUE(socket->connect("::1", server->port()).ok());
  EXPECT_EQ(refusal(*server, *client), RefuseReason::wrong_match);
}

TEST(Ipv6, WaitsForADatagramOfEitherKind) {
  LKS_NEEDS_IPV6();
  for (const char* address : {"127.0.0.1", "::1"}) {
    const auto server = listening({.bind_address = "::"});
    EXPECT_FALSE(server->wait(0));
    EXPECT_FALSE(server->wait(1000));
    const auto client = std::move(EnetTransport::open({})).value();
    EXPECT_TRUE(client->connect(address, server->port()).ok());
    TransportEvent event;
    static_cast<void>(client->poll(0, event));
    EXPECT_TRUE(server->wait(60'000'000)) << address;
    EXPECT_TRUE(server->wait(0)) << address;
    EXPECT_FALSE(server->poll(0, event));
    EXPECT_TRUE(client->wait(60'000'000)) << address;
    EXPECT_FALSE(server->wait(0)) << address;  // though it has sent
  }
}

TEST(Ipv6, AnAddressOfOneKindTakesNoOther) {
  LKS_NEEDS_IPV6();
  const auto server = listening({.bind_address = "::1"});
  const auto other = std::move(relay::UdpSocket::open({0x7f000001, 0})).value();
  static_cast<void>(
      other->send(relay::Endpoint::loopback(server->port()), open_connect(std::byte{1})));
  EXPECT_FALSE(server->wait(1000));
  EXPECT_EQ(server->counters().datagrams, 0U);
}

TEST(Ipv6, OneClientCallsBothKindsInTurn) {
  LKS_NEEDS_IPV6();
  const auto server = listening({.bind_address = "::"});
  const auto client = std::move(EnetTransport::open({})).value();
  for (const char* address : {"::1", "127.0.0.1", "::1", "::ffff:127.0.0.1"}) {
    const ConnectionId called = client->connect(address, server->port()).value();
    TransportEvent event, heard;
    lockstone::test::await([&] {
      static_cast<void>(server->poll(0, event));
      return client->poll(0, heard);
    });
    EXPECT_EQ(heard.kind, TransportEventKind::connected) << address;
    EXPECT_EQ(heard.connection, called) << address;
  }
}

// An address of this machine beside ::1, none of one link only; nothing where there is none.
std::optional<std::string> other_address() {
  std::ifstream list("/proc/net/if_inet6");
  for (std::string line; std::getline(list, line);) {
    DatagramSource source;
    const bool read = from_hexadecimal(line.substr(0, 32), source.address) == Status::ok;
    const std::string text = ipv6_to_text(source.address);
    if (read && text != "::1" && text.rfind("fe80:", 0) != 0) return text;
  }
  return std::nullopt;
}

TEST(Ipv6, AnswersComeFromTheAddressThatWasCalled) {
  LKS_NEEDS_IPV6();
  const std::optional<std::string> address = other_address();
  if (!address) GTEST_SKIP() << "no IPv6 address of this machine but ::1";
  const auto server = listening({.bind_address = "::"});
  const auto client = open_loopback6();  // to which the system answers from ::1
  const DatagramSource called = *read_ipv6(*address, server->port());
  client->send(called, open_connect(std::byte{1}));
  poll_until_judged(*server, 0, 0);
  std::array<std::byte, 2048> buffer{};
  DatagramSource from;
  ASSERT_TRUE(client->receive(from, buffer).has_value());
  EXPECT_EQ(ipv6_to_text(from.address), *address);
}

TEST(Ipv6, AnAddressThatCannotBeBoundIsNamed) {
  LKS_NEEDS_IPV6();
  const auto first = listening({.bind_address = "::1"});
  std::string problem;
  EnetOptions options{.bind_address = "::1", .port = first->port()};
  EXPECT_EQ(EnetTransport::listen(options, &problem).status(), Status::io_error);
  EXPECT_EQ(problem, "[::1]:" + std::to_string(first->port()) + ": Address already in use");
  for (const char* text : {"localhost", "[::1]", "::1::", ""}) {
    EXPECT_EQ(EnetTransport::listen({.bind_address = text}, &problem).status(),
              Status::invalid_argument)
        << text;
    EXPECT_NE(problem.find("not a numeric address"), std::string::npos);
  }
}

TEST(Ipv6, AllAddressesMeansBothKindsOnOnePort) {
  LKS_NEEDS_IPV6();
  const auto first = listening({.bind_address = "::"});
  for (const char* text : {"0.0.0.0", "::"}) {
    const EnetOptions options{.bind_address = text, .port = first->port()};
    EXPECT_EQ(EnetTransport::listen(options).status(), Status::io_error) << text;
  }
}

}  // namespace
}  // namespace lockstone::net::test
