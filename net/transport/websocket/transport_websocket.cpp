// The calls of WebSocketTransport, and its time-outs.
#include <algorithm>

#include <lockstone/net/token.h>

#include "net/transport/websocket/websocket_network.h"

namespace lockstone::net {
namespace {

constexpr std::int64_t k_times_every_us = 50'000;
// A peer that was sent away need not take the rest.
constexpr std::int64_t k_closing_us = 2'000'000;

}  // namespace

WebSocketTransport::WebSocketTransport(std::unique_ptr<WebSocketNetwork> network)
    : network_(std::move(network)) {}
WebSocketTransport::~WebSocketTransport() = default;

Result<std::unique_ptr<WebSocketTransport>> WebSocketTransport::listen(
    const WebSocketOptions& options, std::string* problem) {
  std::string reason;
  Result<std::unique_ptr<WebSocketNetwork>> network = WebSocketNetwork::listen(options, &reason);
  if (!network) {
    if (reason.empty()) reason = to_string(network.status());
    const HostPort where{options.bind_address, options.port};
    if (problem != nullptr) *problem = where.to_text() + ": " + reason;
    return network.status();
  }
  return std::unique_ptr<WebSocketTransport>(new WebSocketTransport(std::move(network).value()));
}

Result<std::unique_ptr<WebSocketTransport>> WebSocketTransport::open(
    const WebSocketOptions& options) {
  if (options.max_connections < 1 || options.max_connections > k_max_socket_connections)
    return Status::invalid_argument;
  return std::unique_ptr<WebSocketTransport>(
      new WebSocketTransport(std::make_unique<WebSocketNetwork>(options, false)));
}

Result<ConnectionId> WebSocketTransport::connect(const std::string& url) {
  return network_->connect(url);
}

std::uint16_t WebSocketTransport::port() const {
  return network_->listener == nullptr ? std::uint16_t{0} : network_->listener->port();
}

bool WebSocketTransport::poll(std::int64_t now_us, TransportEvent& event) {
  network_->now_us = now_us;
  if (network_->events.take(event)) return true;
  network_->serve();
  return network_->events.take(event);
}

Status WebSocketTransport::send(ConnectionId connection, Channel channel, ByteView bytes) {
  WebSocketPlace* place = network_->places.find(connection);
  if (place == nullptr) return Status::stale_handle;
  if (bytes.empty() || bytes.size() > max_payload_bytes(channel)) return Status::invalid_argument;
  const std::size_t waiting = place->outgoing.waiting_bytes() + bytes.size();
  if (waiting > network_->options.max_outgoing_bytes) {
    ++network_->counters.slow;
    place->outgoing.clear();
    network_->end(*place, RefuseReason::none);
    return Status::capacity_exhausted;
  }
  network_->counters.unreliable_dropped += place->outgoing.add(channel, bytes);
  network_->anything_to_write = true;
  lws_callback_on_writable(place->socket);
  ++place->stats.packets_sent;
  place->stats.bytes_sent += bytes.size();
  return Status::ok;
}

void WebSocketTransport::flush() {
  if (network_->anything_to_write) network_->serve();
}

void WebSocketTransport::disconnect(ConnectionId connection) {
  network_->events.forget(connection);
  WebSocketPlace* place = network_->places.find(connection);
  if (place == nullptr) return;
  place->stage = PlaceStage::closing;
  place->since_us = network_->now_us;
  lws_callback_on_writable(place->socket);
}

TransportStats WebSocketTransport::stats(ConnectionId connection) const {
  const WebSocketPlace* place = network_->places.find(connection);
  return place == nullptr ? TransportStats{} : place->stats;
}

void WebSocketTransport::trust(ConnectionId connection) {
  if (WebSocketPlace* place = network_->places.find(connection)) network_->places.trust(*place);
}

std::size_t WebSocketTransport::waiting_bytes(ConnectionId connection) const {
  const WebSocketPlace* place = network_->places.find(connection);
  return place == nullptr ? 0 : place->outgoing.waiting_bytes();
}

const WebSocketCounters& WebSocketTransport::counters() const {
  return network_->counters;
}

void WebSocketNetwork::end(WebSocketPlace& place, RefuseReason reason) {
  events.add(TransportEventKind::disconnected, places.id_of(place), reason);
  place.stage = PlaceStage::closing;
  place.since_us = now_us;
  place.ending = reason;
  lws_callback_on_writable(place.socket);
}

// Closes it without waiting for the peer; its place becomes free by the callback for that.
void WebSocketNetwork::cut(WebSocketPlace& place) {
  lws_set_timeout(place.socket, PENDING_TIMEOUT_USER_OK, LWS_TO_KILL_SYNC);
}

void WebSocketNetwork::enforce_times() {
  if (now_us - times_checked_us_ < k_times_every_us) return;
  times_checked_us_ = now_us;
  for (WebSocketPlace& place : places.all()) {
    if (place.stage != PlaceStage::free && place.socket != nullptr) enforce_times(place);
  }
}

void WebSocketNetwork::enforce_times(WebSocketPlace& place) {
  const std::int64_t stage_us = now_us - place.since_us;
  if (place.stage == PlaceStage::door && stage_us >= options.handshake_us) {
    ++counters.handshakes_late;
    return cut(place);
  }
  if (place.stage == PlaceStage::closing && stage_us >= k_closing_us) return cut(place);
  if (place.stage != PlaceStage::open) return;
  if (now_us - place.heard_us >= options.idle_us) {
    ++counters.idle;
    return cut(place);
  }
  if (now_us - place.pinged_us >= options.ping_us) lws_callback_on_writable(place.socket);
}

}  // namespace lockstone::net
