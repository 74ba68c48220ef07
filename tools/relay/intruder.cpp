#include "tools/relay/intruder.h"

#include <algorithm>
#include <array>
#include <vector>

namespace lockstone::relay {

// Learns the keys of the datagrams, and may keep the proof back.
class Intruder::Tap final : public net::Transport {
 public:
  Tap(net::Transport& carrier, bool proves) : carrier_(carrier), proves_(proves) {}

  bool poll(std::int64_t now_us, net::TransportEvent& event) override {
    return carrier_.poll(now_us, event);
  }
  Status send(net::ConnectionId connection, net::Channel channel, ByteView bytes) override {
    const bool swallowed = !proves_ && keys_;
    return swallowed ? Status::ok : carrier_.send(connection, channel, bytes);
  }
  void flush() override { carrier_.flush(); }
  void disconnect(net::ConnectionId connection) override { carrier_.disconnect(connection); }
  [[nodiscard]] net::TransportStats stats(net::ConnectionId connection) const override {
    return carrier_.stats(connection);
  }
  void protect(net::ConnectionId connection, const net::DatagramKeys& keys,
               bool peer_has_them) override {
    keys_ = keys;
    carrier_.protect(connection, keys, peer_has_them);
  }

  [[nodiscard]] const std::optional<net::DatagramKeys>& keys() const { return keys_; }

 private:
  net::Transport& carrier_;
  bool proves_;
  std::optional<net::DatagramKeys> keys_;
};

Intruder::Intruder(const Endpoint& server, const net::LinkKey& link_key)
    : server_(server), checksum_(link_key) {}
Intruder::~Intruder() = default;

std::unique_ptr<Intruder> Intruder::call(std::uint32_t address, const Endpoint& server,
                                         const net::ConnectToken& token, Conduct conduct) {
  auto intruder = std::unique_ptr<Intruder>(new Intruder(server, token.link_key));
  if (!intruder->open(address, token, conduct)) return nullptr;
  return intruder;
}

bool Intruder::open(std::uint32_t address, const net::ConnectToken& token, Conduct conduct) {
  net::EnetOptions options;
  options.max_connections = 1;
  options.link_key = token.link_key;
  options.match_tag = net::make_match_tag(token.grant.match);
  auto socket = UdpSocket::open({address, 0});
  auto enet = net::EnetTransport::open(options);
  if (!socket || !enet) return false;
  socket_ = std::move(socket).value();
  enet_ = std::move(enet).value();
  if (conduct != Conduct::silent) {
    tap_ = std::make_unique<Tap>(*enet_, conduct == Conduct::all_the_way);
    secure_ = std::move(net::SecureTransport::join(*tap_, token, random_)).value();
  }
  const auto connection = enet_->connect(to_text(address), socket_->port());
  if (connection) connection_ = connection.value();
  return connection.ok();
}

net::Transport& Intruder::transport() {
  if (secure_ != nullptr) return *secure_;
  return *enet_;
}

void Intruder::pump() {
  std::array<std::byte, 2048> buffer{};
  Endpoint from;
  while (const auto datagram = socket_->receive(from, buffer)) {
    if (from == server_) {
      ++answers_;
      static_cast<void>(socket_->send(client_, *datagram));
      continue;
    }
    client_ = from;
    if (injected_) continue;
    if (!asked_ && datagram->size() >= 52) {
      asked_ = true;
      std::copy_n(datagram->begin() + 48, id_.size(), id_.begin());
    }
    std::copy_n(datagram->begin(), head_.size(), head_.begin());
    static_cast<void>(socket_->send(server_, *datagram));
  }
}

void Intruder::poll(std::int64_t now_us) {
  net::TransportEvent event;
  while (transport().poll(now_us, event)) {
    if (event.kind == net::TransportEventKind::connected) connected_ = true;
    if (event.kind == net::TransportEventKind::disconnected) ended_ = true;
  }
  transport().flush();
}

void Intruder::inject(ByteView commands) {
  if (!injected_ && tap_ != nullptr && tap_->keys()) {
    seal_ = net::DatagramSeal(*tap_->keys(), true);
    // Beyond the counter of the client's own ENet.
    std::array<std::byte, 32> burnt{};
    for (int i = 0; i < 1000; ++i)
      static_cast<void>(seal_->seal(burnt));
  }
  injected_ = true;
  constexpr std::size_t k_sealed_head_bytes = 8;
  std::vector<std::byte> bytes(k_sealed_head_bytes + commands.size() +
                               (seal_ ? net::DatagramSeal::k_bytes : 0));
  bytes[0] = head_[0] | std::byte{0x80};
  bytes[1] = head_[1];
  std::copy(id_.begin(), id_.end(), bytes.begin() + 4);
  std::copy(commands.begin(), commands.end(), bytes.begin() + k_sealed_head_bytes);
  const net::Word word = seal_ ? seal_->seal(bytes) : checksum_.of(bytes);
  std::copy(word.begin(), word.end(), bytes.begin() + 4);
  static_cast<void>(socket_->send(server_, bytes));
}

}  // namespace lockstone::relay
