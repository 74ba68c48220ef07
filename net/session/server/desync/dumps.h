// Snapshots that a server fetches from its players, piece by piece.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include <lockstone/net/wire.h>

#include "net/session/server/data/server_data.h"

namespace lockstone::net {

/// A canonical snapshot on its way from a player.
struct DumpTransfer {
  std::uint8_t slot = k_no_slot;  ///< who sends it; k_no_slot: the server's own
  std::vector<std::byte> bytes;   ///< grows as they come, whatever length was claimed
  std::size_t total_bytes = 0;    ///< as claimed by the first piece
  bool done = false;              ///< arrived whole, or will not come: then `bytes` is empty
  std::int64_t asked_us = -1;     ///< when it was asked for; below 0: not yet

  /// Appends a piece. False for one that does not continue the snapshot, or makes it longer than
  /// `limit_bytes`; then it had no effect.
  [[nodiscard]] bool append(const Dump& piece, std::size_t limit_bytes);

  /// It will not come.
  void give_up(std::int64_t now_us);
};

/// Asks players for snapshots, and lets no player send more than it was asked for.
class DumpRequests {
 public:
  explicit DumpRequests(ServerData& data) : data_(data) {}

  /// The greatest size of a snapshot.
  [[nodiscard]] std::size_t limit_bytes() const;

  /// Asks the player of `slot` for the state after `tick`. Done at once if nobody is there.
  void request(DumpTransfer& transfer, std::uint8_t slot, std::uint64_t tick);

  /// Counts a piece against the bytes that the player may still send; false: it exceeds them.
  [[nodiscard]] static bool admit(Seat& seat, const Dump& piece);

  /// Whether it may still come.
  [[nodiscard]] bool is_awaited(const DumpTransfer& transfer) const;

 private:
  ServerData& data_;
};

}  // namespace lockstone::net
