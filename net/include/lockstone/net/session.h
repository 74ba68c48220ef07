// Types that server and client share.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>

#include <lockstone/bytes.h>
#include <lockstone/net/reasons.h>
#include <lockstone/net/slot_mask.h>
#include <lockstone/simulation.h>

namespace lockstone::net {

inline constexpr std::uint8_t k_no_slot = 255;

/// Spans of time, in microseconds; all above 0.
struct Timeouts {
  std::int64_t handshake_us = 5'000'000;      ///< from connecting to being seated
  std::int64_t silence_warning_us = 750'000;  ///< then the observer hears of it
  std::int64_t drop_us = 5'000'000;           ///< then the peer is gone
  std::int64_t dump_us = 3'000'000;           ///< for the snapshots after a desync
  std::int64_t finish_us = 3'000'000;         ///< for the last hashes, and again for the good-byes
  std::int64_t rejoin_us = 30'000'000;        ///< so long a lost player's seat is kept
};

/// Why a session could not be made. A programmer's or operator's error, not a peer's.
enum class SetupError : std::uint8_t {
  none = 0,
  insecure_not_requested,  ///< the transport does not encrypt: set `insecure` to say that you know
  insecure_on_secure_transport,  ///< it does encrypt, and every client of it expects that
  match_config_too_long,
  player_count_out_of_range,
  input_bytes_out_of_range,  ///< also: above k_max_tick_input_bytes for all players together
  tick_rate_out_of_range,    ///< 1 … 1000
  input_delay_out_of_range,
  history_out_of_range,
  timeouts_out_of_range,
  simulation_already_stepped,  ///< and no resume_mask, or the other way round
  prediction_out_of_range,     ///< rollback beyond 15 ticks, or its delay beyond 60
  spectators_out_of_range,     ///< too many, or the history is shorter than their delay and queue
};
[[nodiscard]] std::string_view to_string(SetupError error);

/// A number of ticks kept for peers that lag: power of two.
inline constexpr std::uint32_t k_min_history_ticks = 256;
inline constexpr std::uint32_t k_max_history_ticks = 1 << 16;
inline constexpr std::uint32_t k_max_snapshot_ticks = 1 << 12;

inline constexpr std::uint8_t k_max_prediction_ticks = 15;

/// How far beyond the confirmed ticks a server takes inputs.
inline constexpr std::uint32_t k_input_window_ticks = 128;

/// A refusal, with both values of the field that differs.
struct Refusal {
  RefuseReason reason = RefuseReason::none;
  RefuseField field = RefuseField::none;
  std::uint64_t here = 0;   ///< the server's value
  std::uint64_t there = 0;  ///< the client's value

  /// `refused: simulation mismatch, config_hash: 0x… here, 0x… there`.
  [[nodiscard]] std::string to_line() const;
};

/// Two states of one tick that should have been equal.
struct DesyncReport {
  std::uint64_t tick = 0;  ///< the first tick after whose step the states differed
  std::uint8_t slot = 0;   ///< the player whose state is not the reference's
  Verdict verdict = Verdict::undecided;
  std::uint64_t hash_here = 0;  ///< the server's, or of the player that speaks for the others
  std::uint64_t hash_there = 0;
  std::string name;  ///< of that player; empty where it gave none
  std::string part;  ///< of the state, where only its 128 bits showed that they differ; else empty
  StateDifference difference;  ///< `differs` is false if a dump or a describing simulation lacked
  ByteView dump_here;  ///< canonical snapshots, valid during the callback; empty when not had
  ByteView dump_there;
  std::string build_here;  ///< from the player's Hello; the server's own: empty
  std::string build_there;

  /// `tick 1842, player 2 "Ann", body 17 "crate", velocity.y: 0x… here, 0x… there`; with the
  /// hashes instead of a field where the difference is not known.
  [[nodiscard]] std::string to_line() const;
};

/// Counters of one player, since it was seated.
struct PlayerStats {
  std::uint64_t bytes_sent = 0;  ///< by the server, payload
  std::uint64_t bytes_received = 0;
  std::uint64_t packets_sent = 0;
  std::uint64_t packets_received = 0;
  std::int64_t round_trip_us = -1;       ///< -1: the transport does not know
  std::uint64_t late_inputs = 0;         ///< came after their tick was confirmed
  std::uint64_t substituted_inputs = 0;  ///< ticks confirmed without this player's input
  std::uint64_t hashes_compared = 0;
  std::uint64_t hashes_equal = 0;
  std::uint64_t parts_equal = 0;  ///< checks of 128 bits a part, every 64 ticks
  std::uint64_t malformed_packets = 0;
  std::int32_t margin_quarters = 0;  ///< how early the newest inputs came, quarter ticks
  std::uint64_t entries = 0;         ///< how often it came into the running match
  std::uint64_t commands_taken = 0;
  std::uint64_t commands_refused = 0;  ///< too many, or too long
  std::uint64_t resends = 0;           ///< requests for ticks that lacked between others
};

/// Traffic and progress of a client.
struct ClientStats {
  std::uint64_t bytes_sent = 0;
  std::uint64_t bytes_received = 0;
  std::uint64_t packets_sent = 0;
  std::uint64_t packets_received = 0;
  std::int64_t round_trip_us = -1;
  std::uint64_t substituted_inputs = 0;  ///< own inputs that the server replaced
  std::uint64_t resends_requested = 0;
  std::uint64_t malformed_packets = 0;
  std::int32_t margin_quarters = 0;  ///< the server's last word on it, quarter ticks
  std::uint32_t lead_ticks = 0;      ///< inputs are sent that much earlier than at first
  std::int32_t rate_trim_ppm = 0;    ///< of the local clock
  std::int64_t jitter_us = 0;        ///< of arriving ticks: the 99th percentile
  std::uint64_t rollbacks = 0;
  std::uint64_t ticks_stepped_again = 0;
  /// In these ticks: as the simulation counts them (Simulation::island_work).
  std::uint64_t islands_computed_again = 0;
  std::uint64_t islands_recalled = 0;
  std::uint64_t states_loaded = 0;  ///< from the server
};

}  // namespace lockstone::net
