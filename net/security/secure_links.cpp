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
  if (connection == k_no_connection) return nullptr;
  const auto found = std::find(ids_.begin(), ids_.end(), connection);
  return found == ids_.end() ? nullptr : &links_[static_cast<std::size_t>(found - ids_.begin())];
}

SecureLink* SecureLinks::add(ConnectionId connection, std::int64_t now_us) {
  const auto place = std::find(ids_.begin(), ids_.end(), k_no_connection);
  if (place == ids_.end()) return nullptr;
  *place = connection;
  SecureLink& link = links_[static_cast<std::size_t>(place - ids_.begin())];
  link.connection = connection;
  link.stage = SecureStage::greeting;
  link.since_us = now_us;
  return &link;
}

void SecureLinks::release(SecureLink& link) {
  crypto::wipe(std::as_writable_bytes(std::span(&link.sealer, 1)));
  crypto::wipe(std::as_writable_bytes(std::span(&link.opener, 1)));
  crypto::wipe(link.secret.bytes);
  ids_[static_cast<std::size_t>(&link - links_.data())] = k_no_connection;
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
