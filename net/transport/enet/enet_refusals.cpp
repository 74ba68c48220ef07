#include "net/transport/enet/enet_refusals.h"

namespace lockstone::net {
namespace {

// Anybody who sees a request can refuse it: that counts where the server says nothing for so long.
// ENet asks again after 0.5 s and 1.5 s.
constexpr std::int64_t k_patience_us = 2'000'000;

}  // namespace

// Shorter than the request, and seldom: no use for drowning the one whose address it bears.
void EnetRefusals::refuse(const Word& connect, std::span<std::byte> request,
                          const DatagramHead& head) {
  const RefuseReason reason = reason_against(request, head);
  if (reason == RefuseReason::none) return;
  if (!limit_.take(data_.source, data_.now_us)) return;
  ++data_.counters.refusals;
  auto bytes = encode(LinkRefusal{reason, connect});
  if (!data_.source.is_ipv4()) return data_.ipv6->send(data_.source, bytes);
  ENetBuffer buffer{};
  buffer.data = bytes.data();
  buffer.dataLength = bytes.size();
  enet_socket_send(data_.host->socket, &data_.host->receivedAddress, &buffer, 1);
}

// Why the sender of a request with a wrong checksum cannot come in, if that can be told.
RefuseReason EnetRefusals::reason_against(std::span<std::byte> request,
                                          const DatagramHead& head) const {
  // Without a key, anything that has not the open checksum may be of the other kind.
  const bool keyed = data_.checksum.keyed() || data_.matches != nullptr;
  if (!keyed || open_checksum_.verify(request, head, Word{})) {
    return RefuseReason::insecure_not_allowed;
  }
  const std::uint32_t tag = read_match_tag(request);
  if (data_.matches != nullptr) {
    return tag != 0 && !data_.matches->link_key_of(tag) ? RefuseReason::wrong_match
                                                        : RefuseReason::none;
  }
  const bool other = data_.match_tag != 0 && tag != 0 && tag != data_.match_tag;
  return other ? RefuseReason::wrong_match : RefuseReason::none;
}

void EnetRefusals::note(const LinkRefusal& refusal) {
  for (EnetConnection& connection : connections_.all()) {
    const bool meant = connection.open && connection.peer->state == ENET_PEER_STATE_CONNECTING &&
                       raw_word(connection.peer->connectID) == refusal.connection;
    if (!meant || connection.hearsay != RefuseReason::none) continue;
    connection.hearsay = refusal.reason;
    connection.hearsay_us = data_.now_us;
  }
}

void EnetRefusals::believe() {
  for (EnetConnection& connection : connections_.all()) {
    const bool waited = connection.open && connection.hearsay != RefuseReason::none &&
                        data_.now_us - connection.hearsay_us >= k_patience_us;
    if (!waited || connection.peer->state != ENET_PEER_STATE_CONNECTING) continue;
    connections_.end(connection, connection.hearsay);
  }
}

}  // namespace lockstone::net
