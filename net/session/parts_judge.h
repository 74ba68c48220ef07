// The second check of states: 128 bits for each part, every 64 ticks.
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <lockstone/net/session.h>
#include <lockstone/net/wire.h>

namespace lockstone::net {

/// Of the state at hand; without parts where a simulation has none.
[[nodiscard]] Parts parts_of(const Simulation& simulation);

/// A part whose hashes differ. `reference` is a slot, or k_no_slot for the server.
struct PartMismatch {
  std::uint64_t ticks = 0;  ///< the state after so many ticks
  std::uint8_t slot = 0;
  std::uint8_t reference = k_no_slot;
  std::size_t part = 0;
  Hash128 here;
  Hash128 there;
};

/// Compares what players report with the server's own, or, where it has none, with what the first
/// of them reported. The 64-bit hashes of every tick come first: this finds what they are blind to.
class PartsJudge {
 public:
  /// The server's own parts, before any player's of the same ticks.
  void note_own(const Parts& parts);

  /// A player's. True if they were compared, and are equal. With `has_own` the server's decide.
  bool compare(std::uint8_t slot, const Parts& parts, bool has_own);

  /// The first difference found, until it is forgotten.
  [[nodiscard]] const std::optional<PartMismatch>& found() const { return found_; }
  void forget() { found_.reset(); }

 private:
  struct Entry {
    Parts parts;
    std::uint8_t slot = k_no_slot;
  };
  [[nodiscard]] Entry& entry_of(std::uint64_t ticks) {
    return entries_[static_cast<std::size_t>(ticks / k_parts_interval_ticks % entries_.size())];
  }

  std::array<Entry, 64> entries_{};
  std::optional<PartMismatch> found_;
};

}  // namespace lockstone::net
