#include "net/transport/enet/enet_datagram.h"

#include <algorithm>

#include <lockstone/hash.h>

#include "net/security/crypto.h"

namespace lockstone::net {
namespace {

constexpr std::size_t k_word_bytes = 4;
constexpr std::size_t k_command_head_bytes = 4;  // no command is shorter
constexpr std::size_t k_connect_bytes = 48;
constexpr std::size_t k_connect_id_offset = 40;
constexpr std::uint8_t k_connect_command = 0x82;  // number 2, wants an acknowledgement

// Of the first two bytes, in network order.
constexpr unsigned k_peer_mask = 0x0fff;
constexpr unsigned k_session_shift = 12;
constexpr unsigned k_compressed_flag = 1U << 14;
constexpr unsigned k_time_flag = 1U << 15;

// Begins like a compressed datagram, which is never sent, so it cannot be taken for another one.
constexpr std::uint32_t k_refusal_magic = 0x52534b4c;  // "LKSR"
constexpr std::uint8_t k_refusal_version = 1;

constexpr std::uint64_t k_open_seed = 0x6f70656e206c696e;  // "nil nepo"

Word word_at(ByteView bytes, std::size_t offset) {
  Word word;
  std::copy_n(bytes.begin() + static_cast<std::ptrdiff_t>(offset), word.size(), word.begin());
  return word;
}

}  // namespace

std::optional<DatagramHead> read_head(ByteView datagram) {
  if (datagram.size() < 2) return std::nullopt;
  const unsigned first =
      std::to_integer<unsigned>(datagram[0]) << 8 | std::to_integer<unsigned>(datagram[1]);
  if ((first & k_compressed_flag) != 0) return std::nullopt;
  DatagramHead head;
  head.peer = static_cast<std::uint16_t>(first & k_peer_mask);
  head.session = static_cast<std::uint8_t>(first >> k_session_shift & 3);
  head.checksum_offset = (first & k_time_flag) != 0 ? 4 : 2;
  if (datagram.size() < head.checksum_offset + k_word_bytes + k_command_head_bytes) {
    return std::nullopt;
  }
  return head;
}

std::optional<Word> read_connect(ByteView datagram, const DatagramHead& head) {
  const std::size_t command = head.checksum_offset + k_word_bytes;
  const bool connects = head.peer == k_no_peer && datagram.size() == command + k_connect_bytes &&
                        datagram[command] == std::byte{k_connect_command};
  if (!connects) return std::nullopt;
  return word_at(datagram, command + k_connect_id_offset);
}

std::uint32_t read_match_tag(ByteView datagram) {
  std::uint32_t tag = 0;
  for (const std::byte byte : datagram.last(k_word_bytes))
    tag = tag << 8 | std::to_integer<std::uint32_t>(byte);
  return tag;
}

Word LinkChecksum::of(ByteView datagram) const {
  const std::uint64_t hash =
      key_ ? crypto::short_hash(*key_, datagram) : hash64(datagram, k_open_seed);
  Word word;
  ByteWriter(word).put(static_cast<std::uint32_t>(hash & 0xffffffff));
  return word;
}

bool LinkChecksum::verify(std::span<std::byte> datagram, const DatagramHead& head,
                          const Word& connection) const {
  const std::span<std::byte> place = datagram.subspan(head.checksum_offset, k_word_bytes);
  const Word claimed = word_at(datagram, head.checksum_offset);
  std::copy(connection.begin(), connection.end(), place.begin());
  const bool right = of(datagram) == claimed;
  std::copy(claimed.begin(), claimed.end(), place.begin());
  return right;
}

Word DatagramSeal::seal(std::span<std::byte> datagram) {
  const std::span<std::byte> trailer = datagram.last(k_bytes);
  ByteWriter(trailer).put(next_);
  const std::uint64_t hash = crypto::short_hash(keys_.send, datagram);
  ByteWriter writer(trailer);
  writer.put(static_cast<std::uint32_t>(next_++ & 0xffffffff));
  writer.put(static_cast<std::uint32_t>(hash >> 32));
  Word word;
  ByteWriter(word).put(static_cast<std::uint32_t>(hash & 0xffffffff));
  return word;
}

DatagramSeal::Outcome DatagramSeal::open(std::span<std::byte> datagram, const DatagramHead& head,
                                         const Word& connection) {
  const std::size_t commands = head.checksum_offset + k_word_bytes;
  if (datagram.size() < commands + k_command_head_bytes + k_bytes) return Outcome::forged;
  const std::span<std::byte> place = datagram.subspan(head.checksum_offset, k_word_bytes);
  const std::span<std::byte> trailer = datagram.last(k_bytes);
  const Word low = word_at(datagram, head.checksum_offset);
  const Word count = word_at(trailer, 0), high = word_at(trailer, k_word_bytes);
  const std::uint64_t counter = window_.expand(ByteReader(count).get<std::uint32_t>());
  std::copy(connection.begin(), connection.end(), place.begin());
  ByteWriter(trailer).put(counter);
  std::array<std::byte, k_bytes> hash;
  ByteWriter(hash).put(crypto::short_hash(keys_.receive, datagram));
  std::copy(low.begin(), low.end(), place.begin());
  ByteWriter restored(trailer);
  restored.put_bytes(count);
  restored.put_bytes(high);
  if (word_at(hash, 0) != low || word_at(hash, k_word_bytes) != high) return Outcome::forged;
  if (!window_.accepts(counter)) return Outcome::replayed;
  window_.mark(counter);
  sends_ = required_ = true;
  return Outcome::ok;
}

bool ConnectMemory::admit(const Word& id, const DatagramSource& source) {
  const auto known = std::find_if(entries_.begin(), entries_.end(), [&id](const Entry& entry) {
    return entry.used && entry.id == id;
  });
  if (known != entries_.end()) return known->source == source;
  entries_[next_] = {id, source, true};
  next_ = (next_ + 1) % entries_.size();
  return true;
}

std::array<std::byte, k_link_refusal_bytes> encode(const LinkRefusal& refusal) {
  std::array<std::byte, k_link_refusal_bytes> bytes{};
  ByteWriter writer(bytes);
  writer.put(k_refusal_magic);
  writer.put(k_refusal_version);
  writer.put(refusal.reason);
  writer.put(std::uint16_t{0});
  writer.put_bytes(refusal.connection);
  return bytes;
}

std::optional<LinkRefusal> decode_link_refusal(ByteView datagram) {
  if (datagram.size() != k_link_refusal_bytes) return std::nullopt;
  ByteReader reader(datagram);
  if (reader.get<std::uint32_t>() != k_refusal_magic) return std::nullopt;
  if (reader.get<std::uint8_t>() != k_refusal_version) return std::nullopt;
  const auto reason = reader.get<std::uint8_t>();
  if (reason == 0 || reason > static_cast<std::uint8_t>(k_last_refuse_reason)) return std::nullopt;
  return LinkRefusal{static_cast<RefuseReason>(reason), word_at(datagram, 8)};
}

}  // namespace lockstone::net
