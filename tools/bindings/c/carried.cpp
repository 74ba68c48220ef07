// Transports whose messages the program carries itself.
#include <algorithm>

#include <lockstone/net/token.h>

#include "tools/bindings/c/game_handles.h"

using namespace lockstone;
using namespace lockstone::c;

namespace {

net::MessageTransport& carried(const lks_transport* transport) {
  net::MessageTransport* found = required(transport, "transport").carrier->carried;
  if (found == nullptr) throw_invalid("transport", "is not carried by the program");
  return *found;
}

void encrypt(Carrier& carrier, const char* text) {
  if (!net::security_available())
    throw_status(LKS_UNSUPPORTED, "the library was built without libsodium");
  const net::ConnectToken token = value_of(net::ConnectToken::from_text(text));
  carrier.random = std::make_unique<net::SystemRandom>();
  carrier.secure = value_of(net::SecureTransport::join(*carrier.carried, token, *carrier.random));
  carrier.session = carrier.secure.get();
}

}  // namespace

lks_status lks_carried_create(const char* token, lks_transport** out) {
  return call([&] {
    required(out, "out");
    auto carrier = std::make_shared<Carrier>();
    auto socket = std::make_unique<net::MessageTransport>();
    carrier->carried = socket.get();
    carrier->socket = std::move(socket);
    carrier->session = carrier->socket.get();
    if (token != nullptr) encrypt(*carrier, token);
    *out = new lks_transport{std::move(carrier)};
  });
}

lks_status lks_carried_call(lks_transport* transport, lks_connection* connection) {
  return call([&] {
    net::MessageTransport& socket = carried(transport);
    required(connection, "connection") = socket.open();
  });
}

lks_status lks_carried_opened(lks_transport* transport) {
  return call([&] { carried(transport).opened(); });
}

lks_status lks_carried_receive(lks_transport* transport, const void* message, size_t bytes) {
  return call([&] {
    if (!carried(transport).receive(bytes_of(message, bytes, "message")))
      throw_status(LKS_MALFORMED, "the connection has ended: close its WebSocket");
  });
}

lks_status lks_carried_take(lks_transport* transport, void* out, size_t capacity, size_t* bytes) {
  return call([&] {
    net::MessageTransport& socket = carried(transport);
    give_bytes(socket.next_message(), out, capacity, required(bytes, "bytes"), "the message");
    if (*bytes > 0) socket.take_message();
  });
}

lks_status lks_carried_closed(lks_transport* transport, uint32_t code) {
  return call([&] { carried(transport).closed(code); });
}

lks_status lks_carried_is_open(const lks_transport* transport, uint32_t* out) {
  return call([&] {
    const bool open = carried(transport).is_open();
    required(out, "out") = open ? 1 : 0;
  });
}
