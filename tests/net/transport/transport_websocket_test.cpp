// Packets over WebSockets, between two ends that keep the rules.
#include "tests/net/transport/websocket_support.h"

namespace lockstone::net::test {
namespace {

TEST(WebSocket, CarriesPacketsOfBothChannelsInBothDirections) {
  WebSocketPair pair;
  EXPECT_EQ(pair.client->send(pair.called, Channel::reliable, bytes_of_text("hello")), Status::ok);
  pair.client->flush();
  TransportEvent event = pair.next(*pair.server);
  EXPECT_EQ(event.kind, TransportEventKind::received);
  EXPECT_EQ(event.connection, pair.taken);
  EXPECT_EQ(event.channel, Channel::reliable);
  EXPECT_EQ(text_of(event.bytes), "hello");
  EXPECT_EQ(pair.server->send(pair.taken, Channel::unreliable, bytes_of_text("welcome")),
            Status::ok);
  pair.server->flush();
  event = pair.next(*pair.client);
  EXPECT_EQ(event.connection, pair.called);
  EXPECT_EQ(event.channel, Channel::unreliable);
  EXPECT_EQ(text_of(event.bytes), "welcome");
  EXPECT_EQ(pair.server->stats(pair.taken).bytes_received, 5U);
  EXPECT_EQ(pair.server->stats(pair.taken).bytes_sent, 7U);
}

TEST(WebSocket, TheLongestPacketOfEachChannelPassesAndNoLongerOne) {
  WebSocketPair pair;
  pair.server->trust(pair.taken);
  for (const Channel channel : {Channel::reliable, Channel::unreliable}) {
    const std::size_t most = k_carrier_reserve_bytes + (channel == Channel::reliable
                                                            ? k_max_reliable_bytes
                                                            : k_max_datagram_bytes);
    std::vector<std::byte> bytes(most, std::byte{7});
    EXPECT_EQ(pair.client->send(pair.called, channel, bytes), Status::ok);
    EXPECT_EQ(pair.next(*pair.server).bytes.size(), most);
    bytes.emplace_back();
    EXPECT_EQ(pair.client->send(pair.called, channel, bytes), Status::invalid_argument);
  }
  EXPECT_EQ(pair.client->send(pair.called, Channel::reliable, {}), Status::invalid_argument);
}

TEST(WebSocket, PacketsComeInTheOrderOfSending) {
  WebSocketPair pair;
  pair.server->trust(pair.taken);
  for (int i = 0; i < 200; ++i) {
    const std::vector<std::byte> bytes(1000, static_cast<std::byte>(i));
    ASSERT_EQ(pair.client->send(pair.called, Channel::reliable, bytes), Status::ok);
  }
  for (int i = 0; i < 200; ++i)
    EXPECT_EQ(pair.next(*pair.server).bytes.front(), static_cast<std::byte>(i));
}

TEST(WebSocket, AnEndedConnectionSendsTheRestAndSaysNoMore) {
  WebSocketPair pair;
  EXPECT_EQ(pair.server->send(pair.taken, Channel::reliable, bytes_of_text("farewell")),
            Status::ok);
  pair.server->disconnect(pair.taken);
  EXPECT_EQ(pair.server->send(pair.taken, Channel::reliable, bytes_of_text("no")),
            Status::stale_handle);
  EXPECT_EQ(text_of(pair.next(*pair.client).bytes), "farewell");
  EXPECT_EQ(pair.next(*pair.client).kind, TransportEventKind::disconnected);
  TransportEvent event;
  EXPECT_FALSE(pair.server->poll(0, event));
}

TEST(WebSocket, TheOtherEndHearsOfAClientThatIsGone) {
  WebSocketPair pair;
  pair.client.reset();
  TransportEvent event;
  lockstone::test::await([&] { return pair.server->poll(0, event); });
  EXPECT_EQ(event.kind, TransportEventKind::disconnected);
  EXPECT_EQ(event.connection, pair.taken);
  EXPECT_EQ(pair.server->stats(pair.taken).bytes_sent, 0U);
}

TEST(WebSocket, ACallToNobodyEndsWithAnEvent) {
  const auto client = std::move(WebSocketTransport::open({})).value();
  std::uint16_t free = 0;
  { free = websocket_server()->port(); }
  const auto called = client->connect("ws://127.0.0.1:" + std::to_string(free) + "/");
  ASSERT_TRUE(called.ok());
  TransportEvent event;
  lockstone::test::await([&] { return client->poll(0, event); });
  EXPECT_EQ(event.kind, TransportEventKind::disconnected);
  EXPECT_EQ(event.connection, called.value());
}

TEST(WebSocket, AnAddressOfAnotherKindIsRefused) {
  const auto client = std::move(WebSocketTransport::open({})).value();
  for (const char* url : {"", "http://127.0.0.1:1/", "127.0.0.1", "ftp://x"})
    EXPECT_EQ(client->connect(url).status(), Status::invalid_argument) << url;
}

TEST(WebSocket, APortInUseIsNamed) {
  const auto first = websocket_server();
  WebSocketOptions options;
  options.port = first->port();
  std::string problem;
  EXPECT_EQ(WebSocketTransport::listen(options, &problem).status(), Status::io_error);
  EXPECT_EQ(problem, "127.0.0.1:" + std::to_string(first->port()) + ": Address already in use");
}

TEST(WebSocket, ACertificateThatIsNoneIsRefused) {
  WebSocketOptions options;
  options.certificate_file = options.key_file = "/dev/null";
  std::string problem;
  EXPECT_EQ(WebSocketTransport::listen(options, &problem).status(), Status::io_error);
  EXPECT_NE(problem.find("certificate"), std::string::npos);
  options.key_file.clear();
  EXPECT_EQ(WebSocketTransport::listen(options).status(), Status::invalid_argument);
}

TEST(WebSocket, PingsMeasureTheRoundTrip) {
  WebSocketPair pair;
  EXPECT_EQ(pair.server->stats(pair.taken).round_trip_us, -1);
  lockstone::test::await([&] {
    TransportEvent event;
    pair.now_us += 10'000;
    static_cast<void>(pair.server->poll(pair.now_us, event));
    static_cast<void>(pair.client->poll(pair.now_us, event));
    return pair.server->stats(pair.taken).round_trip_us >= 0;
  });
  EXPECT_GE(pair.now_us, WebSocketOptions{}.ping_us);
}

TEST(WebSocket, SilenceEndsAConnection) {
  WebSocketPair pair;
  const std::int64_t idle_us = WebSocketOptions{}.idle_us;
  TransportEvent event;
  EXPECT_FALSE(pair.server->poll(idle_us - 1, event));
  lockstone::test::await([&] { return pair.server->poll(idle_us + 100'000, event); });
  EXPECT_EQ(event.kind, TransportEventKind::disconnected);
  EXPECT_EQ(pair.server->counters().idle, 1U);
}

TEST(WebSocket, OldUnreliablePacketsGiveWayToNewerOnes) {
  WebSocketPair pair;
  for (int i = 0; i < 100; ++i) {
    const std::vector<std::byte> bytes(10, static_cast<std::byte>(i));
    ASSERT_EQ(pair.server->send(pair.taken, Channel::unreliable, bytes), Status::ok);
  }
  EXPECT_EQ(pair.server->counters().unreliable_dropped, 84U);
  EXPECT_EQ(pair.next(*pair.client).bytes.front(), std::byte{84});
}

}  // namespace
}  // namespace lockstone::net::test
