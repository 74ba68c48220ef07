// An attacked match: real sockets, honest players, and attackers from outside and from within.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tools/relay/trial_match.h"

namespace lockstone::relay {

struct SiegeOptions {
  std::uint64_t seed = 1;
  std::int64_t duration_us = 10'000'000;  ///< at least; up to 20 s more …
  std::uint64_t least_sent = 4;  ///< … until every attacker has done so much, and the flood is over
  unsigned honest = 3;           ///< players; one more holds a good token and attacks from within
  net::DatagramLimits limits = {};
  unsigned flood_per_second = 600;  ///< packets of the attacker from within, beside its session's
};

/// One kind of attack: what was sent, and what came back.
struct AttackReport {
  std::string name;
  std::uint64_t sent = 0;      ///< datagrams, or connections tried
  std::uint64_t answered = 0;  ///< datagrams received for them
  std::uint64_t admitted = 0;  ///< connections that the server took for players
};

struct SiegeReport {
  std::vector<AttackReport> attacks;
  std::vector<PlayerOutcome> honest;
  PlayerOutcome traitor;
  bool traitor_dropped = false;
  std::uint64_t ticks = 0;
  std::int64_t longest_server_gap_us = 0;
  net::EnetCounters socket;
  net::SecurityCounters security;

  /// True if nobody was let in, nothing was answered to strangers, the traitor was dropped, and
  /// every honest player was admitted, stayed with the server's hashes in each tick, and had no
  /// input replaced.
  [[nodiscard]] bool withstood() const;
};

/// Plays and attacks for the duration. Nothing when the system refuses sockets or there is no
/// libsodium.
[[nodiscard]] std::optional<SiegeReport> run_siege(const SiegeOptions& options);

}  // namespace lockstone::relay
