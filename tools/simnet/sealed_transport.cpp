#include "tools/simnet/sealed_transport.h"

#include <array>

#include <lockstone/hash.h>

namespace lockstone::simnet {
namespace {

constexpr std::size_t k_tag_bytes = 8;

}  // namespace

bool SealedTransport::poll(std::int64_t now_us, net::TransportEvent& event) {
  while (carrier_.poll(now_us, event)) {
    if (event.kind != net::TransportEventKind::received) return true;
    if (event.bytes.size() > k_tag_bytes) {
      const ByteView payload = event.bytes.first(event.bytes.size() - k_tag_bytes);
      ByteReader tag(event.bytes.last(k_tag_bytes));
      if (tag.get<std::uint64_t>() == hash64(payload, key_)) {
        event.bytes = payload;
        return true;
      }
    }
    ++refused_;
  }
  return false;
}

Status SealedTransport::send(net::ConnectionId connection, net::Channel channel, ByteView bytes) {
  std::array<std::byte, k_tag_bytes> tag{};
  ByteWriter(tag).put(hash64(bytes, key_));
  out_.assign(bytes.begin(), bytes.end());
  out_.insert(out_.end(), tag.begin(), tag.end());
  return carrier_.send(connection, channel, out_);
}

}  // namespace lockstone::simnet
