// Mismatches that a server has found, until the snapshots that explain them are here.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "net/session/server/data/server_data.h"
#include "net/session/server/desync/dumps.h"

namespace lockstone::net {

/// A mismatch whose snapshots are being fetched.
struct DesyncCase {
  Mismatch mismatch;
  bool ends_match = false;  ///< then no tick is confirmed any more
  std::string part;         ///< if the 128-bit hashes found it
  DumpTransfer here;        ///< from the side that is taken to be right
  DumpTransfer there;       ///< from the player that differs
};

/// Keeps the cases in the order in which they were found, and reports the first one to the observer
/// and all players. The snapshots of the first one alone are fetched on both sides.
class DesyncCases {
 public:
  DesyncCases(ServerData& data, const DumpRequests& dumps) : data_(data), dumps_(dumps) {}

  [[nodiscard]] bool empty() const { return cases_.empty(); }
  /// As many as there are players.
  [[nodiscard]] bool full() const { return cases_.size() >= data_.roster.seats().size(); }
  [[nodiscard]] DesyncCase& first() { return cases_.front(); }
  DesyncCase& add() { return cases_.emplace_back(); }

  /// Nobody can tell who is right, or the match is to end: then it stands still until it is
  /// explained.
  [[nodiscard]] bool freeze_match() const;

  /// Whether the player of `slot` has a snapshot to send for a case.
  [[nodiscard]] bool concern(std::uint8_t slot) const;

  /// The unfinished transfer of the state after `tick` from `slot`, or null.
  [[nodiscard]] DumpTransfer* transfer_of(std::uint8_t slot, std::uint64_t tick);

  /// The player of `slot` is gone: its snapshots will not come.
  void give_up_on(std::uint8_t slot);

  /// Whether the first case still waits for a snapshot.
  [[nodiscard]] bool first_waits() const;

  /// Removes and reports the first case with the snapshots that have come.
  DesyncCase report_first();
  void report_all();

 private:
  ServerData& data_;
  const DumpRequests& dumps_;
  std::vector<DesyncCase> cases_;
};

}  // namespace lockstone::net
