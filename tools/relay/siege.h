// An attacked match: real sockets, honest players, and attackers from outside and from within.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/relay/trial_match.h"

namespace lockstone::relay {

/// Seats of the attackers from within: a flooding player and a lying one.
inline constexpr unsigned k_siege_attackers = 2;

struct SiegeOptions {
  const GameDef* game = nullptr;  ///< configures matches
  std::uint64_t seed = 1;
  std::int64_t duration_us = 10'000'000;  ///< at least …
  std::int64_t patience_us = 20'000'000;  ///< … and at most so much more, until
  std::uint64_t least_sent = 4;  ///< every attacker has done so much and those within are found
  unsigned honest = 3;           ///< players, beside k_siege_attackers
  net::DatagramLimits limits = {};
  unsigned flood_per_second = 600;  ///< packets of the attacker from within, beside its session's
  unsigned walkers = 14;            ///< connections that walk before they show a token
  unsigned visitors = 25;           ///< honest ones who come to watch while the door is attacked
  std::uint8_t input_delay = 4;
  std::size_t max_connections = 64;  ///< of the server
  std::size_t strangers_per_address = net::EnetOptions{}.max_strangers_per_address;
};

/// One kind of attack: counts of the packets sent and of the answers.
struct AttackReport {
  std::string name;
  std::uint64_t sent = 0;      ///< datagrams, or connections tried
  std::uint64_t answered = 0;  ///< datagrams received for them
  std::uint64_t admitted = 0;  ///< connections that the server took for players
  std::uint64_t entitled = 0;  ///< of these, as many as the rules give the attacker's own token
};

struct SiegeReport {
  std::vector<AttackReport> attacks;
  std::vector<PlayerOutcome> honest;
  PlayerOutcome traitor;
  bool traitor_dropped = false;
  bool liar_expelled = false;
  unsigned visitors = 0;         ///< who came
  unsigned visitors_seated = 0;  ///< who were let in
  unsigned server_stalls = 0;    ///< see TrialMatch::server_stalls
  std::int64_t server_busy_us = 0;
  std::int64_t duration_us = 0;
  std::uint64_t ticks = 0;
  std::int64_t longest_server_gap_us = 0;
  net::EnetCounters socket;
  net::SecurityCounters security;

  /// True if nobody was let in beyond the rules, nothing was answered to strangers, the flooding
  /// player was dropped and the lying one expelled, the server never stalled, every visitor was
  /// seated, and every honest player was admitted, stayed with the server's hashes in each tick,
  /// and had no input replaced.
  [[nodiscard]] bool withstood() const;
};

/// Plays and attacks for the duration. Nothing when the system refuses sockets, the game refuses
/// such a match, or there is no libsodium.
[[nodiscard]] std::optional<SiegeReport> run_siege(const SiegeOptions& options);

}  // namespace lockstone::relay
