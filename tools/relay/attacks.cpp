#include "tools/relay/attacks.h"

#include <algorithm>
#include <array>

#include <lockstone/net/wire.h>

#include "net/transport/enet/enet_datagram.h"

namespace lockstone::relay {

// ENet's CONNECT command with a random number of the connection, after a head with the time.
std::vector<std::byte> connect_datagram(net::Random& random, bool with_checksum) {
  std::vector<std::byte> bytes{std::byte{0x8f}, std::byte{0xff}, std::byte{1}, std::byte{2}};
  if (with_checksum) bytes.resize(8);
  const std::array<std::uint8_t, 40> command{
      0x82, 0xff, 0, 1, 0, 0, 0xff, 0xff, 0, 0, 5,    0x78, 0, 1, 0, 0, 0, 0, 0, 2,
      0,    0,    0, 0, 0, 0, 0,    0,    0, 0, 0x13, 0x88, 0, 0, 0, 2, 0, 0, 0, 2};
  for (const std::uint8_t byte : command)
    bytes.push_back(std::byte{byte});
  for (int i = 0; i < 4; ++i)
    bytes.push_back(static_cast<std::byte>(random.below(256)));
  bytes.resize(bytes.size() + 4);
  return bytes;
}

namespace {

using Bytes = std::vector<std::byte>;

constexpr Endpoint k_elsewhere{0x7f000002, 0};  // on this machine, but not the players' address

// The base of all attackers with sockets of their own.
class SocketAttack : public Attack {
 public:
  SocketAttack(const char* name, const TrialMatch& match, std::uint64_t seed, std::size_t sockets)
      : target_(Endpoint::loopback(match.port())), random_(seed) {
    report_.name = name;
    for (std::size_t i = 0; i < sockets; ++i) {
      auto socket = UdpSocket::open(k_elsewhere);
      if (socket) sockets_.push_back(std::move(socket).value());
    }
  }

  void step(std::int64_t now_us) override {
    std::array<std::byte, 2048> buffer{};
    Endpoint from;
    for (const auto& socket : sockets_)
      while (socket->receive(from, buffer))
        ++report_.answered;
    if (now_us < next_us_ || sockets_.empty()) return;
    next_us_ = now_us + 2000;
    attack();
  }

 protected:
  virtual void attack() = 0;

  void send(ByteView bytes) {
    const auto& socket = sockets_[report_.sent % sockets_.size()];
    static_cast<void>(socket->send(target_, bytes));
    ++report_.sent;
  }

  void fill(std::span<std::byte> bytes) {
    for (std::byte& byte : bytes)
      byte = static_cast<std::byte>(random_.below(256));
  }

  Endpoint target_;
  net::Random random_;
  std::vector<std::unique_ptr<UdpSocket>> sockets_;

 private:
  std::int64_t next_us_ = 0;
};

class ForgedConnects final : public SocketAttack {
 public:
  ForgedConnects(const TrialMatch& match, std::uint64_t seed)
      : SocketAttack("forged connects", match, seed, 64) {}

 private:
  void attack() override {
    Bytes bytes = connect_datagram(random_, report_.sent % 2 == 1);
    if (bytes.size() == 56) fill(std::span(bytes).subspan(4, 4));
    send(bytes);
  }
};

class Garbage final : public SocketAttack {
 public:
  Garbage(const TrialMatch& match, std::uint64_t seed) : SocketAttack("garbage", match, seed, 8) {}

 private:
  void attack() override {
    const std::array<std::size_t, 6> sizes{1, 12, 60, 600, 1400, 9000};
    Bytes bytes(1 + random_.below(sizes[report_.sent % sizes.size()]));
    fill(bytes);
    if (report_.sent % 3 == 0 && bytes.size() > 2) {
      bytes[0] = std::byte{0x80};  // to a connection that exists
      bytes[1] = static_cast<std::byte>(random_.below(4));
    }
    send(bytes);
  }
};

class Oversized final : public SocketAttack {
 public:
  Oversized(const TrialMatch& match, std::uint64_t seed)
      : SocketAttack("oversized", match, seed, 4) {}

 private:
  void attack() override {
    constexpr int k_at_once = 10;  // 5000 a second
    Bytes bytes(5000);
    fill(bytes);
    for (int i = 0; i < k_at_once; ++i)
      send(bytes);
  }
};

class RepeatedConnects final : public SocketAttack {
 public:
  RepeatedConnects(const TrialMatch& match, std::uint64_t seed)
      : SocketAttack("repeated connects", match, seed, 64), recorded_(record(match)) {}

 private:
  // The first datagrams of a client of the match, caught by a socket that does not answer.
  static Bytes record(const TrialMatch& match) {
    const auto trap = UdpSocket::open(Endpoint::loopback(0));
    net::EnetOptions options;
    options.link_key = match.token_for(50, 0, TrialMatch::unix_s_at_zero() + 60).link_key;
    const auto caller = net::EnetTransport::open(options);
    if (!trap || !caller) return {};
    static_cast<void>(caller.value()->connect("127.0.0.1", trap.value()->port()));
    net::TransportEvent event;
    std::array<std::byte, 2048> buffer{};
    Endpoint from;
    for (int i = 0; i < 100'000; ++i) {
      static_cast<void>(caller.value()->poll(0, event));
      caller.value()->flush();
      if (const auto bytes = trap.value()->receive(from, buffer))
        return {bytes->begin(), bytes->end()};
    }
    return {};
  }

  void attack() override {
    if (!recorded_.empty()) send(recorded_);
  }

  Bytes recorded_;
};

// One after the other, each until it is over.
class BadTokens final : public Attack {
 public:
  BadTokens(const TrialMatch& match, std::uint64_t seed) : match_(match), random_(seed) {
    report_.name = "bad tokens";
  }

  void step(std::int64_t now_us) override {
    if (secure_ == nullptr) begin(now_us);
    if (secure_ == nullptr) return;
    net::TransportEvent event;
    bool over = now_us - since_us_ > 1'000'000;
    while (!over && secure_->poll(now_us, event)) {
      if (event.kind == net::TransportEventKind::connected) ++report_.admitted;
      if (event.reason != net::RefuseReason::none) ++report_.answered;
      over = true;
    }
    secure_->flush();
    if (!over) return;
    secure_.reset();
    enet_.reset();
  }

 private:
  void begin(std::int64_t now_us) {
    token_ = next_token();
    net::EnetOptions options;
    options.link_key = token_.link_key;
    auto opened = net::EnetTransport::open(options);
    if (!opened) return;
    enet_ = std::move(opened).value();
    secure_ = std::move(net::SecureTransport::join(*enet_, token_, system_)).value();
    static_cast<void>(enet_->connect("127.0.0.1", match_.port()));
    since_us_ = now_us;
    ++report_.sent;
  }

  net::ConnectToken next_token() {
    const std::uint64_t now_s = TrialMatch::unix_s_at_zero();
    net::ConnectToken token = match_.token_for(60, 0, now_s + 60);
    switch (report_.sent % 4) {
      case 0:
        token.sealed[random_.below(token.sealed.size())] ^= std::byte{1};
        break;
      case 1:
        return match_.token_for(60, 0, now_s - 1);
      case 2:  // longer than it was issued for
        token.grant.expires_unix_s += 3600;
        break;
      default:  // stolen from the wire, where its keys are not
        token.client_key = net::make_key(system_);
        token.server_key = net::make_key(system_);
        break;
    }
    return token;
  }

  const TrialMatch& match_;
  net::Random random_;
  net::SystemRandom system_;
  net::ConnectToken token_;
  std::unique_ptr<net::EnetTransport> enet_;
  std::unique_ptr<net::SecureTransport> secure_;
  std::int64_t since_us_ = 0;
};

class Flood final : public Attack {
 public:
  Flood(TrialMatch& match, unsigned slot, unsigned per_second)
      : match_(match), slot_(slot), pause_us_(1'000'000 / per_second) {
    report_.name = "flood of a player";
  }

  void step(std::int64_t now_us) override {
    if ((match_.present_mask() >> slot_ & 1) == 0 || match_.ticks_confirmed() == 0) return;
    constexpr std::int64_t k_most_at_once = 32;
    if (due_us_ == 0) due_us_ = now_us;
    due_us_ = std::max(due_us_, now_us - k_most_at_once * pause_us_);
    // Well-formed, and nothing new in it: the message of an idle client, four times a second.
    std::array<std::byte, 64> bytes{};
    const std::size_t size = encode(net::Inputs{}, bytes);
    for (; due_us_ <= now_us; due_us_ += pause_us_) {
      static_cast<void>(match_.transport_of(slot_).send(
          match_.connection_of(slot_), net::Channel::unreliable, ByteView(bytes).first(size)));
      ++report_.sent;
    }
  }

 private:
  TrialMatch& match_;
  unsigned slot_;
  std::int64_t pause_us_;
  std::int64_t due_us_ = 0;
};

}  // namespace

std::unique_ptr<Attack> forged_connects(const TrialMatch& match, std::uint64_t seed) {
  return std::make_unique<ForgedConnects>(match, seed);
}
std::unique_ptr<Attack> garbage(const TrialMatch& match, std::uint64_t seed) {
  return std::make_unique<Garbage>(match, seed);
}
std::unique_ptr<Attack> oversized(const TrialMatch& match, std::uint64_t seed) {
  return std::make_unique<Oversized>(match, seed);
}
std::unique_ptr<Attack> repeated_connects(const TrialMatch& match, std::uint64_t seed) {
  return std::make_unique<RepeatedConnects>(match, seed);
}
std::unique_ptr<Attack> bad_tokens(const TrialMatch& match, std::uint64_t seed) {
  return std::make_unique<BadTokens>(match, seed);
}
std::unique_ptr<Attack> flood(TrialMatch& match, unsigned slot, unsigned per_second) {
  return std::make_unique<Flood>(match, slot, per_second);
}

}  // namespace lockstone::relay
