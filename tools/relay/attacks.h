// What attackers do, one kind a class.
#pragma once

#include <memory>
#include <vector>

#include "tools/relay/siege.h"

namespace lockstone::relay {

class Attack {
 public:
  virtual ~Attack() = default;
  /// Called about once a millisecond.
  virtual void step(std::int64_t now_us) = 0;
  [[nodiscard]] const AttackReport& report() const { return report_; }

 protected:
  AttackReport report_;
};

/// ENet's request for a connection, with random numbers in it; the checksum, where there is room
/// for one, is left 0.
[[nodiscard]] std::vector<std::byte> connect_datagram(net::Random& random, bool with_checksum);

/// From outside: requests for connections without a checksum, with one at random, with the open
/// one; each from a socket of its own.
[[nodiscard]] std::unique_ptr<Attack> forged_connects(const TrialMatch& match, std::uint64_t seed);

/// From outside: random bytes, short, long and beyond any limit, some to connections that exist.
[[nodiscard]] std::unique_ptr<Attack> garbage(const TrialMatch& match, std::uint64_t seed);

/// From outside: datagrams of 5000 bytes, which are longer than ENet's buffer.
[[nodiscard]] std::unique_ptr<Attack> oversized(const TrialMatch& match, std::uint64_t seed);

/// From within the match's keys: a good request for a connection, recorded and sent from elsewhere.
[[nodiscard]] std::unique_ptr<Attack> repeated_connects(const TrialMatch& match,
                                                        std::uint64_t seed);

/// From within: tokens that are altered, expired, of another key, and good ones without their keys.
[[nodiscard]] std::unique_ptr<Attack> bad_tokens(const TrialMatch& match, std::uint64_t seed);

/// From within: a player who sends much more than its session does.
[[nodiscard]] std::unique_ptr<Attack> flood(TrialMatch& match, unsigned slot, unsigned per_second);

}  // namespace lockstone::relay
