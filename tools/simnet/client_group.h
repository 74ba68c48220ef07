// The clients of a simulated match: when each starts, loses its connection, dies and comes back.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <lockstone/net/client.h>
#include <lockstone/net/transport_sim.h>

#include "tools/simnet/fault_plan.h"
#include "tools/simnet/match.h"
#include "tools/simnet/node.h"
#include "tools/simnet/oracle.h"

namespace lockstone::simnet {

/// A handshake may take this long, however bad the network is.
inline constexpr std::int64_t k_patience_us = 30'000'000;

/// The surroundings of the clients.
struct ClientWorld {
  const Game& game;
  const MatchSetup& setup;
  const MatchMode& mode;
  net::SimNetwork& network;
  net::SimTransport& server;  ///< the server's end
  const FaultPlan& faults;
  Oracle& oracle;
};

/// Players first, then spectators. Some players come when the match runs already.
class ClientGroup {
 public:
  ClientGroup(const ClientWorld& world, std::uint64_t key, std::uint8_t input_bytes);

  [[nodiscard]] std::vector<Node>& nodes() { return nodes_; }
  [[nodiscard]] const std::vector<Node>& nodes() const { return nodes_; }
  /// Whether the client lies about its states.
  [[nodiscard]] bool is_liar(std::size_t index) const {
    return world_.setup.lie != Lie::none && index + 1 == world_.setup.clients;
  }
  /// The server's id of a client's connection.
  [[nodiscard]] net::ConnectionId connection(std::size_t index) const {
    return connections_[index];
  }
  [[nodiscard]] std::int64_t connected_us(std::size_t index) const { return connected_us_[index]; }

  void set_time(std::int64_t now_us) { now_us_ = now_us; }

  /// Starts late clients, and connects those again that have lost their connection.
  void advance();

  /// Carries out a fault of a client's machine that begins or ends.
  void change_fault(const FaultEvent& event, bool active);

  /// Brings the faults of all connections up to date.
  void refresh_faults();

  [[nodiscard]] std::uint64_t kills() const { return kills_; }

 private:
  void start(std::size_t index);
  void start_spectator(std::size_t index);
  void start_late();
  void revive();
  void note_connection(std::size_t index);
  void cut(Node& node, const FaultEvent& event, net::Cut way);
  void change_life(std::size_t client, bool dies);
  [[nodiscard]] bool must_ask_again(std::size_t index) const;
  [[nodiscard]] net::ClientConfig config_of(std::size_t index) const;

  ClientWorld world_;
  std::uint64_t key_;
  std::vector<Node> nodes_;
  std::vector<net::ConnectionId> connections_;
  std::vector<std::int64_t> connected_us_;  ///< when last
  net::ConnectionId connections_made_ = 0;
  std::int64_t now_us_ = 0;
  std::uint64_t kills_ = 0;
};

}  // namespace lockstone::simnet
