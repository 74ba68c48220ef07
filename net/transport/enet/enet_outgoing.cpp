#include "net/transport/enet/enet_outgoing.h"

#include <cstring>
#include <optional>

namespace lockstone::net {

enet_uint32 EnetOutgoing::finish(std::span<const ENetBuffer> buffers) {
  std::size_t size = 0;
  for (const ENetBuffer& buffer : buffers) {
    if (buffer.dataLength > gathered_.size() - size) return 0;
    std::memcpy(gathered_.data() + size, buffer.data, buffer.dataLength);
    size += buffer.dataLength;
  }
  return raw_value(seal(size));
}

// ENet reads its buffers after its call for the checksum, so that they can be replaced here.
Word EnetOutgoing::seal(std::size_t size) {
  const std::span<std::byte> datagram = std::span(gathered_).first(size);
  const std::optional<DatagramHead> head = read_head(datagram);
  if (!head) return data_.checksum.of(datagram);
  EnetConnection* receiver = receiver_of(datagram, *head);
  const std::size_t sealed_size = size + DatagramSeal::k_bytes;
  const bool seals =
      receiver != nullptr && receiver->seal.sends() && sealed_size <= gathered_.size();
  const std::span<std::byte> whole = std::span(gathered_).first(seals ? sealed_size : size);
  const LinkChecksum& checksum = receiver != nullptr ? receiver->checksum : data_.checksum;
  const Word word = seals ? receiver->seal.seal(whole) : checksum.of(whole);
  std::memcpy(gathered_.data() + head->checksum_offset, word.data(), word.size());
  if (data_.ipv6 != nullptr && receiver != nullptr && !receiver->remote.is_ipv4()) {
    data_.ipv6->send_instead(*data_.host, receiver->remote, whole);
    return word;
  }
  data_.host->buffers[0].data = whole.data();
  data_.host->buffers[0].dataLength = whole.size();
  data_.host->bufferCount = 1;
  return word;
}

// Null for a call that is given up before an answer: nobody would take that datagram.
EnetConnection* EnetOutgoing::receiver_of(ByteView datagram, const DatagramHead& head) {
  const std::optional<Word> connect = read_connect(datagram, head);
  return connections_.find_numbered(raw_value(connect ? *connect : word_of(datagram, head)));
}

}  // namespace lockstone::net
