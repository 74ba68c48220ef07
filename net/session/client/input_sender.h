// Samples this player's inputs ahead of the ticks that they are for, and sends them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>

#include "net/session/client/client_data.h"
#include "net/session/client/lead_clock.h"

namespace lockstone::net {

/// Sends inputs, the ticks received and the hashes of states together, again and again until they
/// are acknowledged.
class InputSender {
 public:
  explicit InputSender(ClientData& data) : data_(data) {}

  /// `tick` is the next one of the match.
  void restart(std::uint64_t tick) { clock_.restart(tick, data_.status.now_us); }

  /// Samples inputs for the ticks that come next.
  void sample();

  /// Sends, if there is something to say or nothing was said for long.
  void send_due();

 private:
  [[nodiscard]] std::uint64_t sample_end();
  [[nodiscard]] bool is_due() const;
  void send_inputs(std::uint64_t first_hash_tick);

  ClientData& data_;
  LeadClock clock_;
  std::int64_t last_sent_us_ = 0;
  std::array<std::byte, k_max_datagram_bytes> coded_{};
};

}  // namespace lockstone::net
