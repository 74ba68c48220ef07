// The data that the parts of an EnetTransport share. Behaviour of ENet relied upon:
// http://enet.bespin.org/ (1.3.17), "Features and Architecture".
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <memory>
#include <optional>
#include <string>

#include <enet/enet.h>

#include <lockstone/net/transport_enet.h>

#include "net/transport/enet/enet_commands.h"
#include "net/transport/enet/enet_datagram.h"
#include "net/transport/udp/datagram_source.h"
#include "net/transport/udp/ipv6_side.h"

namespace lockstone::net {

inline constexpr std::size_t k_channels = k_enet_channels;
static_assert(k_enet_mtu == ENET_HOST_DEFAULT_MTU);
static_assert(k_enet_window_bytes == ENET_PROTOCOL_MAXIMUM_WINDOW_SIZE);
static_assert(k_enet_throttle_interval_ms == ENET_PEER_PACKET_THROTTLE_INTERVAL);
static_assert(k_enet_throttle_acceleration == ENET_PEER_PACKET_THROTTLE_ACCELERATION);
static_assert(k_enet_throttle_deceleration == ENET_PEER_PACKET_THROTTLE_DECELERATION);
static_assert(CommandFilter::k_max_commands == ENET_PROTOCOL_MAXIMUM_PACKET_COMMANDS);

inline Word raw_word(enet_uint32 value) {
  Word word;
  std::memcpy(word.data(), &value, word.size());
  return word;
}

inline enet_uint32 raw_value(const Word& word) {
  enet_uint32 value = 0;
  std::memcpy(&value, word.data(), word.size());
  return value;
}

/// The checksum in a datagram.
inline Word word_of(ByteView datagram, const DatagramHead& head) {
  Word word;
  std::memcpy(word.data(), datagram.data() + head.checksum_offset, word.size());
  return word;
}

[[nodiscard]] DatagramSource source_of(const ENetAddress& address);

/// Reads `127.0.0.1` and `::ffff:127.0.0.1`. False for another text.
[[nodiscard]] bool read_ipv4(const std::string& text, std::uint16_t port, ENetAddress& address);

struct EnetData {
  SocketLibrary library;  ///< before the host
  ENetHost* host = nullptr;
  bool listens = false;  ///< takes connections; otherwise it only calls others
  std::int64_t now_us = 0;
  EnetCounters counters;
  LinkChecksum checksum{std::nullopt};
  std::uint32_t match_tag = 0;
  const OpenMatches* matches = nullptr;  ///< null: the one of `checksum` and `match_tag`
  DatagramSource source;                 ///< of the datagram that is judged
  std::unique_ptr<Ipv6Side> ipv6;        ///< null: IPv4 only
};

}  // namespace lockstone::net
