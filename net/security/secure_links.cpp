#include "net/security/secure_links.h"

#include <algorithm>
#include <span>

#include "net/security/crypto.h"

namespace lockstone::net {

SecureLinks::~SecureLinks() {
  for (SecureLink& link : links_)
    release(link);
}

SecureLink* SecureLinks::find(ConnectionId connection) {
  const auto found = std::find_if(links_.begin(), links_.end(), [connection](const auto& link) {
    return link.stage != SecureStage::unused && link.connection == connection;
  });
  return found == links_.end() ? nullptr : &*found;
}

SecureLink* SecureLinks::add(ConnectionId connection, std::int64_t now_us) {
  const auto place = std::find_if(links_.begin(), links_.end(), [](const SecureLink& link) {
    return link.stage == SecureStage::unused;
  });
  if (place == links_.end()) return nullptr;
  place->connection = connection;
  place->stage = SecureStage::greeting;
  place->since_us = now_us;
  return &*place;
}

void SecureLinks::release(SecureLink& link) {
  crypto::wipe(std::as_writable_bytes(std::span(&link.sealer, 1)));
  crypto::wipe(std::as_writable_bytes(std::span(&link.opener, 1)));
  crypto::wipe(link.secret.bytes);
  link = {};
}

bool SecureLinks::close(SecureLink& link, RefuseReason reason, TransportEvent& event) {
  event = {};
  event.kind = TransportEventKind::disconnected;
  event.connection = link.connection;
  event.reason = reason;
  release(link);
  carrier_.disconnect(event.connection);
  return true;
}

bool SecureLinks::open(SecureLink& link, TransportEvent& event) {
  link.stage = SecureStage::open;
  event = {};
  event.kind = TransportEventKind::connected;
  event.connection = link.connection;
  return true;
}

bool SecureLinks::send_plain(const SecureLink& link, ByteView bytes) {
  return carrier_.send(link.connection, Channel::reliable, bytes) == Status::ok;
}

}  // namespace lockstone::net
