// The kinds of attack, one a class.
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

/// From within: datagrams for which ENet walks through a list. Packets wait behind a gap, then the
/// lowest of them comes again, 32 times a datagram, 48 kB/s. By a player with a token of its own,
/// or by `strangers` connections, each from its own address, before they have shown a token.
[[nodiscard]] std::unique_ptr<Attack> walk_of_a_player(const TrialMatch& match);
[[nodiscard]] std::unique_ptr<Attack> walk_of_strangers(const TrialMatch& match,
                                                        std::size_t strangers);

/// From within: one address asks for connection after connection and says nothing.
[[nodiscard]] std::unique_ptr<Attack> shut_door(const TrialMatch& match, std::size_t connections);

/// From within: one good token, from eight addresses, again and again. Every second handshake stops
/// half-way.
[[nodiscard]] std::unique_ptr<Attack> reconnect_storm(const TrialMatch& match);
inline constexpr std::uint64_t k_storming_player = 91;

/// Honest people who come to watch, each from an address of its own, and leave once seated.
class Visitors {
 public:
  /// They come one after the other, spread over `span_us`.
  Visitors(const TrialMatch& match, unsigned count, std::int64_t span_us);
  ~Visitors();
  void step(std::int64_t now_us);
  [[nodiscard]] bool over() const;
  [[nodiscard]] unsigned seated() const;

 private:
  struct One;
  const TrialMatch& match_;
  std::int64_t span_us_;
  std::vector<std::unique_ptr<One>> visitors_;
};

}  // namespace lockstone::relay
