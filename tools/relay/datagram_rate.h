// How many of an attacker's datagrams a server gets through in a second of processor time.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace lockstone::relay {

struct DatagramRate {
  std::string name;
  std::uint64_t datagrams = 0;   ///< that the server has taken from its socket
  std::uint64_t kept_out = 0;    ///< of these, dropped before ENet
  std::uint64_t per_second = 0;  ///< of processor time, receiving and answering included
};

/// One server, one attacker after another, each with `datagrams` of its kind: forged, garbage,
/// oversized from outside; and from a peer of the match, 3 kB of commands without data, and the
/// lowest of the packets, and of the fragments, that wait behind a gap, again and again. Limits are
/// off. Nothing: no socket, or no libsodium.
[[nodiscard]] std::optional<std::vector<DatagramRate>> measure_rates(std::uint64_t datagrams);

}  // namespace lockstone::relay
