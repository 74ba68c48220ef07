// Finds the first tick at which states differ, from the hashes that the players report.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <lockstone/net/session.h>

#include "net/session/tick_ring.h"

namespace lockstone::net {

/// A difference found. `reference` speaks for the right side: a slot, or k_no_slot for the server.
struct Mismatch {
  std::uint64_t tick = 0;
  std::uint8_t slot = 0;
  std::uint8_t reference = k_no_slot;
  Verdict verdict = Verdict::undecided;
  std::uint64_t hash_here = 0;
  std::uint64_t hash_there = 0;
};

/// The right hash of each recent tick: the server's own, or in a relay the one that most players
/// had.
class RightHashes {
 public:
  explicit RightHashes(std::size_t history_ticks)
      : history_ticks_(history_ticks), hashes_(history_ticks) {}

  void push(std::uint64_t hash) { hashes_.push(hash); }

  /// The match continues after `ticks` of them, above 0; the last hash is known.
  void begin_after(std::uint64_t ticks, std::uint64_t hash) {
    hashes_.restart(ticks - 1);
    hashes_.push(hash);
    first_ = ticks - 1;
  }

  /// Of a tick that is known.
  [[nodiscard]] std::uint64_t at(std::uint64_t tick) const { return hashes_.at(tick); }
  /// No tick from here on is known.
  [[nodiscard]] std::uint64_t end() const { return hashes_.next_tick(); }
  [[nodiscard]] bool knows(std::uint64_t tick) const {
    return tick >= first_ && tick < end() && end() - tick <= history_ticks_;
  }

 private:
  std::size_t history_ticks_;
  HashRing hashes_;
  std::uint64_t first_ = 0;
};

/// One player's reports.
struct PlayerHashes {
  HashRing reported;
  std::uint64_t first = 0;   ///< reports began here
  std::uint64_t judged = 0;  ///< next tick to compare
  std::uint64_t compared = 0;
  std::uint64_t equal = 0;
  bool present = false;  ///< is waited for
  bool ignored = false;  ///< was found different: its later hashes prove nothing

  /// It has a say about the tick.
  [[nodiscard]] bool counts_at(std::uint64_t tick) const {
    return !ignored && first <= tick && reported.next_tick() > tick;
  }
};

/// Every player's hashes are taken in tick order without gaps, and each is compared before the
/// next: so the first mismatch found for a player is at the first tick that differs.
class HashJudge {
 public:
  /// With `has_own`, the server's own hashes decide; else the majority of the players does.
  HashJudge(std::size_t player_count, std::size_t history_ticks, bool has_own);

  void push_own(std::uint64_t hash) { right_.push(hash); }

  /// Before anything else: the match goes on after `ticks` of them, above 0; the last hash is
  /// known.
  void begin_after(std::uint64_t ticks, std::uint64_t hash) { right_.begin_after(ticks, hash); }

  /// Whether `slot` may report one more: false: it would overwrite hashes that are not yet
  /// compared.
  [[nodiscard]] bool can_push(std::size_t slot) const;
  void push(std::size_t slot, std::uint64_t hash);

  /// The next tick whose hash is wanted of `slot`.
  [[nodiscard]] std::uint64_t wanted(std::size_t slot) const {
    return players_[slot].reported.next_tick();
  }

  /// `slot` reports again, from `tick` on, whatever it reported before. Nobody waits for it yet.
  void restart(std::size_t slot, std::uint64_t tick);

  /// Players that do not report any more are not waited for.
  void set_present(std::size_t slot, bool present) { players_[slot].present = present; }

  /// `slot` was found different by other means.
  void ignore(std::size_t slot) { players_[slot].ignored = true; }

  /// Compares until a mismatch is found or reports are missing. A player found different is left
  /// out of all further comparison.
  [[nodiscard]] std::optional<Mismatch> advance();

  /// Ticks below were compared for every present player.
  [[nodiscard]] std::uint64_t judged_ticks() const;

  /// The reports of a player, and how far they were compared.
  [[nodiscard]] const PlayerHashes& player(std::size_t slot) const { return players_[slot]; }
  [[nodiscard]] const RightHashes& right() const { return right_; }

 private:
  std::optional<Mismatch> compare_with_right(std::uint8_t slot);
  std::optional<Mismatch> compare_players();
  void compare_tick(std::uint64_t tick);

  bool has_own_;
  std::size_t history_ticks_;
  RightHashes right_;
  std::vector<PlayerHashes> players_;
  std::uint64_t shared_judged_ = 0;  ///< next tick to compare among players
  std::vector<Mismatch> pending_;    ///< found, not yet answered; at most one a player
};

}  // namespace lockstone::net
