#include "net/transport/enet/enet_gate.h"

#include <optional>

namespace lockstone::net {

bool EnetGate::admit(std::span<std::byte> datagram) {
  ++data_.counters.datagrams;
  if (const auto refusal = decode_link_refusal(datagram)) {
    refusals_.note(*refusal);
    return false;
  }
  const std::optional<DatagramHead> head = read_head(datagram);
  if (!head) {
    ++data_.counters.malformed;
    return false;
  }
  return head->peer == k_no_peer ? admit_stranger(datagram, *head) : admit_peer(datagram, *head);
}

bool EnetGate::admit_stranger(std::span<std::byte> datagram, const DatagramHead& head) {
  const std::optional<Word> connect = read_connect(datagram, head);
  if (!connect || !data_.listens) {
    ++data_.counters.strays;
    return false;
  }
  const std::optional<LinkChecksum> checksum = checksum_for(datagram);
  if (!checksum || !checksum->verify(datagram, head, Word{})) {
    ++data_.counters.forged;
    refusals_.refuse(*connect, datagram, head);
    return false;
  }
  if (!is_usual_connect(datagram.subspan(head.checksum_offset + sizeof(Word)))) {
    ++data_.counters.malformed;
    return false;
  }
  const enet_uint32 number = raw_value(*connect);
  if (!connects_.admit(*connect, data_.source) || connections_.is_taken_elsewhere(number)) {
    ++data_.counters.repeated_connects;
    return false;
  }
  admitted_ = word_of(datagram, head);
  return connections_.holds_place(number) || connections_.make_place(*checksum);
}

// Nothing for a match that is not open.
std::optional<LinkChecksum> EnetGate::checksum_for(ByteView connect) const {
  if (data_.matches == nullptr) return data_.checksum;
  const std::optional<LinkKey> key = data_.matches->link_key_of(read_match_tag(connect));
  if (!key) return std::nullopt;
  return LinkChecksum(key);
}

bool EnetGate::admit_peer(std::span<std::byte> datagram, const DatagramHead& head) {
  const ENetHost& host = *data_.host;
  const ENetPeer* peer = head.peer < host.peerCount ? &host.peers[head.peer] : nullptr;
  const bool known = peer != nullptr && peer->state != ENET_PEER_STATE_DISCONNECTED &&
                     peer->state != ENET_PEER_STATE_ZOMBIE && connections_.is_source(*peer);
  if (!known) {
    ++data_.counters.strays;
    return false;
  }
  EnetConnection& connection = connections_.of(peer);
  if (!authenticate(connection, datagram, head)) return false;
  admitted_ = word_of(datagram, head);
  const auto bytes = static_cast<std::uint32_t>(datagram.size());
  if (!connection.datagrams.admit(data_.now_us, bytes)) {
    return connections_.count_excess(connection, connection.datagrams);
  }
  return admit_commands(connection, *peer, datagram.subspan(head.checksum_offset + sizeof(Word)));
}

bool EnetGate::admit_commands(EnetConnection& connection, const ENetPeer& peer, ByteView commands) {
  const std::uint16_t delivered =
      peer.channels == nullptr ? 0 : peer.channels[0].incomingReliableSequenceNumber;
  switch (connection.commands.admit(commands, delivered, !data_.listens)) {
    case CommandFilter::Verdict::pass:
      return true;
    case CommandFilter::Verdict::malformed:
      ++data_.counters.malformed;
      return false;
    case CommandFilter::Verdict::too_far:
      ++data_.counters.too_far_ahead;
      return false;
  }
  return false;
}

// Nothing of a datagram counts for or against the peer before this. Takes the seal off.
bool EnetGate::authenticate(EnetConnection& connection, std::span<std::byte>& datagram,
                            const DatagramHead& head) {
  const Word number = raw_word(data_.host->peers[head.peer].connectID);
  DatagramSeal::Outcome outcome = DatagramSeal::Outcome::forged;
  if (connection.seal.present()) outcome = connection.seal.open(datagram, head, number);
  if (outcome == DatagramSeal::Outcome::ok) {
    datagram = datagram.first(datagram.size() - DatagramSeal::k_bytes);
    data_.host->receivedDataLength = datagram.size();
    return true;
  }
  if (outcome == DatagramSeal::Outcome::replayed) {
    ++data_.counters.replayed;
    return false;
  }
  const bool bare =
      !connection.seal.required() && connection.checksum.verify(datagram, head, number);
  if (!bare) ++data_.counters.forged;
  return bare;
}

}  // namespace lockstone::net
