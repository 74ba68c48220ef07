// Compares the players' states with the right ones, by the hashes that they report.
//
// The hashes of every tick come first: they find the first bad tick. The 128-bit hashes of parts,
// every 64 ticks, find the differences that those miss.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <lockstone/bytes.h>

#include "net/session/server/comparison/desync_response.h"
#include "net/session/server/data/server_data.h"
#include "net/session/server/desync/desync_cases.h"

namespace lockstone::net {

/// Takes reports of hashes, and hands every mismatch to the desync response.
class StateComparison {
 public:
  StateComparison(ServerData& data, const DesyncCases& cases, DesyncResponse& response)
      : data_(data), cases_(cases), response_(response) {}

  /// A player's hashes of parts. False for a packet that breaks the format or comes out of turn.
  [[nodiscard]] bool on_parts(const Peer& peer, ByteView packet);

  /// Compares all that has been reported.
  void advance();

 private:
  void tell_agreed(const std::optional<Mismatch>& found);
  void compare_parts();
  [[nodiscard]] std::string name_of_part(std::size_t part) const;

  ServerData& data_;
  const DesyncCases& cases_;
  DesyncResponse& response_;
  std::uint64_t agreed_told_ = 0;  ///< hash_agreed was called below
};

}  // namespace lockstone::net
