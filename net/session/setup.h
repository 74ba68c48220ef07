// The checks of a configuration that server and client share.
#pragma once

#include <lockstone/net/session.h>
#include <lockstone/net/transport.h>
#include <lockstone/net/wire.h>

namespace lockstone::net {

/// A session without encryption is asked for by name, and only then.
[[nodiscard]] inline SetupError check_security(bool insecure, const Transport& transport) {
  if (insecure == transport.secure()) {
    return insecure ? SetupError::insecure_on_secure_transport : SetupError::insecure_not_requested;
  }
  return SetupError::none;
}

[[nodiscard]] inline SetupError check_info(const SimulationInfo& info) {
  if (info.player_count < 1 || info.player_count > k_max_players) {
    return SetupError::player_count_out_of_range;
  }
  if (info.input_bytes < 1 || info.input_bytes > k_max_input_bytes) {
    return SetupError::input_bytes_out_of_range;
  }
  const std::size_t tick_input_bytes = std::size_t{info.player_count} * info.input_bytes;
  if (tick_input_bytes > k_max_tick_input_bytes) return SetupError::input_bytes_out_of_range;
  const bool rate_fits = info.tick_rate >= 1 && info.tick_rate <= 1000;
  return rate_fits ? SetupError::none : SetupError::tick_rate_out_of_range;
}

[[nodiscard]] inline SetupError check_common(std::uint32_t history_ticks,
                                             std::uint32_t snapshot_ticks,
                                             const Timeouts& timeouts) {
  const bool power_of_two = (history_ticks & (history_ticks - 1)) == 0;
  if (!power_of_two || history_ticks < k_min_history_ticks || history_ticks > k_max_history_ticks ||
      snapshot_ticks > k_max_snapshot_ticks) {
    return SetupError::history_out_of_range;
  }
  for (std::int64_t span_us : {timeouts.handshake_us, timeouts.silence_warning_us, timeouts.drop_us,
                               timeouts.dump_us, timeouts.finish_us, timeouts.rejoin_us}) {
    if (span_us <= 0) return SetupError::timeouts_out_of_range;
  }
  return SetupError::none;
}

}  // namespace lockstone::net
