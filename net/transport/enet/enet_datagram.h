// The header in front of ENet's datagrams, read before ENet reads them; the checksum that keeps
// strangers out; and the refusal for a peer of the other kind. Bytes:
// docs/reference/wire-format.md, "Datagrams". Layouts: ENet 1.3 (Lee Salzman),
// include/enet/protocol.h.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/net/keys.h>
#include <lockstone/net/reasons.h>

#include "net/security/replay_window.h"
#include "net/transport/udp/datagram_source.h"

namespace lockstone::net {

/// Four bytes that are compared and copied, never computed with.
using Word = std::array<std::byte, 4>;

struct DatagramHead {
  std::uint16_t peer = 0;           ///< the receiver's number for the sender, or k_no_peer
  std::uint8_t session = 0;         ///< 0 … 3
  std::size_t checksum_offset = 0;  ///< the commands follow the four bytes there
};
inline constexpr std::uint16_t k_no_peer = 0xfff;

/// Nothing if it is too short to hold a command, or compressed.
[[nodiscard]] std::optional<DatagramHead> read_head(ByteView datagram);

/// The connection's id, if the datagram is one that asks for a connection and nothing else.
[[nodiscard]] std::optional<Word> read_connect(ByteView datagram, const DatagramHead& head);

/// The tag of the match that the caller means. Only where read_connect returns something.
[[nodiscard]] std::uint32_t read_match_tag(ByteView datagram);

/// The checksum of one match's datagrams: SipHash-2-4 under the link key, or, without one, a hash
/// that anybody can compute and that finds damage only.
class LinkChecksum {
 public:
  explicit LinkChecksum(const std::optional<LinkKey>& key) : key_(key) {}

  [[nodiscard]] bool keyed() const { return key_.has_value(); }
  [[nodiscard]] Word of(ByteView datagram) const;

  /// True if the datagram has the right checksum, which is computed with `connection` in its place.
  /// The datagram is as before afterwards.
  [[nodiscard]] bool verify(std::span<std::byte> datagram, const DatagramHead& head,
                            const Word& connection) const;

 private:
  std::optional<LinkKey> key_;
};

/// The seal of one connection's datagrams, once both ends have keys for it. All players of a match
/// know the link key; these keys nobody else knows, and no sealed datagram counts twice.
class DatagramSeal {
 public:
  static constexpr std::size_t k_bytes = 8;  ///< behind the commands
  enum class Outcome : std::uint8_t { ok, forged, replayed };

  DatagramSeal() = default;
  DatagramSeal(const DatagramKeys& keys, bool at_once)
      : keys_(keys), present_(true), sends_(at_once) {}

  /// This side has the keys.
  [[nodiscard]] bool present() const { return present_; }
  /// This side's datagrams are to be sealed.
  [[nodiscard]] bool sends() const { return sends_; }
  /// The peer has sent a sealed datagram: all that it sends is sealed from there on.
  [[nodiscard]] bool required() const { return required_; }

  /// Seals a datagram whose last k_bytes are free and which has the connection's id in the
  /// checksum's place. Returns the checksum.
  [[nodiscard]] Word seal(std::span<std::byte> datagram);

  /// Judges a datagram of the peer's, which is as before afterwards.
  [[nodiscard]] Outcome open(std::span<std::byte> datagram, const DatagramHead& head,
                             const Word& connection);

 private:
  DatagramKeys keys_;
  bool present_ = false;
  bool sends_ = false;
  bool required_ = false;
  std::uint64_t next_ = 0;
  ReplayWindow window_;
};

/// Who asked for which connection: a recorded request cannot be sent again from elsewhere.
class ConnectMemory {
 public:
  explicit ConnectMemory(std::size_t capacity) : entries_(capacity) {}

  /// False if this id came from another source before. The oldest is forgotten when all are used.
  [[nodiscard]] bool admit(const Word& id, const DatagramSource& source);

 private:
  struct Entry {
    Word id{};
    DatagramSource source;
    bool used = false;
  };
  std::vector<Entry> entries_;
  std::size_t next_ = 0;
};

/// Says why there will be no connection. Shorter than any datagram that asks for one.
inline constexpr std::size_t k_link_refusal_bytes = 12;
struct LinkRefusal {
  RefuseReason reason = RefuseReason::none;
  Word connection{};  ///< as asked for
};
[[nodiscard]] std::array<std::byte, k_link_refusal_bytes> encode(const LinkRefusal& refusal);
[[nodiscard]] std::optional<LinkRefusal> decode_link_refusal(ByteView datagram);

}  // namespace lockstone::net
