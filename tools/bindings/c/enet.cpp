// UDP sockets, plain and encrypted.
#include "tools/bindings/c/game_handles.h"

#if defined(LOCKSTONE_WITH_ENET)

#include <algorithm>
#include <chrono>

#include <lockstone/net/token.h>
#include <lockstone/net/transport_enet.h>

namespace {

using namespace lockstone;
using namespace lockstone::c;

lks_enet_def raw_def() {
  const net::EnetOptions options;
  lks_enet_def raw{};
  raw.size = sizeof raw;
  raw.max_connections = static_cast<std::uint32_t>(options.max_connections);
  raw.max_connections_per_address = static_cast<std::uint32_t>(options.max_connections_per_address);
  raw.timeout_ms = options.timeout_ms;
  return raw;
}

net::EnetOptions options_of(const lks_enet_def& raw, const char* address) {
  net::EnetOptions options;
  options.bind_address = &required(address, "address");
  options.port = narrow<std::uint16_t>(raw.port, "def.port");
  options.max_connections = raw.max_connections;
  options.max_connections_per_address = raw.max_connections_per_address;
  options.timeout_ms = raw.timeout_ms;
  if (flag(raw.unlimited, "def.unlimited")) options.limits = net::DatagramLimits::none();
  return options;
}

net::Key key_of(const void* bytes) {
  if (!net::security_available())
    throw_status(LKS_UNSUPPORTED, "the library was built without libsodium");
  net::Key key;
  std::memcpy(key.bytes.data(), bytes, key.bytes.size());
  return key;
}

net::EnetTransport& socket_of(const Carrier& carrier) {
  if (carrier.socket == nullptr || carrier.carried != nullptr)
    throw_invalid("transport", "is no UDP socket");
  return static_cast<net::EnetTransport&>(*carrier.socket);
}

net::EnetTransport& socket_of(const lks_transport* transport) {
  return socket_of(*required(transport, "transport").carrier);
}

std::int64_t unix_us() {
  const auto now = std::chrono::system_clock::now().time_since_epoch();
  return std::chrono::duration_cast<std::chrono::microseconds>(now).count();
}

void encrypt_server(Carrier& carrier, const lks_enet_def& def, const net::Key& key) {
  net::SecureServerOptions security;
  security.backend_key = key;
  security.match = def.match_id;
  security.max_connections = def.max_connections;
  security.unix_us_at_zero = unix_us() - lks_now_us();
  carrier.random = std::make_unique<net::SystemRandom>();
  carrier.secure =
      value_of(net::SecureTransport::serve(*carrier.socket, security, *carrier.random));
  carrier.session = carrier.secure.get();
}

std::unique_ptr<net::EnetTransport> listen(const net::EnetOptions& options) {
  std::string problem;
  auto socket = net::EnetTransport::listen(options, &problem);
  if (!socket.ok()) {
    throw_status(static_cast<lks_status>(socket.status()), "cannot listen on " + problem);
  }
  return std::move(socket).value();
}

// Calls the next server of the list, which begins again after its end.
lks_connection call_server(Carrier& carrier) {
  const net::HostPort server = carrier.servers[carrier.next_server % carrier.servers.size()];
  ++carrier.next_server;
  auto connection = socket_of(carrier).connect(server.host, server.port);
  if (!connection.ok()) {
    throw_status(static_cast<lks_status>(connection.status()),
                 "cannot connect to " + server.to_text());
  }
  return connection.value();
}

void give_client(std::shared_ptr<Carrier> carrier, lks_transport** out,
                 lks_connection* connection) {
  const lks_connection called = call_server(*carrier);
  *out = new lks_transport{std::move(carrier)};
  *connection = called;
}

std::shared_ptr<Carrier> open_socket(const net::EnetOptions& options) {
  auto carrier = std::make_shared<Carrier>();
  carrier->socket = value_of(net::EnetTransport::open(options));
  carrier->session = carrier->socket.get();
  return carrier;
}

void encrypt_client(Carrier& carrier, const net::ConnectToken& token) {
  for (std::size_t i = 0; i < token.grant.servers.count; ++i)
    carrier.servers.push_back(token.grant.servers.entries[i].to_host_port());
  if (carrier.servers.empty()) throw_invalid("token", "names no server");
  carrier.random = std::make_unique<net::SystemRandom>();
  carrier.secure = value_of(net::SecureTransport::join(*carrier.socket, token, *carrier.random));
  carrier.session = carrier.secure.get();
}

}  // namespace

lks_status lks_enet_def_init(lks_enet_def* def, size_t size) {
  return call([&] { give(raw_def(), def, size, "def"); });
}

lks_status lks_enet_listen(const lks_enet_def* def, const char* address, const void* key,
                           lks_transport** out) {
  return call([&] {
    const lks_enet_def raw = take(def, raw_def(), "def");
    required(out, "out");
    net::EnetOptions options = options_of(raw, address);
    auto carrier = std::make_shared<Carrier>();
    if (key != nullptr) {
      options.link_key = net::make_link_key(key_of(key), raw.match_id);
      options.match_tag = net::make_match_tag(raw.match_id);
    }
    carrier->socket = listen(options);
    carrier->session = carrier->socket.get();
    if (key != nullptr) encrypt_server(*carrier, raw, key_of(key));
    *out = new lks_transport{std::move(carrier)};
  });
}

lks_status lks_enet_connect(const char* address, uint32_t port, lks_transport** out,
                            lks_connection* connection) {
  return call([&] {
    required(out, "out");
    required(connection, "connection");
    const net::HostPort server{&required(address, "address"), narrow<std::uint16_t>(port, "port")};
    auto carrier = open_socket({});
    carrier->servers.push_back(server);
    give_client(std::move(carrier), out, connection);
  });
}

lks_status lks_enet_join(const char* token, lks_transport** out, lks_connection* connection) {
  return call([&] {
    required(out, "out");
    required(connection, "connection");
    const net::ConnectToken shown =
        value_of(net::ConnectToken::from_text(&required(token, "token")));
    if (!net::security_available())
      throw_status(LKS_UNSUPPORTED, "the library was built without libsodium");
    net::EnetOptions options;
    options.link_key = shown.link_key;
    options.match_tag = net::make_match_tag(shown.grant.match);
    auto carrier = open_socket(options);
    encrypt_client(*carrier, shown);
    give_client(std::move(carrier), out, connection);
  });
}

lks_status lks_enet_connect_again(lks_transport* transport, lks_connection* connection) {
  return call([&] {
    Carrier& carrier = *required(transport, "transport").carrier;
    socket_of(carrier);
    if (carrier.servers.empty()) throw_invalid("transport", "is a server's");
    required(connection, "connection") = call_server(carrier);
  });
}

lks_status lks_enet_port(const lks_transport* transport, uint32_t* out) {
  return call([&] {
    const std::uint16_t port = socket_of(transport).port();
    required(out, "out") = port;
  });
}

lks_status lks_enet_wait(lks_transport* transport, int64_t limit_us) {
  return call([&] {
    net::EnetTransport& socket = socket_of(transport);
    if (limit_us < 0) throw_invalid("limit_us", "must not be negative");
    socket.wait(std::min<std::int64_t>(limit_us, 60'000'000));
  });
}

lks_status lks_issue_token(const void* key, uint64_t match_id, uint64_t player, uint32_t slot,
                           uint64_t expires_unix_s, const char* address, uint32_t port, char* out,
                           size_t capacity) {
  return call([&] {
    if (key == nullptr) throw_status(LKS_NULL_ARGUMENT, "key is null");
    required(out, "out");
    net::TokenGrant grant;
    grant.match = match_id;
    grant.player = player;
    grant.slot = narrow<std::uint8_t>(slot, "slot");
    grant.expires_unix_s = expires_unix_s;
    const net::HostPort server{&required(address, "address"), narrow<std::uint16_t>(port, "port")};
    grant.servers.add(value_of(net::ServerAddress::from_text(server.to_text())));
    net::SystemRandom random;
    const std::string text = value_of(net::issue_token(key_of(key), grant, random)).to_text();
    if (text.size() >= capacity) {
      throw_status(LKS_BUFFER_TOO_SMALL,
                   "the token needs " + std::to_string(text.size() + 1) + " bytes");
    }
    write_text(text, out, capacity);
  });
}

#else

namespace {

lks_status absent() {
  return lockstone::c::call(
      [] { lockstone::c::throw_status(LKS_UNSUPPORTED, "the library was built without ENet"); });
}

}  // namespace

lks_status lks_enet_def_init(lks_enet_def*, size_t) {
  return absent();
}
lks_status lks_enet_listen(const lks_enet_def*, const char*, const void*, lks_transport**) {
  return absent();
}
lks_status lks_enet_connect(const char*, uint32_t, lks_transport**, lks_connection*) {
  return absent();
}
lks_status lks_enet_join(const char*, lks_transport**, lks_connection*) {
  return absent();
}
lks_status lks_enet_connect_again(lks_transport*, lks_connection*) {
  return absent();
}
lks_status lks_enet_port(const lks_transport*, uint32_t*) {
  return absent();
}
lks_status lks_enet_wait(lks_transport*, int64_t) {
  return absent();
}
lks_status lks_issue_token(const void*, uint64_t, uint64_t, uint32_t, uint64_t, const char*,
                           uint32_t, char*, size_t) {
  return absent();
}

#endif
