#include <lockstone/watch/world_server.h>

#include <algorithm>

#include "tools/watch/random_token.h"
#include "tools/watch/world_description.h"

namespace lockstone::watch {

using namespace net;

namespace {

constexpr std::size_t k_most_viewers = 8;
// More than one state never waits for a viewer; the largest world has about 1 GB.
constexpr std::size_t k_most_waiting_bytes = std::size_t{1} << 31;
// A game that is paused asks for no news.
constexpr std::int64_t k_idle_us = 3'600'000'000;
// Bytes that one call hands to the system in pieces, before the game goes on.
constexpr int k_flushes = 16;

bool is_token(ByteView bytes, const std::string& token) {
  if (bytes.size() != token.size()) return false;
  // All of it, however early they differ.
  unsigned difference = 0;
  for (std::size_t i = 0; i < bytes.size(); ++i)
    difference |= std::to_integer<unsigned>(bytes[i]) ^ static_cast<unsigned char>(token[i]);
  return difference == 0;
}

}  // namespace

WorldServer::WorldServer(std::unique_ptr<WebSocketTransport> transport, std::string token)
    : transport_(std::move(transport)),
      token_(std::move(token)),
      address_("ws://127.0.0.1:" + std::to_string(transport_->port()) + '/' + token_) {}

Result<std::unique_ptr<WorldServer>> WorldServer::open(std::uint16_t port, std::string* problem) {
  WebSocketOptions options;
  options.port = port;
  options.max_connections = options.max_connections_per_address = k_most_viewers;
  options.max_strangers_per_address = k_most_viewers;
  options.max_outgoing_bytes = k_most_waiting_bytes;
  options.idle_us = k_idle_us;
  Result<std::unique_ptr<WebSocketTransport>> transport =
      WebSocketTransport::listen(options, problem);
  if (!transport) return transport.status();
  return std::unique_ptr<WorldServer>(
      new WorldServer(std::move(transport).value(), random_token()));
}

void WorldServer::update(const World& world, std::int64_t now_us) {
  TransportEvent event;
  while (transport_->poll(now_us, event))
    hear(world, event);
  const std::uint64_t tick = world.tick();
  const auto waits = [&](const Viewer& viewer) { return wants_state(viewer, tick); };
  if (std::ranges::any_of(viewers_, waits)) save(world);
  for (Viewer& viewer : viewers_) {
    if (!waits(viewer)) continue;
    viewer.tick = tick;
    viewer.has_state = true;
    send(viewer.connection, state_);
  }
  for (int i = 0; i < k_flushes && !viewers_.empty(); ++i)
    transport_->flush();
}

void WorldServer::hear(const World& world, const TransportEvent& event) {
  const auto is_known = [&](const Viewer& viewer) { return viewer.connection == event.connection; };
  const bool known = std::ranges::any_of(viewers_, is_known);
  if (event.kind == TransportEventKind::disconnected) std::erase_if(viewers_, is_known);
  if (event.kind != TransportEventKind::received || known) return;
  if (!is_token(event.bytes, token_)) return transport_->disconnect(event.connection);
  transport_->trust(event.connection);
  viewers_.push_back({.connection = event.connection});
  send(event.connection, describe_world(world));
}

void WorldServer::send(ConnectionId connection, ByteView message) {
  const std::size_t piece = k_max_reliable_bytes - 1;
  for (std::size_t at = 0; at < message.size(); at += piece) {
    const ByteView bytes = message.subspan(at, std::min(piece, message.size() - at));
    const bool is_last = at + bytes.size() == message.size();
    packet_.assign(1, static_cast<std::byte>(is_last ? ViewPart::last : ViewPart::more));
    packet_.insert(packet_.end(), bytes.begin(), bytes.end());
    // A viewer that is gone is forgotten when its end is heard of.
    (void)transport_->send(connection, Channel::reliable, packet_);
  }
}

bool WorldServer::wants_state(const Viewer& viewer, std::uint64_t tick) const {
  if (viewer.has_state && viewer.tick == tick) return false;
  return !viewer.has_state || transport_->waiting_bytes(viewer.connection) == 0;
}

void WorldServer::save(const World& world) {
  const std::size_t most = world.snapshot_bytes_max(SnapshotKind::canonical);
  state_.resize(1 + most);
  state_.front() = static_cast<std::byte>(ViewMessage::state);
  const std::size_t size = world.save(SnapshotKind::canonical, std::span(state_).subspan(1));
  state_.resize(1 + size);
}

}  // namespace lockstone::watch
