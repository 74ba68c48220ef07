// The second check of states: 128 bits for each part, every 64 ticks.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <vector>

#include <lockstone/net/session.h>
#include <lockstone/net/wire.h>

namespace lockstone::net {

/// Of the state at hand; without parts where a simulation has none.
[[nodiscard]] Parts parts_of(const Simulation& simulation);

/// A part whose hashes differ. `reference` is a slot, or k_no_slot for the server.
struct PartMismatch {
  std::uint64_t ticks = 0;  ///< the state after this many ticks
  std::uint8_t slot = 0;
  std::uint8_t reference = k_no_slot;
  Verdict verdict = Verdict::undecided;
  std::size_t part = 0;
  Hash128 here;
  Hash128 there;
};

/// Compares the players' parts with the server's own, or, where it has none, lets the majority of
/// the players decide. The 64-bit hashes of every tick come first: this finds differences that they
/// miss. Allocates when made only.
class PartsJudge {
 public:
  explicit PartsJudge(bool has_own);

  /// The server's own parts, before any player's of the same ticks.
  void note_own(const Parts& parts);

  /// A player's. The first for its ticks counts.
  void take(std::uint8_t slot, const Parts& parts);

  /// Without own parts: decides the checks that all of `voters` have reported, and, after
  /// `confirmed` ticks, the checks that are so old that nobody is waited for any more. Bit n of
  /// `voters`: slot n.
  void vote(SlotMask voters, std::uint64_t confirmed);

  /// The first difference found in a player, until it is forgotten.
  [[nodiscard]] const std::optional<PartMismatch>& found(std::size_t slot) const {
    return found_[slot];
  }
  void forget(std::size_t slot) { found_[slot].reset(); }

  /// How many checks of a player gave no difference.
  [[nodiscard]] std::uint64_t equal(std::size_t slot) const { return equal_[slot]; }

 private:
  /// The reports for one number of ticks.
  struct Check {
    std::uint64_t ticks = 0;
    SlotMask reported = 0;  ///< bit n: slot n
    bool decided = false;
    std::array<Parts, k_max_players> parts{};
  };
  void compare(std::uint8_t slot, const Parts& theirs, std::uint8_t reference, const Parts& right,
               Verdict verdict);
  void decide(Check& check, SlotMask voters);
  [[nodiscard]] static unsigned votes_for(const Check& check, SlotMask members,
                                          std::uint8_t slot);

  bool has_own_;
  std::array<Parts, 64> own_{};
  std::vector<Check> checks_;  ///< without own parts: the last eight
  std::array<std::optional<PartMismatch>, k_max_players> found_;
  std::array<std::uint64_t, k_max_players> equal_{};
};

}  // namespace lockstone::net
