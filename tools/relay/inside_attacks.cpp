// Attacks of those who hold the match's link key or a good token, and the honest visitors.
#include <algorithm>
#include <array>
#include <utility>

#include <lockstone/net/client.h>

#include "net/transport/enet/enet_commands.h"
#include "tools/relay/attacks.h"
#include "tools/relay/intruder.h"

namespace lockstone::relay {
namespace {

using Conduct = Intruder::Conduct;

constexpr std::int64_t k_call_patience_us = 2'500'000;
constexpr std::int64_t k_shortest_call_us = 20'000;
constexpr std::uint32_t k_walkers = 0x7f000a00;  // 127.0.10.…
constexpr std::uint32_t k_door_shutter = 0x7f000b01;
constexpr std::uint32_t k_stormers = 0x7f000c00;
constexpr std::uint32_t k_visitors = 0x7f000d00;
constexpr std::uint64_t k_walking_player = 90;
constexpr std::uint64_t k_first_visitor = 1000;
constexpr std::uint64_t k_token_seconds = 7200;

constexpr unsigned k_datagram_packets = net::CommandFilter::k_max_commands;
constexpr unsigned k_filling_datagrams = net::CommandFilter::k_max_waiting / k_datagram_packets;

net::ConnectToken watcher_token(const TrialMatch& match, std::uint64_t player) {
  return match.token_for(player, net::k_spectator_slot,
                         TrialMatch::unix_s_at_zero() + k_token_seconds);
}

// Reliable packets of one byte, as many as a datagram may hold.
std::vector<std::byte> packets(unsigned first, unsigned step) {
  std::vector<std::byte> bytes;
  for (unsigned i = 0; i < net::CommandFilter::k_max_commands; ++i) {
    const unsigned sequence = first + i * step;
    for (const unsigned value : {0x86U, 0U, sequence >> 8, sequence & 0xffU, 0U, 1U, 7U})
      bytes.push_back(static_cast<std::byte>(value));
  }
  return bytes;
}

// Connections that are made again when they end.
class Connections : public Attack {
 public:
  Connections(const char* name, const TrialMatch& match, std::size_t count)
      : match_(match), server_(Endpoint::loopback(match.port())), calls_(count) {
    report_.name = name;
  }

  void step(std::int64_t now_us) override {
    for (std::size_t i = 0; i < calls_.size(); ++i) {
      Call& call = calls_[i];
      if (call.intruder == nullptr) begin(i, now_us);
      if (call.intruder == nullptr) continue;
      call.intruder->pump();
      call.intruder->poll(now_us);
      call.intruder->pump();
      const bool serves = attack(call, now_us) && !call.intruder->ended();
      if (serves || now_us - call.since_us < k_shortest_call_us) continue;
      report_.answered += call.intruder->answers();
      call.intruder.reset();
    }
  }

 protected:
  struct Call {
    std::unique_ptr<Intruder> intruder;
    std::int64_t since_us = 0;
    std::int64_t due_us = 0;
    unsigned injected = 0;
  };

  [[nodiscard]] virtual std::unique_ptr<Intruder> open(std::size_t index) = 0;
  /// False once this connection has served.
  [[nodiscard]] virtual bool attack(Call& call, std::int64_t now_us) = 0;

  const TrialMatch& match_;
  Endpoint server_;

 private:
  void begin(std::size_t index, std::int64_t now_us) {
    calls_[index] = {open(index), now_us, 0, 0};
  }

  std::vector<Call> calls_;
};

class Walk final : public Connections {
 public:
  Walk(const char* name, const TrialMatch& match, std::size_t count, bool proves)
      : Connections(name, match, count), proves_(proves) {
    token_ = watcher_token(match, k_walking_player);
    // The number of commands of the handshake, and one that never comes.
    first_ = proves ? 4 : 2;
  }

 private:
  std::unique_ptr<Intruder> open(std::size_t index) override {
    const std::uint32_t address = k_walkers + static_cast<std::uint32_t>(proves_ ? 100 : index + 1);
    return Intruder::call(address, server_, token_,
                          proves_ ? Conduct::all_the_way : Conduct::silent);
  }

  bool attack(Call& call, std::int64_t now_us) override {
    constexpr std::int64_t k_most_at_once = 4;
    constexpr std::int64_t k_pause_us = 5000;  // 200 datagrams of 240 bytes a second
    if (!call.intruder->connected()) return now_us - call.since_us < k_call_patience_us;
    // Calls that this attacker missed on a busy machine are not made up for.
    call.due_us = std::max(call.due_us, now_us - k_most_at_once * k_pause_us);
    if (call.injected == 0) call.due_us = now_us;
    for (; call.due_us <= now_us; call.due_us += k_pause_us) {
      const unsigned number = call.injected++;
      const bool fills = number < k_filling_datagrams;
      call.intruder->inject(fills ? packets(first_ + number * k_datagram_packets, 1)
                                  : packets(first_, 0));
      ++report_.sent;
    }
    // The server sends both kinds away after 5 s without a hello.
    return now_us - call.since_us < 2 * k_call_patience_us;
  }

  bool proves_;
  unsigned first_;
  net::ConnectToken token_;
};

class ShutDoor final : public Connections {
 public:
  ShutDoor(const TrialMatch& match, std::size_t count)
      : Connections("door shut by one", match, count), token_(watcher_token(match, 0)) {}

 private:
  std::unique_ptr<Intruder> open(std::size_t) override {
    ++report_.sent;
    return Intruder::call(k_door_shutter, server_, token_, Conduct::silent);
  }
  bool attack(Call& call, std::int64_t now_us) override {
    return call.intruder->connected() || now_us - call.since_us < k_call_patience_us;
  }

  net::ConnectToken token_;
};

class Storm final : public Connections {
 public:
  explicit Storm(const TrialMatch& match)
      : Connections("reconnects, one token", match, 8),
        token_(watcher_token(match, k_storming_player)) {}

 private:
  std::unique_ptr<Intruder> open(std::size_t index) override {
    const bool proves = ++report_.sent % 2 == 0;
    return Intruder::call(k_stormers + static_cast<std::uint32_t>(index + 1), server_, token_,
                          proves ? Conduct::all_the_way : Conduct::half_way);
  }
  // Gone without a word as soon as it is in.
  bool attack(Call& call, std::int64_t now_us) override {
    constexpr std::int64_t k_pause_us = 50'000;
    const std::int64_t age_us = now_us - call.since_us;
    return call.intruder->connected() ? age_us < k_pause_us : age_us < k_call_patience_us;
  }

  net::ConnectToken token_;
};

}  // namespace

std::unique_ptr<Attack> walk_of_a_player(const TrialMatch& match) {
  return std::make_unique<Walk>("walk of a player", match, 1, true);
}
std::unique_ptr<Attack> walk_of_strangers(const TrialMatch& match, std::size_t strangers) {
  return std::make_unique<Walk>("walk of strangers", match, strangers, false);
}
std::unique_ptr<Attack> shut_door(const TrialMatch& match, std::size_t connections) {
  return std::make_unique<ShutDoor>(match, connections);
}
std::unique_ptr<Attack> reconnect_storm(const TrialMatch& match) {
  return std::make_unique<Storm>(match);
}

struct Visitors::One {
  struct NoInputs final : net::InputSource {
    void sample(std::uint64_t, std::span<std::byte>) override {}
  };

  std::unique_ptr<Intruder> line;
  NoInputs inputs;
  std::unique_ptr<net::Client> client;
  std::int64_t farewell_us = 0;
  bool seated = false;
  bool over = false;

  void come(const TrialMatch& match, std::uint32_t number) {
    line = Intruder::call(k_visitors + number + 1, Endpoint::loopback(match.port()),
                          watcher_token(match, k_first_visitor + number), Conduct::all_the_way);
    if (line == nullptr) return;
    net::ClientConfig config;
    config.wanted_slot = net::k_spectator_slot;
    net::ClientParts parts;
    parts.transport = &line->transport();
    parts.connection = line->connection();
    parts.factory = match.factory();
    parts.inputs = &inputs;
    client = net::Client::create(config, std::move(parts)).client;
  }

  void step(std::int64_t now_us) {
    line->pump();
    client->update(now_us);
    line->pump();
    const bool inside = client->slot() == net::k_spectator_slot;
    if (!inside) {
      over = client->state() >= net::ClientState::finished;
      return;
    }
    if (!seated) client->leave();
    if (!std::exchange(seated, true)) farewell_us = now_us + 100'000;
    over = now_us > farewell_us;
  }
};

Visitors::Visitors(const TrialMatch& match, unsigned count, std::int64_t span_us)
    : match_(match), span_us_(span_us) {
  for (unsigned i = 0; i < count; ++i)
    visitors_.push_back(std::make_unique<One>());
}
Visitors::~Visitors() = default;

void Visitors::step(std::int64_t now_us) {
  for (std::size_t i = 0; i < visitors_.size(); ++i) {
    One& one = *visitors_[i];
    const auto number = static_cast<std::int64_t>(i + 1);
    const auto count = static_cast<std::int64_t>(visitors_.size());
    if (one.over || now_us < span_us_ * number / count) continue;
    if (one.line == nullptr) one.come(match_, static_cast<std::uint32_t>(i));
    one.over = one.client == nullptr;
    if (one.over) continue;
    one.step(now_us);
    if (!one.over) continue;
    one.client.reset();
    one.line.reset();
  }
}

bool Visitors::over() const {
  return std::all_of(visitors_.begin(), visitors_.end(), [](const auto& one) { return one->over; });
}

unsigned Visitors::seated() const {
  return static_cast<unsigned>(std::count_if(visitors_.begin(), visitors_.end(),
                                             [](const auto& one) { return one->seated; }));
}

}  // namespace lockstone::relay
