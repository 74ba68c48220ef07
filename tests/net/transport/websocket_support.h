// WebSockets over the loopback: both ends of one, and a peer that says whatever it likes.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstring>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

#include <arpa/inet.h>
#include <fcntl.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <gtest/gtest.h>

#include <lockstone/net/transport_websocket.h>

#include "tests/support/await.h"

namespace lockstone::net::test {

inline std::unique_ptr<WebSocketTransport> websocket_server(const WebSocketOptions& options = {}) {
  auto made = WebSocketTransport::listen(options);
  EXPECT_TRUE(made.ok());
  return std::move(made).value();
}

inline std::string url_of(const WebSocketTransport& server) {
  return "ws://127.0.0.1:" + std::to_string(server.port()) + "/";
}

inline std::vector<std::byte> bytes_of_text(std::string_view text) {
  std::vector<std::byte> bytes(text.size());
  std::memcpy(bytes.data(), text.data(), text.size());
  return bytes;
}

inline std::string text_of(ByteView bytes) {
  return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
}

/// A server with one client that is in.
struct WebSocketPair {
  explicit WebSocketPair(const WebSocketOptions& options = {})
      : server(websocket_server(options)),
        client(std::move(WebSocketTransport::open({})).value()) {
    called = client->connect(url_of(*server)).value();
    bool here = false, there = false;
    lockstone::test::await([&] {
      TransportEvent event;
      if (server->poll(now_us, event)) {
        here = event.kind == TransportEventKind::connected;
        taken = event.connection;
      }
      if (client->poll(now_us, event)) there = event.kind == TransportEventKind::connected;
      return here && there;
    });
  }

  /// The next event of either, while both are polled.
  TransportEvent next(WebSocketTransport& side) {
    TransportEvent event, other;
    lockstone::test::await([&] {
      WebSocketTransport& peer = &side == server.get() ? *client : *server;
      static_cast<void>(peer.poll(now_us, other));
      return side.poll(now_us, event);
    });
    return event;
  }

  std::unique_ptr<WebSocketTransport> server, client;
  ConnectionId called = k_no_connection;  ///< the client's number
  ConnectionId taken = k_no_connection;   ///< the server's
  std::int64_t now_us = 0;
};

/// Speaks TCP, and WebSockets by hand.
class RudePeer {
 public:
  explicit RudePeer(std::uint16_t port) : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(port);
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    EXPECT_EQ(::connect(socket_, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    ::fcntl(socket_, F_SETFL, O_NONBLOCK);
  }
  ~RudePeer() { ::close(socket_); }
  RudePeer(const RudePeer&) = delete;
  RudePeer& operator=(const RudePeer&) = delete;

  void say(std::string_view text) const {
    static_cast<void>(::send(socket_, text.data(), text.size(), MSG_NOSIGNAL));
  }

  void shake_hands(std::string_view protocol = "lockstone", std::string_view origin = {}) const {
    std::string text =
        "GET / HTTP/1.1\r\nHost: localhost\r\nUpgrade: websocket\r\nConnection: Upgrade\r\n"
        "Sec-WebSocket-Key: dGhlIHNhbXBsZSBub25jZQ==\r\nSec-WebSocket-Version: 13\r\n";
    if (!protocol.empty()) text += "Sec-WebSocket-Protocol: " + std::string(protocol) + "\r\n";
    if (!origin.empty()) text += "Origin: " + std::string(origin) + "\r\n";
    say(text + "\r\n");
  }

  /// A frame that claims `claimed` bytes and has those of `payload`; masked with zeros.
  void frame(unsigned first, std::uint64_t claimed, std::string_view payload) const {
    std::string text(1, static_cast<char>(first));
    if (claimed < 126) {
      text.push_back(static_cast<char>(0x80 | claimed));
    } else {
      text.push_back(static_cast<char>(0xff));
      for (int shift = 56; shift >= 0; shift -= 8)
        text.push_back(static_cast<char>(claimed >> shift));
    }
    text.append(4, '\0');
    say(text.append(payload));
  }

  /// All that has come so far; `closed` says whether the end has.
  std::string heard() {
    std::array<char, 4096> buffer{};
    for (;;) {
      const ssize_t size = ::recv(socket_, buffer.data(), buffer.size(), 0);
      if (size == 0) closed = true;
      if (size < 0 && errno == ECONNRESET) closed = true;
      if (size <= 0) return heard_;
      heard_.append(buffer.data(), static_cast<std::size_t>(size));
    }
  }

  bool closed = false;

 private:
  int socket_;
  std::string heard_;
};

/// Until the peer is in.
inline ConnectionId let_in(WebSocketTransport& server, const RudePeer& peer) {
  peer.shake_hands();
  TransportEvent event;
  lockstone::test::await([&] { return server.poll(0, event); });
  EXPECT_EQ(event.kind, TransportEventKind::connected);
  return event.connection;
}

}  // namespace lockstone::net::test
