#include "net/transport/websocket/websocket_places.h"

#include <algorithm>

namespace lockstone::net {
namespace {

constexpr unsigned k_place_bits = 12;  // of a ConnectionId; the rest is the generation
constexpr ConnectionId k_place_mask = (ConnectionId{1} << k_place_bits) - 1;
constexpr std::uint32_t k_place_generations = 1U << (k_connection_bits - k_place_bits);
static_assert(k_max_socket_connections <= k_place_mask + 1);

}  // namespace

ConnectionId WebSocketPlaces::id_of(const WebSocketPlace& place) const {
  return (place.generation << k_place_bits) | static_cast<ConnectionId>(&place - places_.data());
}

WebSocketPlace* WebSocketPlaces::find(ConnectionId connection) {
  const std::size_t index = connection & k_place_mask;
  if (index >= places_.size() || id_of(places_[index]) != connection) return nullptr;
  return places_[index].stage == PlaceStage::open ? &places_[index] : nullptr;
}

WebSocketPlace* WebSocketPlaces::find(const lws* socket) {
  auto* place = static_cast<WebSocketPlace*>(lws_get_opaque_user_data(socket));
  return place == nullptr || place->stage == PlaceStage::free ? nullptr : place;
}

// Connections that this side has ended count for no address.
bool WebSocketPlaces::is_crowded(const DatagramSource& source) const {
  std::size_t neighbours = 0;
  std::size_t strangers = 0;
  for (const WebSocketPlace& place : places_) {
    const bool counts = place.stage == PlaceStage::door || place.stage == PlaceStage::open;
    if (!counts || !from_one_site(place.remote, source)) continue;
    ++neighbours;
    if (!place.trusted) ++strangers;
  }
  return neighbours >= places_per_address_ || strangers >= strangers_per_address_;
}

WebSocketPlace* WebSocketPlaces::take(const DatagramSource& source, std::int64_t now_us) {
  const auto found = std::ranges::find(places_, PlaceStage::free, &WebSocketPlace::stage);
  if (found == places_.end()) return nullptr;
  const std::uint32_t next = found->generation + 1;
  *found = {};
  // Never zero, so that no id is k_no_connection.
  found->generation = next >= k_place_generations ? 1 : next;
  found->stage = PlaceStage::door;
  found->remote = source;
  found->since_us = found->heard_us = found->pinged_us = now_us;
  if (listens_) {
    found->messages =
        FloodWatch(limits_.stranger_packets_per_second, limits_.stranger_bytes_per_second);
  }
  return &*found;
}

void WebSocketPlaces::release(WebSocketPlace& place) {
  const std::uint32_t generation = place.generation;
  place = {};
  place.generation = generation;
}

void WebSocketPlaces::trust(WebSocketPlace& place) const {
  place.trusted = true;
  if (listens_) place.messages = FloodWatch(limits_.packets_per_second, limits_.bytes_per_second);
}

}  // namespace lockstone::net
