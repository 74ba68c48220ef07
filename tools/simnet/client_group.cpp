#include "tools/simnet/client_group.h"

#include <fmt/format.h>

namespace lockstone::simnet {

ClientGroup::ClientGroup(const ClientWorld& world, std::uint64_t key, std::uint8_t input_bytes)
    : world_(world),
      key_(key),
      connections_(world.setup.clients + world.mode.spectators),
      connected_us_(connections_.size()) {
  const std::size_t players = world.setup.clients;
  nodes_.reserve(connections_.size());
  for (std::size_t i = 0; i < connections_.size(); ++i) {
    nodes_.emplace_back(i, world.setup.seed, input_bytes, world.oracle);
    if (i >= players) start_spectator(i);
    if (i < players - world.mode.late_clients) start(i);
  }
}

void ClientGroup::start(std::size_t index) {
  const MatchSetup& setup = world_.setup;
  const bool faulty = setup.control && setup.control->client == index;
  nodes_[index].start(world_.network, world_.server, key_, world_.faults.faults_of(index),
                      config_of(index), faulty ? world_.game.faulty_factory : world_.game.factory,
                      is_liar(index) ? setup.lie : Lie::none);
  note_connection(index);
}

void ClientGroup::note_connection(std::size_t index) {
  connections_[index] = ++connections_made_;
  connected_us_[index] = now_us_;
}

net::ClientConfig ClientGroup::config_of(std::size_t index) const {
  net::ClientConfig config;
  config.insecure = true;
  config.wanted_slot = static_cast<std::uint8_t>(index);
  config.timeouts.handshake_us = k_patience_us;
  if (index % 2 == 0) {
    config.prediction_ticks = world_.mode.prediction_ticks;
    config.sync_test = world_.mode.sync_test;
  }
  return config;
}

void ClientGroup::start_spectator(std::size_t index) {
  net::ClientConfig config = config_of(index);
  config.wanted_slot = net::k_spectator_slot;
  nodes_[index].watch_only(world_.mode.spectator_delay_ticks);
  nodes_[index].start(world_.network, world_.server, key_, world_.faults.faults_of(index), config,
                      world_.game.factory);
  note_connection(index);
}

void ClientGroup::advance() {
  start_late();
  revive();
}

// Clients that come when the match runs already.
void ClientGroup::start_late() {
  const MatchMode& mode = world_.mode;
  if (!world_.faults.has_begun() || now_us_ < world_.faults.time_us(mode.late_ms)) return;
  for (std::size_t i = world_.setup.clients - mode.late_clients; i < world_.setup.clients; ++i) {
    const bool dead = world_.faults.dead_until_us(i) > now_us_;
    if (!nodes_[i].alive() && !dead && !world_.oracle.over()) start(i);
  }
}

// A client that died before it heard of its key finds its seat taken, until the server misses it.
bool ClientGroup::must_ask_again(std::size_t index) const {
  constexpr std::int64_t k_pause_us = 1'000'000;
  const net::Client& client = nodes_[index].client();
  return client.state() == net::ClientState::refused && index < world_.setup.clients &&
         !world_.oracle.over() && client.refusal().reason == net::RefuseReason::slot_taken &&
         now_us_ - connected_us_[index] > k_pause_us;
}

// A client that has lost its connection asks for a new one.
void ClientGroup::revive() {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    Node& node = nodes_[i];
    const bool sent_away = is_liar(i) && node.alive() && !node.client().may_reconnect();
    if (!node.alive() || sent_away) continue;
    if (must_ask_again(i)) {
      node.kill(world_.network);
      start(i);
    }
    if (node.client().state() != net::ClientState::failed) continue;
    if (node.client().failure() == net::ClientFailure::not_deterministic) {
      return world_.oracle.fail(fmt::format("client {} is not deterministic", i));
    }
    if (world_.oracle.over()) continue;
    node.reconnect(world_.network, world_.server, world_.faults.faults_of(i));
    note_connection(i);
  }
}

void ClientGroup::refresh_faults() {
  for (std::size_t i = 0; i < nodes_.size(); ++i) {
    if (!nodes_[i].alive()) continue;
    world_.network.set_faults(nodes_[i].endpoint(), world_.faults.faults_of(i));
  }
}

void ClientGroup::change_fault(const FaultEvent& event, bool active) {
  if (event.client >= nodes_.size()) return;
  Node& node = nodes_[event.client];
  switch (event.kind) {
    case FaultKind::cut:
      if (active) cut(node, event, net::Cut::both);
      break;
    case FaultKind::cut_sending:
      if (active) cut(node, event, net::Cut::sending);
      break;
    case FaultKind::cut_hearing:
      if (active) cut(node, event, net::Cut::receiving);
      break;
    case FaultKind::pause:
      node.set_paused(active);
      break;
    case FaultKind::kill:
      change_life(event.client, active);
      break;
    case FaultKind::skew:
      node.set_skew(active ? std::int64_t{event.amount} - 500 : 0);
      break;
    default:
      break;
  }
}

void ClientGroup::cut(Node& node, const FaultEvent& event, net::Cut way) {
  const std::int64_t until_us = world_.faults.time_us(event.until_ms);
  if (node.alive()) world_.network.partition(node.endpoint(), now_us_, until_us, way);
}

void ClientGroup::change_life(std::size_t client, bool dies) {
  Node& node = nodes_[client];
  if (dies && node.alive()) {
    node.kill(world_.network);
    ++kills_;
  }
  if (!dies && !node.alive() && !world_.oracle.over()) start(client);
}

}  // namespace lockstone::simnet
