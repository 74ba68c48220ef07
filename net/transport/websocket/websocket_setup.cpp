// The making of a WebSocketTransport and of its connections.
#include <array>

#include "net/transport/websocket/websocket_network.h"

namespace lockstone::net {
namespace {

constexpr std::size_t k_least_outgoing_bytes = 64 * 1024;
constexpr unsigned k_handshake_header_bytes = 8192;  // with the cookies that a page's host has set
constexpr unsigned k_spare_descriptors = 16;         // of libwebsockets itself
constexpr std::size_t k_read_bytes = 4096;

// The first one is for HTTP, and for WebSockets of no subprotocol: see on_websocket.
const std::array<lws_protocols, 3> k_protocols{{
    {"http", on_websocket, 0, k_read_bytes, 0, nullptr, 0},
    {k_websocket_protocol, on_websocket, 0, k_read_bytes, 1, nullptr, 0},
    {nullptr, nullptr, 0, 0, 0, nullptr, 0},
}};

bool is_valid(const WebSocketOptions& options) {
  return options.max_connections >= 1 && options.max_connections <= k_max_socket_connections &&
         options.max_outgoing_bytes >= k_least_outgoing_bytes && options.handshake_us > 0 &&
         options.ping_us > 0 && options.idle_us > 0 &&
         options.certificate_file.empty() == options.key_file.empty();
}

const char* text_or_null(const std::string& text) {
  return text.empty() ? nullptr : text.c_str();
}

}  // namespace

WebSocketNetwork::~WebSocketNetwork() {
  if (context_ != nullptr) lws_context_destroy(context_);
}

bool WebSocketNetwork::start(bool tls) {
  if (context_ != nullptr) return true;
  lws_set_log_level(0, nullptr);
  lws_context_creation_info info{};
  info.port = listens ? CONTEXT_PORT_NO_LISTEN_SERVER : CONTEXT_PORT_NO_LISTEN;
  info.protocols = k_protocols.data();
  info.user = this;
  info.gid = info.uid = -1;  // as it is
  info.options = LWS_SERVER_OPTION_SKIP_SERVER_CANONICAL_NAME | LWS_SERVER_OPTION_EXPLICIT_VHOSTS;
  info.fd_limit_per_thread = static_cast<unsigned>(options.max_connections) + k_spare_descriptors;
  info.max_http_header_data = k_handshake_header_bytes;
  info.max_http_header_pool = static_cast<unsigned short>(options.max_connections);
  info.timeout_secs = static_cast<unsigned>(options.handshake_us / 1'000'000) + 1;
  info.pt_serv_buf_size = k_read_bytes;
  if (tls) info.options |= LWS_SERVER_OPTION_DO_SSL_GLOBAL_INIT;
  if (listens) {
    info.ssl_cert_filepath = text_or_null(options.certificate_file);
    info.ssl_private_key_filepath = text_or_null(options.key_file);
  } else if (tls) {
    info.client_ssl_ca_filepath = text_or_null(options.authority_file);
  }
  context_ = lws_create_context(&info);
  if (context_ == nullptr) return false;
  if (lws_create_vhost(context_, &info) != nullptr) return true;
  lws_context_destroy(context_);
  context_ = nullptr;
  return false;
}

Result<std::unique_ptr<WebSocketNetwork>> WebSocketNetwork::listen(
    const WebSocketOptions& options, std::string* problem) {
  if (!is_valid(options)) return Status::invalid_argument;
  auto network = std::make_unique<WebSocketNetwork>(options, true);
  std::string reason;
  network->listener = TcpListener::open(options.bind_address, options.port, reason);
  const bool listening = network->listener != nullptr;
  if (listening && network->start(!options.certificate_file.empty())) return network;
  if (listening) reason = "no certificate and key in these files";
  if (problem != nullptr) *problem = reason;
  return Status::io_error;
}

// libwebsockets may tell of a failure before it returns, by a callback.
Result<ConnectionId> WebSocketNetwork::connect(const std::string& url) {
  std::string parsed = url;
  const char* scheme = nullptr;
  const char* host = nullptr;
  const char* path = nullptr;
  int port = 0;
  if (lws_parse_uri(parsed.data(), &scheme, &host, &port, &path) != 0 || port <= 0)
    return Status::invalid_argument;
  const bool tls = std::string_view(scheme) == "wss";
  if (!tls && std::string_view(scheme) != "ws") return Status::invalid_argument;
  if (!start(true)) return Status::io_error;
  WebSocketPlace* place = places.take({}, now_us);
  if (place == nullptr) return Status::capacity_exhausted;
  const ConnectionId connection = places.id_of(*place);
  const std::string rooted = std::string("/") + path;
  lws_client_connect_info info{};
  info.context = context_;
  info.address = info.host = host;
  info.port = port;
  info.path = rooted.c_str();
  info.protocol = k_websocket_protocol;
  info.local_protocol_name = k_websocket_protocol;
  info.ssl_connection = tls ? LCCSCF_USE_SSL : 0;
  info.opaque_user_data = place;
  info.pwsi = &place->socket;
  if (lws_client_connect_via_info(&info) != nullptr) return connection;
  if (place->stage == PlaceStage::door && places.id_of(*place) == connection) {
    places.release(*place);
    events.add(TransportEventKind::disconnected, connection);
  }
  return connection;
}

void WebSocketNetwork::admit_callers() {
  if (listener == nullptr) return;
  while (const auto caller = listener->accept()) {
    ++counters.callers;
    const bool crowded = places.is_crowded(caller->source);
    WebSocketPlace* place = crowded ? nullptr : places.take(caller->source, now_us);
    if (place == nullptr) {
      ++(crowded ? counters.crowded : counters.full);
      TcpListener::turn_away(*caller);
      continue;
    }
    keep_system_queue_short(caller->socket);
    place->socket = lws_adopt_socket_vhost(lws_get_vhost_by_name(context_, "default"),
                                           caller->socket);
    if (place->socket == nullptr) {
      places.release(*place);
      continue;
    }
    lws_set_opaque_user_data(place->socket, place);
  }
}

void WebSocketNetwork::serve() {
  if (context_ == nullptr) return;
  admit_callers();
  anything_to_write = false;
  lws_service(context_, -1);
  enforce_times();
}

}  // namespace lockstone::net
