// The enumerations of a session. The values are on the wire: never renumber, only append.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string_view>

namespace lockstone::net {

/// The first ticks of a match have neutral inputs: as many as this at most.
inline constexpr std::uint8_t k_max_input_delay_ticks = 60;

enum class LatePolicy : std::uint8_t {
  deadline = 0,  ///< a late input is replaced, and flagged in the tick
  strict = 1,    ///< the match waits, up to the drop time-out
};

enum class Pacing : std::uint8_t {
  real_time = 0,  ///< tick T is confirmed 1/tick_rate after tick T-1
  fast = 1,       ///< a tick is confirmed once every present player's input is there; always waits
};

enum class RefuseReason : std::uint8_t {
  none = 0,
  protocol_mismatch = 1,
  insecure_not_allowed = 2,  ///< one side asks for a session without encryption, the other not
  simulation_mismatch = 3,   ///< `field` names the difference
  match_full = 4,
  slot_taken = 5,
  match_running = 6,
  handshake_timeout = 7,
  token_refused = 8,    ///< it is altered, or sealed under another key
  token_expired = 9,    ///< or the clocks differ
  wrong_match = 10,     ///< the token is for another match
  wrong_server = 11,    ///< the token is for other servers
  wrong_slot = 12,      ///< the token is for another seat
  replaced = 13,        ///< the same player connected again
  flooding = 14,        ///< far more packets than a session sends
  stream_damaged = 15,  ///< a reliable packet was not authentic
  expelled = 16,        ///< was sent away from this match, for good
};

inline constexpr RefuseReason k_last_refuse_reason = RefuseReason::expelled;
inline constexpr std::size_t k_refuse_reasons = static_cast<std::size_t>(k_last_refuse_reason) + 1;

/// The field that differed between server and client.
enum class RefuseField : std::uint8_t {
  none = 0,
  protocol = 1,
  insecure = 2,
  abi = 3,
  config_hash = 4,
  scene_hash = 5,
  canary = 6,
  tick_rate = 7,
  player_count = 8,
  input_bytes = 9,
  slot = 10,
};

enum class Verdict : std::uint8_t {
  client_diverged = 0,  ///< the server's own simulation says so
  minority = 1,         ///< most other players agree with each other, not with this one
  undecided = 2,        ///< no judge and no majority
  server_diverged = 3,  ///< stepped again, the server gets the player's state
};
inline constexpr std::size_t k_verdicts = 4;

enum class FinishReason : std::uint8_t {
  completed = 0,   ///< all ticks were played
  stopped = 1,     ///< the server's owner ended it
  desync = 2,      ///< a state differed, and policy ends the match then
  no_players = 3,  ///< everybody left
};

enum class LeaveReason : std::uint8_t {
  left = 0,            ///< by its own decision
  disconnected = 1,    ///< the transport lost it
  timed_out = 2,       ///< silent, or waited for, beyond the drop time-out
  malformed = 3,       ///< too many packets that break the format
  desync = 4,          ///< kicked after a desync
  too_far_behind = 5,  ///< needs ticks that the server no longer keeps
  match_over = 6,
  flooding = 7,   ///< far more packets than a session sends
  no_hashes = 8,  ///< takes ticks, and does not report the states after them
};
inline constexpr LeaveReason k_last_leave_reason = LeaveReason::no_hashes;
inline constexpr std::size_t k_leave_reasons = static_cast<std::size_t>(k_last_leave_reason) + 1;

/// A player's request to the server.
enum class AskKind : std::uint8_t { pause = 0, resume = 1, vote = 2 };

/// Short lower-case English names, for logs.
[[nodiscard]] std::string_view to_string(LatePolicy policy);
[[nodiscard]] std::string_view to_string(Pacing pacing);
[[nodiscard]] std::string_view to_string(AskKind kind);
[[nodiscard]] std::string_view to_string(RefuseReason reason);
[[nodiscard]] std::string_view to_string(RefuseField field);
[[nodiscard]] std::string_view to_string(Verdict verdict);
[[nodiscard]] std::string_view to_string(FinishReason reason);
[[nodiscard]] std::string_view to_string(LeaveReason reason);

}  // namespace lockstone::net
