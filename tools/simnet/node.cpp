#include "tools/simnet/node.h"

#include <string>
#include <utility>
#include <vector>

#include <lockstone/hash.h>

#include "tools/toy/toy_simulation.h"

namespace lockstone::simnet {

void Node::start(net::SimNetwork& network, net::SimTransport& server, std::uint64_t key,
                 const net::LinkFaults& faults, const net::ClientConfig& config,
                 const SimulationFactory& factory, Lie lie) {
  endpoint_ = &network.add_endpoint();
  sealed_ = std::make_unique<SealedTransport>(*endpoint_, key);
  const net::ConnectionId connection = network.connect(*endpoint_, server, faults);
  net::ClientConfig own = config;
  own.rejoin_key = rejoin_key_;
  constexpr std::uint64_t k_lies_from = 100;
  lying_ = std::make_unique<LyingTransport>(*sealed_, lie, k_lies_from, input_bytes_);
  net::ClientParts parts{lying_.get(), connection, factory, this, this, nullptr};
  client_ = std::move(net::Client::create(own, std::move(parts)).client);
}

void Node::reconnect(net::SimNetwork& network, net::SimTransport& server,
                     const net::LinkFaults& faults) {
  if (!client_->reconnect(network.connect(*endpoint_, server, faults))) {
    oracle_.fail("client " + std::to_string(index_) + " cannot go on");
  }
}

void Node::kill(net::SimNetwork& network) {
  before_ = {rollbacks(), refused_packets(), resends()};
  rejoin_key_ = client_->rejoin_key();
  client_.reset();
  lying_.reset();
  network.kill(*endpoint_);
  sealed_.reset();
}

void Node::update(std::int64_t span_us) {
  clock_.advance(span_us, skew_ppm_);
  if (client_ == nullptr || paused_) return;
  client_->update(clock_.now_us());
  talk();
}

// Now and then a command, a few of them long. Where it cannot be sent, it is not.
void Node::talk() {
  constexpr std::uint64_t k_mean_ticks = 100;
  if (std::exchange(ticks_.talked, ticks_.stepped) == ticks_.stepped) return;
  std::uint64_t draw = hash64({}, seed_ * 64 + index_ + (ticks_.stepped << 20));
  if (draw % k_mean_ticks != 0) return;
  draw /= k_mean_ticks;
  std::vector<std::byte> bytes(1 + (draw % 16 == 0 ? draw % 20'000 : draw % 100));
  for (std::byte& byte : bytes)
    byte = static_cast<std::byte>(draw++);
  static_cast<void>(client_->send_command(bytes));
}

std::uint64_t Node::refused_packets() const {
  return before_.refused_packets + (sealed_ == nullptr ? 0 : sealed_->refused());
}

std::uint64_t Node::resends() const {
  return before_.resends + (client_ == nullptr ? 0 : client_->stats().resends_requested);
}

std::uint64_t Node::rollbacks() const {
  return before_.rollbacks + (client_ == nullptr ? 0 : client_->stats().rollbacks);
}

void Node::sample(std::uint64_t tick, std::span<std::byte> out) {
  toy::toy_input(seed_, index_, tick, out);
}

void Node::tick_stepped(std::uint64_t tick, std::span<const PlayerInput> inputs,
                        std::uint64_t hash) {
  ++ticks_.stepped;
  oracle_.stepped(index_, tick, inputs, hash);
  if (!oracle_.over() && tick + delay_ticks_ >= oracle_.ticks()) {
    oracle_.fail("tick " + std::to_string(tick) + ": a spectator saw it too early");
  }
}

}  // namespace lockstone::simnet
