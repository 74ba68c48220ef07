// A transport whose events a test writes, and which notes all that is sent.
#pragma once

#include <deque>
#include <map>
#include <vector>

#include <lockstone/net/transport.h>

namespace lockstone::net::test {

class ScriptedCarrier final : public Transport {
 public:
  struct Sent {
    ConnectionId connection = k_no_connection;
    Channel channel = Channel::reliable;
    std::vector<std::byte> bytes;
    friend bool operator==(const Sent&, const Sent&) = default;
  };

  /// A player of the match has come.
  ConnectionId connect(std::uint64_t match) {
    const ConnectionId connection = ++last_;
    identities_[connection] = {true, match, connection, 0};
    push(TransportEventKind::connected, connection);
    return connection;
  }
  void lose(ConnectionId connection) { push(TransportEventKind::disconnected, connection); }
  void receive(ConnectionId connection, Channel channel, std::vector<std::byte> bytes) {
    push(TransportEventKind::received, connection);
    coming_.back().channel = channel;
    coming_.back().bytes = std::move(bytes);
  }

  bool poll(std::int64_t, TransportEvent& event) override {
    while (!coming_.empty()) {
      current_ = std::move(coming_.front());
      coming_.pop_front();
      if (!identities_.contains(current_.connection)) continue;  // ended by this side
      event = {current_.kind, current_.connection, current_.channel, current_.bytes,
               RefuseReason::none};
      if (current_.kind == TransportEventKind::disconnected) identities_.erase(current_.connection);
      return true;
    }
    return false;
  }
  Status send(ConnectionId connection, Channel channel, ByteView bytes) override {
    if (!identities_.contains(connection)) return Status::stale_handle;
    if (full) return Status::capacity_exhausted;
    sent.push_back({connection, channel, {bytes.begin(), bytes.end()}});
    return Status::ok;
  }
  void flush() override {}
  void disconnect(ConnectionId connection) override {
    if (identities_.erase(connection) != 0) ended.push_back(connection);
  }
  void trust(ConnectionId connection) override { trusted.push_back(connection); }
  [[nodiscard]] TransportStats stats(ConnectionId) const override { return {}; }
  [[nodiscard]] bool secure() const override { return true; }
  [[nodiscard]] PeerIdentity identity(ConnectionId connection) const override {
    const auto found = identities_.find(connection);
    return found == identities_.end() ? PeerIdentity{} : found->second;
  }
  [[nodiscard]] bool idle() const { return coming_.empty(); }

  std::vector<Sent> sent;
  std::vector<ConnectionId> ended;  ///< by this side
  std::vector<ConnectionId> trusted;
  bool full = false;

 private:
  struct Coming {
    TransportEventKind kind = TransportEventKind::received;
    ConnectionId connection = k_no_connection;
    Channel channel = Channel::reliable;
    std::vector<std::byte> bytes;
  };
  void push(TransportEventKind kind, ConnectionId connection) {
    coming_.push_back({kind, connection, Channel::reliable, {}});
  }

  ConnectionId last_ = 0;
  std::map<ConnectionId, PeerIdentity> identities_;
  std::deque<Coming> coming_;
  Coming current_;
};

}  // namespace lockstone::net::test
