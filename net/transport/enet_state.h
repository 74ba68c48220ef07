// The inside of EnetTransport: the gate in front of ENet, and the translation of its events.
// Behaviour relied upon: http://enet.bespin.org/ (1.3.17), "Features and Architecture".
#pragma once

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <vector>

#include <enet/enet.h>

#include <lockstone/net/transport_enet.h>

#include "net/transport/enet_commands.h"
#include "net/transport/enet_datagram.h"
#include "net/transport/flood_watch.h"
#include "net/transport/ipv6_side.h"
#include "net/transport/refusal_limit.h"

namespace lockstone::net {

inline constexpr std::size_t k_channels = k_enet_channels;
static_assert(k_enet_mtu == ENET_HOST_DEFAULT_MTU);
static_assert(k_enet_window_bytes == ENET_PROTOCOL_MAXIMUM_WINDOW_SIZE);
static_assert(k_enet_throttle_interval_ms == ENET_PEER_PACKET_THROTTLE_INTERVAL);
static_assert(k_enet_throttle_acceleration == ENET_PEER_PACKET_THROTTLE_ACCELERATION);
static_assert(k_enet_throttle_deceleration == ENET_PEER_PACKET_THROTTLE_DECELERATION);
static_assert(CommandFilter::k_max_commands == ENET_PROTOCOL_MAXIMUM_PACKET_COMMANDS);
inline constexpr std::size_t k_max_connections = 1024;
inline constexpr std::uint32_t k_index_bits = 10;  // of a ConnectionId; the rest is the generation
inline constexpr std::uint32_t k_index_mask = (1U << k_index_bits) - 1;

// A session counts its own time-outs; ENet's, in which this plays a part, shall not be the first.
inline constexpr std::uint32_t k_timeout_doublings = 32;
// But a connection that was asked for and never confirmed holds a place.
inline constexpr std::int64_t k_half_open_us = 2'000'000;
// A stranger that was sent away need not confirm that it heard why.
inline constexpr std::int64_t k_farewell_us = 2'000'000;
// ENet ends a round of receiving after this many datagrams, and at each that is empty or longer
// than its buffer.
inline constexpr unsigned k_enet_datagrams_a_round = 256;
inline constexpr unsigned k_max_cut_rounds_a_poll = 64;

inline constexpr std::int64_t k_longest_wait_us = 3'600'000'000;

inline constexpr std::size_t k_remembered_connects = 1024;
// Anybody who sees a request can refuse it: that counts where the server says nothing for so long.
// ENet asks again after 0.5 s and 1.5 s.
inline constexpr std::int64_t k_refusal_patience_us = 2'000'000;

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

[[nodiscard]] DatagramSource source_of(const ENetAddress& address);

/// Reads `127.0.0.1` and `::ffff:127.0.0.1`. False for another text.
[[nodiscard]] bool read_ipv4(const std::string& text, std::uint16_t port, ENetAddress& address);

struct EnetTransport::State {
  struct Entry {
    ENetPeer* peer = nullptr;
    DatagramSource remote;  ///< the peer's address; ENet's own record of it holds IPv4 only
    std::uint32_t generation = 1;
    bool open = false;
    bool trusted = false;
    bool closing = false;       ///< this side has ended it; the peer has yet to confirm that
    std::int64_t since_us = 0;  ///< when it was asked for, or when it began to close
    RefuseReason ending = RefuseReason::none;   ///< the session is about to hear of this
    RefuseReason hearsay = RefuseReason::none;  ///< why it was refused, by a word of unknown origin
    std::int64_t hearsay_us = 0;                ///< when that came
    CommandFilter commands;
    DatagramSeal seal;
    FloodWatch datagrams;
    FloodWatch packets;  ///< of which one datagram may hold many
    TransportStats stats;
  };

  SocketLibrary library;
  ENetHost* host = nullptr;
  ENetPacket* current = nullptr;
  std::uint32_t timeout_ms = 0;
  std::vector<Entry> entries;  // by ENet's peer number

  LinkChecksum checksum;
  LinkChecksum open_checksum{std::nullopt};
  DatagramLimits limits;
  std::uint32_t match_tag;
  std::size_t places_per_address;
  std::size_t strangers_per_address;
  bool listens = false;
  ConnectMemory connects{k_remembered_connects};
  RefusalLimit refusals;
  std::int64_t now_us = 0;
  bool any_ending = false;
  EnetCounters counters;
  std::array<std::byte, ENET_PROTOCOL_MAXIMUM_MTU> gathered{};
  Word admitted{};                 // checksum of the datagram that ENet is about to read
  unsigned datagrams_a_round = 0;  // that ENet has taken
  DatagramSource source;           // of the datagram that the gate judges
  std::unique_ptr<Ipv6Side> ipv6;  // null: IPv4 only
  bool takes_ipv4 = true;          // false: bound to an IPv6 address

  explicit State(const EnetOptions& options)
      : timeout_ms(options.timeout_ms),
        entries(options.max_connections),
        checksum(options.link_key),
        limits(options.limits),
        match_tag(options.match_tag),
        places_per_address(options.max_connections_per_address),
        strangers_per_address(options.max_strangers_per_address) {}
  State(const State&) = delete;
  State& operator=(const State&) = delete;

  ~State() {
    release_current();
    if (host != nullptr) enet_host_destroy(host);
  }

  void release_current() {
    if (current != nullptr) enet_packet_destroy(current);
    current = nullptr;
  }

  [[nodiscard]] std::size_t index_of(const ENetPeer* peer) const {
    return static_cast<std::size_t>(peer - host->peers);
  }

  [[nodiscard]] ConnectionId id_of(std::size_t index) const {
    return (entries[index].generation << k_index_bits) | static_cast<std::uint32_t>(index);
  }

  [[nodiscard]] Entry* find(ConnectionId connection) {
    const std::size_t index = connection & k_index_mask;
    if (index >= entries.size() || !entries[index].open) return nullptr;
    return id_of(index) == connection ? &entries[index] : nullptr;
  }

  ConnectionId adopt(ENetPeer* peer) {
    const std::size_t index = index_of(peer);
    Entry& entry = entries[index];
    entry.peer = peer;
    entry.open = true;
    entry.ending = RefuseReason::none;
    entry.stats = {};
    if (!listens) prepare(entry);
    // 22 bits of generation, never zero, so that no id is k_no_connection.
    entry.generation = entry.generation + 1 >= (1U << 22) ? 1 : entry.generation + 1;
    enet_peer_timeout(peer, k_timeout_doublings, timeout_ms, timeout_ms);
    return id_of(index);
  }

  // False for events that the session must not see, such as the end of a connection that it ended.
  bool translate(const ENetEvent& from, TransportEvent& event) {
    const std::size_t index = index_of(from.peer);
    Entry& entry = entries[index];
    event = {};
    if (from.type == ENET_EVENT_TYPE_CONNECT) {
      event.kind = TransportEventKind::connected;
      event.connection = entry.open ? id_of(index) : adopt(from.peer);
      // Not before: ENet refuses a connection whose first datagram carries this as well.
      enet_peer_throttle_configure(from.peer, ENET_PEER_PACKET_THROTTLE_INTERVAL,
                                   ENET_PEER_PACKET_THROTTLE_ACCELERATION, 0);
      return true;
    }
    if (from.type == ENET_EVENT_TYPE_RECEIVE) current = from.packet;
    if (from.type == ENET_EVENT_TYPE_DISCONNECT) entry.closing = false;
    if (!entry.open) return false;
    event.connection = id_of(index);
    if (from.type == ENET_EVENT_TYPE_DISCONNECT) {
      entry.open = false;
      event.kind = TransportEventKind::disconnected;
      if (from.data <= static_cast<enet_uint32>(k_last_refuse_reason)) {
        event.reason = static_cast<RefuseReason>(from.data);
      }
      return true;
    }
    if (!entry.packets.admit(now_us, 0)) return beyond_limits(entry, entry.packets);
    event.kind = TransportEventKind::received;
    event.channel = from.channelID == 0 ? Channel::reliable : Channel::unreliable;
    event.bytes = std::as_bytes(std::span(current->data, current->dataLength));
    ++entry.stats.packets_received;
    entry.stats.bytes_received += current->dataLength;
    return true;
  }

  // Tells of one connection that a limit or a refusal ends.
  bool end_one(TransportEvent& event) {
    if (!any_ending) return false;
    for (std::size_t index = 0; index < entries.size(); ++index) {
      Entry& entry = entries[index];
      if (!entry.open || entry.ending == RefuseReason::none) continue;
      event = {};
      event.kind = TransportEventKind::disconnected;
      event.connection = id_of(index);
      event.reason = entry.ending;
      entry.open = false;
      // Told to the peer as well, unless it is the peer that refuses.
      if (entry.peer->state == ENET_PEER_STATE_CONNECTING) {
        enet_peer_reset(entry.peer);
      } else {
        enet_peer_disconnect(entry.peer, static_cast<enet_uint32>(entry.ending));
        begin_closing(entry);
      }
      return true;
    }
    any_ending = false;
    return false;
  }

  void begin_closing(Entry& entry) const {
    entry.closing = true;
    entry.since_us = now_us;
  }

  // ENet would keep a connection that was requested and never confirmed for 30 s, and a peer that
  // does not confirm the end of a connection for timeout_ms.
  void let_go_of_the_silent() {
    if (!listens) return believe_refusals();
    for (std::size_t i = 0; i < host->peerCount; ++i) {
      ENetPeer& peer = host->peers[i];
      Entry& entry = entries[i];
      const std::int64_t silent_us = now_us - entry.since_us;
      const bool half_open =
          peer.state == ENET_PEER_STATE_ACKNOWLEDGING_CONNECT && silent_us >= k_half_open_us;
      const bool sent_away = entry.closing && !entry.trusted && silent_us >= k_farewell_us;
      if (half_open || sent_away) free_place(i);
    }
  }

  void free_place(std::size_t index) {
    entries[index].closing = false;
    enet_peer_reset(&host->peers[index]);
  }

  // The gate: datagrams that ENet does not get to see.

  [[nodiscard]] bool admit(std::span<std::byte> datagram) {
    ++counters.datagrams;
    if (const auto refusal = decode_link_refusal(datagram)) {
      take_refusal(*refusal);
      return false;
    }
    const std::optional<DatagramHead> head = read_head(datagram);
    if (!head) {
      ++counters.malformed;
      return false;
    }
    return head->peer == k_no_peer ? admit_stranger(datagram, *head) : admit_peer(datagram, *head);
  }

  [[nodiscard]] bool admit_stranger(std::span<std::byte> datagram, const DatagramHead& head) {
    const std::optional<Word> connect = read_connect(datagram, head);
    if (!connect || !listens) {
      ++counters.strays;
      return false;
    }
    if (!checksum.verify(datagram, head, Word{})) {
      ++counters.forged;
      refuse(*connect, reason_against(datagram, head));
      return false;
    }
    if (!is_usual_connect(datagram.subspan(head.checksum_offset + sizeof(Word)))) {
      ++counters.malformed;
      return false;
    }
    if (!connects.admit(*connect, source) || is_taken_elsewhere(raw_value(*connect))) {
      ++counters.repeated_connects;
      return false;
    }
    admitted = word_of(datagram, head);
    return holds_place(raw_value(*connect)) || make_place();
  }

  static Word word_of(ByteView datagram, const DatagramHead& head) {
    Word word;
    std::memcpy(word.data(), datagram.data() + head.checksum_offset, word.size());
    return word;
  }

  [[nodiscard]] bool comes_from(const ENetPeer& peer) const {
    return entries[index_of(&peer)].remote == source;
  }

  // An id names one connection, since the keys of outgoing datagrams are found by it.
  [[nodiscard]] bool is_taken_elsewhere(enet_uint32 connect) const {
    return std::any_of(host->peers, host->peers + host->peerCount, [&](const ENetPeer& peer) {
      return peer.state != ENET_PEER_STATE_DISCONNECTED && peer.connectID == connect &&
             !comes_from(peer);
    });
  }

  // A request that ENet has taken already: its answer was lost.
  [[nodiscard]] bool holds_place(enet_uint32 connect) const {
    return std::any_of(host->peers, host->peers + host->peerCount, [&](const ENetPeer& peer) {
      return peer.state != ENET_PEER_STATE_DISCONNECTED && peer.connectID == connect &&
             comes_from(peer);
    });
  }

  // Prepares the place that ENet will give to the caller, the first that is free. Places of
  // connections that this side has ended are free as soon as somebody wants one.
  [[nodiscard]] bool make_place() {
    std::size_t neighbours = 0, strangers = 0;
    std::size_t free = entries.size(), oldest = entries.size();
    for (std::size_t i = entries.size(); i-- > 0;) {
      const ENetPeer& peer = host->peers[i];
      if (peer.state == ENET_PEER_STATE_DISCONNECTED) {
        free = i;
      } else if (entries[i].closing) {
        const bool older =
            oldest == entries.size() || entries[i].since_us < entries[oldest].since_us;
        if (older) oldest = i;
      } else if (from_one_site(entries[i].remote, source)) {
        ++neighbours;
        if (!entries[i].trusted) ++strangers;
      }
    }
    if (neighbours >= places_per_address || strangers >= strangers_per_address) {
      ++counters.crowded;
      return false;
    }
    if (free == entries.size() && oldest < entries.size()) free_place(free = oldest);
    if (free < entries.size()) {
      prepare(entries[free]);
      entries[free].remote = source;
    }
    return true;
  }

  void prepare(Entry& entry) const {
    entry.trusted = entry.closing = false;
    entry.since_us = now_us;
    entry.hearsay = RefuseReason::none;
    entry.commands = {};
    entry.seal = {};
    entry.datagrams = entry.packets = {};
    if (listens) limit(entry, limits.stranger_packets_per_second, limits.stranger_bytes_per_second);
  }

  [[nodiscard]] bool admit_peer(std::span<std::byte> datagram, const DatagramHead& head) {
    const ENetPeer* peer = head.peer < host->peerCount ? &host->peers[head.peer] : nullptr;
    const bool known = peer != nullptr && peer->state != ENET_PEER_STATE_DISCONNECTED &&
                       peer->state != ENET_PEER_STATE_ZOMBIE && comes_from(*peer);
    if (!known) {
      ++counters.strays;
      return false;
    }
    Entry& entry = entries[head.peer];
    if (!authenticate(entry, datagram, head)) return false;
    admitted = word_of(datagram, head);
    const auto bytes = static_cast<std::uint32_t>(datagram.size());
    if (!entry.datagrams.admit(now_us, bytes)) return beyond_limits(entry, entry.datagrams);
    const std::uint16_t delivered =
        peer->channels == nullptr ? 0 : peer->channels[0].incomingReliableSequenceNumber;
    const ByteView commands = datagram.subspan(head.checksum_offset + sizeof(Word));
    switch (entry.commands.admit(commands, delivered, !listens)) {
      case CommandFilter::Verdict::pass:
        return true;
      case CommandFilter::Verdict::malformed:
        ++counters.malformed;
        return false;
      case CommandFilter::Verdict::too_far:
        ++counters.too_far_ahead;
        return false;
    }
    return false;
  }

  // transport_enet.cpp: refusals, and the seals of connections that have keys of their own.
  void refuse(const Word& connect, RefuseReason reason);
  [[nodiscard]] RefuseReason reason_against(std::span<std::byte> request,
                                            const DatagramHead& head) const;
  void take_refusal(const LinkRefusal& refusal);
  void believe_refusals();
  [[nodiscard]] bool authenticate(Entry& entry, std::span<std::byte>& datagram,
                                  const DatagramHead& head);
  [[nodiscard]] Word finish(std::size_t size);
  [[nodiscard]] Entry* receiver_of(ByteView datagram, const DatagramHead& head);
  [[nodiscard]] Entry* entry_of(enet_uint32 connection);

  static void limit(Entry& entry, std::uint32_t packets_per_second,
                    std::uint32_t bytes_per_second) {
    entry.datagrams = FloodWatch(packets_per_second, bytes_per_second);
    entry.packets = FloodWatch(packets_per_second, 0);
  }

  // Returns false, for the datagram that exceeded a limit.
  bool beyond_limits(Entry& entry, const FloodWatch& watch) {
    ++counters.limited;
    if (entry.open && watch.flooding() && entry.ending == RefuseReason::none) {
      entry.ending = RefuseReason::flooding;
      any_ending = true;
      ++counters.floods;
    }
    return false;
  }

  // enet_setup.cpp: ENet's callbacks, and the making of it.
  static State& of(const ENetHost* host);
  static int ENET_CALLBACK intercept(ENetHost* host, ENetEvent*);
  static enet_uint32 ENET_CALLBACK compute_checksum(const ENetBuffer* buffers, std::size_t count);
  void configure(const EnetOptions& options);
  static Result<std::unique_ptr<State>> create(const EnetOptions& options,
                                               const ENetAddress* address,
                                               std::string* problem = nullptr);
  static Result<std::unique_ptr<State>> listen(const EnetOptions& options, std::string* problem);
  static Result<std::unique_ptr<State>> create_ipv6(const EnetOptions& options,
                                                    const DatagramSource& local,
                                                    std::string* problem);

  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] bool was_cut_short() const;

  // enet_ipv6.cpp
  [[nodiscard]] bool add_ipv6(const DatagramSource* local);
  [[nodiscard]] bool admit_ipv6();
  void wake_for_ipv6();
  [[nodiscard]] bool is_wake() const;
  void send_over_ipv6(const Entry& entry, ByteView datagram);
  [[nodiscard]] bool wait(enet_uint32 limit_ms) const;  ///< with IPv6
};

}  // namespace lockstone::net
