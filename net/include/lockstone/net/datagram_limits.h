// The traffic that a listening transport takes from each peer.
#pragma once

#include <cstdint>

namespace lockstone::net {

/// The most that one peer may send; 0: no limit. More is dropped; a peer that goes on for some
/// seconds is disconnected for flooding. Ten seconds' worth may come at once.
struct DatagramLimits {
  std::uint32_t packets_per_second = 300;
  std::uint32_t bytes_per_second = 400'000;
  std::uint32_t stranger_packets_per_second = 30;  ///< until `trust`
  std::uint32_t stranger_bytes_per_second = 20'000;

  /// For a trusted network, or a match that runs as fast as it can.
  [[nodiscard]] static DatagramLimits none() { return {0, 0, 0, 0}; }
};

}  // namespace lockstone::net
