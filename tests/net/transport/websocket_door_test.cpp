// Hostile peers of a WebSocket server: none of them takes all its places, its memory or its time.
#include <memory>
#include <vector>

#include "net/transport/websocket/packet_message.h"
#include "tests/net/transport/websocket_support.h"

namespace lockstone::net::test {
namespace {

// Polls until the peer has been closed; no event but `disconnected` may come.
void expect_closed(WebSocketTransport& server, RudePeer& peer, bool was_in) {
  bool told = false;
  std::int64_t now_us = 0;
  lockstone::test::await([&] {
    TransportEvent event;
    if (server.poll(now_us += 50'000, event)) {
      EXPECT_EQ(event.kind, TransportEventKind::disconnected);
      EXPECT_FALSE(std::exchange(told, true));
    }
    static_cast<void>(peer.heard());
    return peer.closed;
  });
  EXPECT_EQ(told, was_in);
}

TEST(WebSocketDoor, BadFramesEndTheConnection) {
  struct Case {
    const char* name;
    unsigned first;  // of the frame
    std::uint64_t claimed;
    std::string payload;
  };
  const std::vector<Case> cases{
      {"text", 0x81, 5, "hello"},
      {"empty", 0x82, 0, ""},
      {"no payload", 0x82, 1, std::string(1, '\0')},
      {"unknown channel", 0x82, 2, "\x02z"},
      {"long unreliable", 0x82, 3000, std::string(1, '\1') + std::string(2999, 'z')},
      {"too long", 0x82, k_max_websocket_bytes + 1, std::string(k_max_websocket_bytes + 1, '\0')},
      {"empty piece", 0x02, 0, ""},
      {"reserved opcode", 0x83, 2, "\0z"},
      {"reserved bits", 0xf2, 2, "\0z"},
  };
  const auto server = websocket_server();
  for (const Case& bad : cases) {
    SCOPED_TRACE(bad.name);
    RudePeer peer(server->port());
    let_in(*server, peer);
    peer.frame(bad.first, bad.claimed, bad.payload);
    expect_closed(*server, peer, true);
  }
}

TEST(WebSocketDoor, AFrameThatClaimsTheWholeMemoryGetsNone) {
  const auto server = websocket_server();
  RudePeer peer(server->port());
  let_in(*server, peer);
  peer.frame(0x82, std::uint64_t{1} << 60, std::string(64 * 1024, '\0'));
  expect_closed(*server, peer, true);
}

TEST(WebSocketDoor, GarbageInsteadOfAHandshakeIsClosed) {
  const auto server = websocket_server();
  for (const std::string& garbage :
       {std::string(5000, '\xff'), std::string("\r\n\r\n\r\n"), std::string(20000, 'A'),
        std::string("GET / HTTP/1.1\r\n\r\n"), std::string("POST / HTTP/9\r\nX: y\r\n\r\n")}) {
    RudePeer peer(server->port());
    peer.say(garbage);
    bool closed = false;
    std::int64_t now_us = 0;
    lockstone::test::await([&] {
      TransportEvent event;
      EXPECT_FALSE(server->poll(now_us += 10'000, event));
      static_cast<void>(peer.heard());
      closed = peer.closed;
      return closed;
    });
  }
  EXPECT_EQ(server->counters().opened, 0U);
}

TEST(WebSocketDoor, AnotherSubprotocolIsRefused) {
  const auto server = websocket_server();
  for (const char* protocol : {"chat", ""}) {
    RudePeer peer(server->port());
    peer.shake_hands(protocol);
    expect_closed(*server, peer, false);
  }
}

TEST(WebSocketDoor, PagesOfOtherOriginsAreRefused) {
  WebSocketOptions options;
  options.origins = {"https://game.example"};
  const auto server = websocket_server(options);
  RudePeer foreign(server->port());
  foreign.shake_hands("lockstone", "https://evil.example");
  expect_closed(*server, foreign, false);
  EXPECT_EQ(server->counters().wrong_origin, 1U);
  RudePeer own(server->port());
  own.shake_hands("lockstone", "https://game.example");
  TransportEvent event;
  lockstone::test::await([&] { return server->poll(0, event); });
  EXPECT_EQ(event.kind, TransportEventKind::connected);
}

TEST(WebSocketDoor, HalfAHandshakeHoldsItsPlaceForFiveSeconds) {
  const auto server = websocket_server();
  RudePeer peer(server->port());
  peer.say("GET / HTTP/1.1\r\nHost: x\r\n");
  TransportEvent event;
  lockstone::test::await([&] {
    EXPECT_FALSE(server->poll(0, event));
    return server->counters().callers == 1;
  });
  EXPECT_FALSE(server->poll(4'900'000, event));
  static_cast<void>(peer.heard());
  EXPECT_FALSE(peer.closed);
  EXPECT_FALSE(server->poll(5'000'000, event));
  lockstone::test::await([&] {
    static_cast<void>(peer.heard());
    return peer.closed;
  });
  EXPECT_EQ(server->counters().handshakes_late, 1U);
}

TEST(WebSocketDoor, OneAddressCannotTakeAllPlaces) {
  const auto server = websocket_server();
  std::vector<std::unique_ptr<RudePeer>> peers;
  for (int i = 0; i < 20; ++i)
    peers.push_back(std::make_unique<RudePeer>(server->port()));
  lockstone::test::await([&] {
    TransportEvent event;
    EXPECT_FALSE(server->poll(0, event));
    return server->counters().callers == 20;
  });
  EXPECT_EQ(server->counters().crowded, 20U - WebSocketOptions{}.max_strangers_per_address);
}

TEST(WebSocketDoor, AFloodEndsTheConnectionAndSaysWhy) {
  WebSocketPair pair;
  for (int i = 0; i < 2000; ++i) {
    static_cast<void>(pair.client->send(pair.called, Channel::reliable, bytes_of_text("x")));
    if (i % 100 == 0) pair.client->flush();
  }
  TransportEvent event, heard;
  RefuseReason here = RefuseReason::none, there = RefuseReason::none;
  lockstone::test::await([&] {
    while (pair.server->poll(0, event)) {
      if (event.kind == TransportEventKind::disconnected) here = event.reason;
    }
    while (pair.client->poll(0, heard)) {
      if (heard.kind == TransportEventKind::disconnected) there = heard.reason;
    }
    return here != RefuseReason::none && there != RefuseReason::none;
  });
  EXPECT_EQ(here, RefuseReason::flooding);
  EXPECT_EQ(there, RefuseReason::flooding);
  EXPECT_EQ(pair.server->counters().floods, 1U);
}

// A peer that reads nothing: the server keeps as much as it may, then ends the connection.
TEST(WebSocketDoor, ASlowPeerCostsBoundedMemory) {
  WebSocketOptions options;
  options.max_outgoing_bytes = 256 * 1024;
  const auto server = websocket_server(options);
  const RudePeer peer(server->port());
  const ConnectionId connection = let_in(*server, peer);
  const std::vector<std::byte> packet(k_max_reliable_bytes);
  Status status = Status::ok;
  for (int i = 0; i < 1000 && status == Status::ok; ++i) {
    status = server->send(connection, Channel::reliable, packet);
    server->flush();
    EXPECT_LE(server->waiting_bytes(connection), options.max_outgoing_bytes + 4096);
  }
  EXPECT_EQ(status, Status::capacity_exhausted);
  TransportEvent event;
  ASSERT_TRUE(server->poll(0, event));
  EXPECT_EQ(event.kind, TransportEventKind::disconnected);
  EXPECT_EQ(server->counters().slow, 1U);
  EXPECT_FALSE(server->poll(3'000'000, event));
}

// Random frames, whole and torn, of peers that come and go. The server lives, and takes an honest
// peer afterwards.
TEST(WebSocketDoor, RandomFramesLeaveTheServerAtWork) {
  WebSocketOptions options;
  options.limits = DatagramLimits::none();
  const auto server = websocket_server(options);
  std::uint64_t state = 20261126;
  const auto draw = [&state](std::uint64_t below) {
    state = state * 6364136223846793005U + 1442695040888963407U;
    return (state >> 33) % below;
  };
  for (int round = 0; round < 300; ++round) {
    RudePeer peer(server->port());
    TransportEvent event;
    if (draw(4) != 0) peer.shake_hands();
    for (std::uint64_t frames = draw(6); frames > 0; --frames) {
      std::string payload(draw(200), '\0');
      for (char& byte : payload)
        byte = static_cast<char>(draw(256));
      const std::uint64_t claimed = draw(3) == 0 ? draw(100'000) : payload.size();
      peer.frame(static_cast<unsigned>(draw(3) == 0 ? draw(256) : 0x82), claimed, payload);
      static_cast<void>(server->poll(0, event));
    }
    for (int i = 0; i < 5; ++i)
      static_cast<void>(server->poll(0, event));
  }
  WebSocketPair pair;
  RudePeer honest(server->port());
  honest.shake_hands();
  lockstone::test::await([&] {
    TransportEvent event;
    static_cast<void>(server->poll(0, event));
    return honest.heard().find("101") != std::string::npos;
  });
}

}  // namespace
}  // namespace lockstone::net::test
