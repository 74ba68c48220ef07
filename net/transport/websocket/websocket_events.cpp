// The callbacks of libwebsockets, translated into events of the session.
#include <algorithm>
#include <array>
#include <cstring>
#include <string>

#include "net/transport/websocket/websocket_network.h"

namespace lockstone::net {
namespace {

using Network = WebSocketNetwork;

constexpr int k_go_on = 0;
constexpr int k_close = -1;
constexpr std::size_t k_stamp_bytes = 8;  // of a ping: when it was sent
constexpr std::size_t k_longest_origin = 256;

Network& network_of(lws* socket) {
  return *static_cast<Network*>(lws_context_user(lws_get_context(socket)));
}

int close_with(lws* socket, unsigned code) {
  lws_close_reason(socket, static_cast<lws_close_status>(code), nullptr, 0);
  return k_close;
}

// Only the first protocol of the list has another name.
bool speaks_lockstone(lws* socket) {
  return std::string_view(lws_get_protocol(socket)->name) == k_websocket_protocol;
}

// Programs that are no browsers send no origin.
bool is_allowed_origin(const Network& network, lws* socket) {
  if (network.options.origins.empty()) return true;
  if (lws_hdr_total_length(socket, WSI_TOKEN_ORIGIN) == 0) return true;
  std::array<char, k_longest_origin> origin{};
  const int size =
      lws_hdr_copy(socket, origin.data(), static_cast<int>(origin.size()), WSI_TOKEN_ORIGIN);
  if (size <= 0) return false;
  return std::ranges::find(network.options.origins, std::string_view(origin.data())) !=
         network.options.origins.end();
}

int on_handshake(Network& network, lws* socket) {
  if (!speaks_lockstone(socket)) {
    ++network.counters.wrong_protocol;
    return k_close;
  }
  if (is_allowed_origin(network, socket)) return k_go_on;
  ++network.counters.wrong_origin;
  return k_close;
}

int on_open(Network& network, WebSocketPlace& place) {
  place.stage = PlaceStage::open;
  place.since_us = place.heard_us = network.now_us;
  ++network.counters.opened;
  network.events.add(TransportEventKind::connected, network.places.id_of(place));
  return k_go_on;
}

// The session hears of the end at once; the peer is told when the callback returns.
int refuse(Network& network, WebSocketPlace& place, lws* socket, unsigned code) {
  ++network.counters.malformed;
  network.end(place, RefuseReason::none);
  return close_with(socket, code);
}

int on_message(Network& network, WebSocketPlace& place, lws* socket) {
  ++network.counters.messages;
  const auto size = static_cast<std::uint32_t>(place.incoming.size());
  if (!place.messages.admit(network.now_us, size)) {
    ++network.counters.limited;
    if (!place.messages.flooding()) return k_go_on;
    ++network.counters.floods;
    network.end(place, RefuseReason::flooding);
    return close_with(socket,
                      k_close_reason_base + static_cast<unsigned>(RefuseReason::flooding));
  }
  const auto read = read_message(place.incoming);
  if (!read) return refuse(network, place, socket, LWS_CLOSE_STATUS_POLICY_VIOLATION);
  TransportEvent event;
  event.connection = network.places.id_of(place);
  event.channel = read->channel;
  event.bytes = read->payload;
  network.events.add(event);
  ++place.stats.packets_received;
  place.stats.bytes_received += read->payload.size();
  return k_go_on;
}

// A message may come in several pieces, which are never empty but where the message is.
int on_bytes(Network& network, WebSocketPlace& place, lws* socket, ByteView bytes) {
  place.heard_us = network.now_us;
  if (place.stage != PlaceStage::open) return k_go_on;
  if (lws_frame_is_binary(socket) == 0)
    return refuse(network, place, socket, LWS_CLOSE_STATUS_UNACCEPTABLE_OPCODE);
  if (bytes.size() > k_max_websocket_bytes - place.incoming.size())
    return refuse(network, place, socket, LWS_CLOSE_STATUS_MESSAGE_TOO_LARGE);
  const bool whole =
      lws_is_final_fragment(socket) != 0 && lws_remaining_packet_payload(socket) == 0;
  if (bytes.empty() && !whole)
    return refuse(network, place, socket, LWS_CLOSE_STATUS_POLICY_VIOLATION);
  place.incoming.insert(place.incoming.end(), bytes.begin(), bytes.end());
  if (!whole) return k_go_on;
  const int result = on_message(network, place, socket);
  place.incoming.clear();
  return result;
}

int write_ping(const Network& network, WebSocketPlace& place, lws* socket) {
  std::array<unsigned char, LWS_PRE + k_stamp_bytes> ping{};
  ByteWriter(std::as_writable_bytes(std::span(ping)).subspan(LWS_PRE)).put(network.now_us);
  place.pinged_us = network.now_us;
  return lws_write(socket, ping.data() + LWS_PRE, k_stamp_bytes, LWS_WRITE_PING);
}

// A smoothed round trip, as TCP's: RFC 6298, section 2.
int on_pong(const Network& network, WebSocketPlace& place, ByteView stamp) {
  place.heard_us = network.now_us;
  ByteReader reader(stamp);
  const auto sent_us = reader.get<std::int64_t>();
  if (!reader.ok() || sent_us != place.pinged_us) return k_go_on;
  const std::int64_t took_us = network.now_us - sent_us;
  std::int64_t& smoothed_us = place.stats.round_trip_us;
  smoothed_us = smoothed_us < 0 ? took_us : (7 * smoothed_us + took_us) / 8;
  return k_go_on;
}

// False when the connection is broken. Takes as much as the system does.
bool write_messages(WebSocketPlace& place, lws* socket) {
  const bool several = place.outgoing.count() > 1;
  if (several) hold_segments(lws_get_socket_fd(socket), true);
  bool good = true;
  while (good && !place.outgoing.empty() && lws_send_pipe_choked(socket) == 0) {
    OutgoingMessages::Message message = place.outgoing.take();
    auto* begin = reinterpret_cast<unsigned char*>(message.bytes.data()) + LWS_PRE;
    good = lws_write(socket, begin, message.bytes.size() - LWS_PRE, LWS_WRITE_BINARY) >= 0;
  }
  if (several) hold_segments(lws_get_socket_fd(socket), false);
  return good;
}

int on_writeable(Network& network, WebSocketPlace& place, lws* socket) {
  const bool open = place.stage == PlaceStage::open;
  if (!open && place.ending != RefuseReason::none)
    return close_with(socket, k_close_reason_base + static_cast<unsigned>(place.ending));
  if (open && network.now_us - place.pinged_us >= network.options.ping_us) {
    if (write_ping(network, place, socket) < 0) return k_close;
  }
  if (!write_messages(place, socket)) return k_close;
  if (!place.outgoing.empty()) {
    lws_callback_on_writable(socket);
    return k_go_on;
  }
  return open ? k_go_on : close_with(socket, LWS_CLOSE_STATUS_NORMAL);
}

int on_peer_closes(WebSocketPlace& place, ByteView code) {
  if (code.size() < 2) return k_go_on;
  const unsigned high = std::to_integer<unsigned>(code[0]);
  const unsigned low = std::to_integer<unsigned>(code[1]);
  place.ending = reason_of_close(high * 256 + low);
  return k_go_on;
}

// A client's call that came to nothing is told too.
int on_gone(Network& network, WebSocketPlace& place, lws* socket) {
  const bool unmet = place.stage == PlaceStage::door && !network.listens;
  if (place.stage == PlaceStage::open || unmet)
    network.events.add(TransportEventKind::disconnected, network.places.id_of(place), place.ending);
  network.places.release(place);
  lws_set_opaque_user_data(socket, nullptr);
  return k_go_on;
}

int on_http(Network& network) {
  ++network.counters.wrong_protocol;
  return k_close;
}

}  // namespace

int on_websocket(lws* socket, lws_callback_reasons reason, void* /*user*/, void* in,
                 std::size_t size) {
  if (reason == LWS_CALLBACK_HTTP) return on_http(network_of(socket));
  if (reason == LWS_CALLBACK_FILTER_PROTOCOL_CONNECTION)
    return on_handshake(network_of(socket), socket);
  if (socket == nullptr) return k_go_on;
  WebSocketPlace* place = WebSocketPlaces::find(socket);
  if (place == nullptr) return k_go_on;
  Network& network = network_of(socket);
  const ByteView bytes(static_cast<const std::byte*>(in), in == nullptr ? 0 : size);
  switch (reason) {
    case LWS_CALLBACK_ESTABLISHED:
    case LWS_CALLBACK_CLIENT_ESTABLISHED:
      return on_open(network, *place);
    case LWS_CALLBACK_RECEIVE:
    case LWS_CALLBACK_CLIENT_RECEIVE:
      return on_bytes(network, *place, socket, bytes);
    case LWS_CALLBACK_RECEIVE_PONG:
    case LWS_CALLBACK_CLIENT_RECEIVE_PONG:
      return on_pong(network, *place, bytes);
    case LWS_CALLBACK_SERVER_WRITEABLE:
    case LWS_CALLBACK_CLIENT_WRITEABLE:
      return on_writeable(network, *place, socket);
    case LWS_CALLBACK_WS_PEER_INITIATED_CLOSE:
      return on_peer_closes(*place, bytes);
    case LWS_CALLBACK_CLIENT_CONNECTION_ERROR:
    case LWS_CALLBACK_WSI_DESTROY:
      return on_gone(network, *place, socket);
    default:
      return k_go_on;
  }
}

}  // namespace lockstone::net
