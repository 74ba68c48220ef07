#include "tools/simnet/lying_transport.h"

#include <algorithm>

namespace lockstone::simnet {
namespace {

constexpr std::array<std::string_view, k_lies> k_lie_names{
    "none", "once", "always", "alternately", "parts", "silence", "future", "dumps"};

}  // namespace

std::string_view to_string(Lie lie) {
  return k_lie_names[static_cast<std::size_t>(lie)];
}

std::optional<Lie> parse_lie(std::string_view text) {
  const auto found = std::find(k_lie_names.begin(), k_lie_names.end(), text);
  if (found == k_lie_names.end()) return std::nullopt;
  return static_cast<Lie>(found - k_lie_names.begin());
}

bool LyingTransport::lies_at(std::uint64_t tick) const {
  if (tick < from_) return false;
  return lie_ == Lie::always || (lie_ == Lie::once && tick == from_) ||
         (lie_ == Lie::alternately && tick % 2 == 0);
}

Status LyingTransport::send(net::ConnectionId connection, net::Channel channel, ByteView bytes) {
  const Result<net::MessageType> type = net::message_type(bytes);
  if (lie_ == Lie::none || !type) return carrier_.send(connection, channel, bytes);
  switch (type.value()) {
    case net::MessageType::inputs:
      return send_inputs(connection, channel, bytes);
    case net::MessageType::parts:
      return send_parts(connection, channel, bytes);
    case net::MessageType::dump:
      return Status::ok;
    default:
      return carrier_.send(connection, channel, bytes);
  }
}

Status LyingTransport::send_inputs(net::ConnectionId connection, net::Channel channel,
                                   ByteView bytes) {
  net::Inputs message;
  if (decode(bytes, input_bytes_, message) != Status::ok) return Status::malformed;
  for (std::size_t i = 0; i < message.hash_count; ++i) {
    if (lies_at(message.first_hash_tick + i)) message.hashes[i] ^= 1;
  }
  const std::uint64_t end = message.first_hash_tick + message.hash_count;
  if (lie_ == Lie::silence && end > from_) {
    const std::uint64_t told = from_ - std::min(from_, message.first_hash_tick);
    message.hash_count =
        static_cast<std::uint8_t>(std::min<std::uint64_t>(message.hash_count, told));
  }
  if (lie_ == Lie::future && end > from_ && message.hash_count > 0) message.first_hash_tick += 100;
  if (lie_ == Lie::dumps && end > from_) flood(connection);
  const std::size_t size = encode(message, out_);
  return carrier_.send(connection, channel, ByteView(out_).first(size));
}

Status LyingTransport::send_parts(net::ConnectionId connection, net::Channel channel,
                                  ByteView bytes) {
  net::Parts message;
  if (decode(bytes, message) != Status::ok) return Status::malformed;
  if (lie_ == Lie::parts && message.ticks >= from_) message.hashes[0].high ^= 1;
  const std::size_t size = encode(message, out_);
  return carrier_.send(connection, channel, ByteView(out_).first(size));
}

void LyingTransport::flood(net::ConnectionId connection) {
  const std::array<std::byte, net::k_max_chunk_bytes> chunk{};
  const net::Dump dump{from_, 1U << 30, 0, chunk};
  const std::size_t size = encode(dump, out_);
  static_cast<void>(carrier_.send(connection, net::Channel::reliable, ByteView(out_).first(size)));
}

}  // namespace lockstone::simnet
