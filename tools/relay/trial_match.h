// A real match over UDP in one process and one thread: a server and bots, with tokens, perhaps
// behind a bad network. It measures how much the players notice.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include <lockstone/net/client.h>
#include <lockstone/net/server.h>
#include <lockstone/net/transport_enet.h>
#include <lockstone/net/transport_secure.h>
#include <lockstone/tool.h>

#include "tools/relay/lossy_relay.h"
#include "tools/relay/stall_watch.h"

namespace lockstone::relay {

struct TrialOptions {
  const GameDef* game = nullptr;  ///< configures matches
  unsigned players = 4;
  std::uint64_t ticks = 0;  ///< 0: until `stop`
  std::uint64_t seed = 1;
  std::uint16_t bodies = 20;
  std::uint8_t input_delay = 4;
  net::DatagramLimits limits = {};
  std::optional<Faults> faults = std::nullopt;  ///< between every player and the server
  std::size_t max_connections = 32;             ///< of the server
  std::size_t strangers_per_address = net::EnetOptions{}.max_strangers_per_address;
  std::uint16_t spectators = 0;
  std::optional<unsigned> liar = std::nullopt;  ///< slot of a player who reports wrong hashes
};

/// The effects that one player noticed.
struct PlayerOutcome {
  std::uint64_t ticks = 0;
  std::uint64_t substituted = 0;  ///< own inputs that came too late
  std::int64_t stalled_us = 0;    ///< beyond one tick, of all pauses above k_stall_us
  std::int64_t longest_us = 0;    ///< between two ticks
  bool equal = false;             ///< had the server's hash in each of its ticks
  net::ClientState state = net::ClientState::connecting;
  net::ClientFailure failure = net::ClientFailure::none;
  net::LeaveReason leave_reason = net::LeaveReason::left;
};

class TrialMatch {
 public:
  /// Null when the system refuses a socket, or the game such a match.
  [[nodiscard]] static std::unique_ptr<TrialMatch> create(const TrialOptions& options);
  ~TrialMatch();

  /// Does the work that is due. False once the match is over for everybody.
  [[nodiscard]] bool update(std::int64_t now_us);
  void stop();

  /// A paused player does nothing at all, like a stopped process.
  void pause(unsigned slot, bool paused);

  [[nodiscard]] PlayerOutcome outcome(unsigned slot) const;
  [[nodiscard]] std::uint64_t ticks_confirmed() const;
  [[nodiscard]] const SimulationFactory& factory() const;  ///< of the game that is played
  [[nodiscard]] net::SlotMask present_mask() const;
  [[nodiscard]] std::int64_t longest_server_gap_us() const;  ///< between two confirmed ticks
  /// How often the server was busy for more than k_stall_us at a stretch: its own processor time.
  [[nodiscard]] unsigned server_stalls() const;
  [[nodiscard]] std::int64_t server_busy_us() const;  ///< its processor time, all together
  [[nodiscard]] const net::ServerCounters& server_counters() const;
  /// Connections that the server's session was told of for this player of a token.
  [[nodiscard]] unsigned entries_of(std::uint64_t player) const;

  /// Of the server's socket, which attackers call.
  [[nodiscard]] std::uint16_t port() const;
  [[nodiscard]] const net::EnetCounters& socket_counters() const;
  [[nodiscard]] const net::SecurityCounters& security_counters() const;
  [[nodiscard]] const LossyRelay* relay() const;

  /// For attackers from within: a token of their own, as the backend would issue it.
  [[nodiscard]] net::ConnectToken token_for(std::uint64_t player, std::uint8_t slot,
                                            std::uint64_t expires_unix_s) const;
  [[nodiscard]] static std::uint64_t unix_s_at_zero();
  /// The transport of a player, for packets that its session would never send.
  [[nodiscard]] net::Transport& transport_of(unsigned slot);
  [[nodiscard]] net::ConnectionId connection_of(unsigned slot) const;

 private:
  struct Impl;
  explicit TrialMatch(std::unique_ptr<Impl> impl);
  std::unique_ptr<Impl> impl_;
};

}  // namespace lockstone::relay
