// A changed client: it plays by the rules, but its reports about its states are false.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>

#include <lockstone/net/transport.h>
#include <lockstone/net/wire.h>

namespace lockstone::simnet {

enum class Lie : std::uint8_t {
  none,
  once,         ///< one wrong hash
  always,       ///< every hash is wrong
  alternately,  ///< every second one is
  parts,        ///< only the 128 bits a part are wrong
  silence,      ///< no hashes at all
  future,       ///< hashes of ticks that are not confirmed yet
  dumps,        ///< true hashes, and dumps that nobody asked for
};
inline constexpr std::size_t k_lies = 8;

[[nodiscard]] std::string_view to_string(Lie lie);
[[nodiscard]] std::optional<Lie> parse_lie(std::string_view text);

/// Between a client and its transport. It never gives a dump of its state.
class LyingTransport final : public net::Transport {
 public:
  /// Lies from tick `from` on.
  LyingTransport(net::Transport& carrier, Lie lie, std::uint64_t from, std::uint8_t input_bytes)
      : carrier_(carrier), lie_(lie), from_(from), input_bytes_(input_bytes) {}

  bool poll(std::int64_t now_us, net::TransportEvent& event) override {
    return carrier_.poll(now_us, event);
  }
  Status send(net::ConnectionId connection, net::Channel channel, ByteView bytes) override;
  void flush() override { carrier_.flush(); }
  void disconnect(net::ConnectionId connection) override { carrier_.disconnect(connection); }
  [[nodiscard]] net::TransportStats stats(net::ConnectionId connection) const override {
    return carrier_.stats(connection);
  }
  [[nodiscard]] bool secure() const override { return carrier_.secure(); }
  [[nodiscard]] net::PeerIdentity identity(net::ConnectionId connection) const override {
    return carrier_.identity(connection);
  }

 private:
  [[nodiscard]] bool lies_at(std::uint64_t tick) const;
  Status send_inputs(net::ConnectionId connection, net::Channel channel, ByteView bytes);
  Status send_parts(net::ConnectionId connection, net::Channel channel, ByteView bytes);
  void flood(net::ConnectionId connection);

  net::Transport& carrier_;
  Lie lie_;
  std::uint64_t from_;
  std::uint8_t input_bytes_;
  std::array<std::byte, net::k_max_chunk_bytes + 256> out_{};
};

}  // namespace lockstone::simnet
