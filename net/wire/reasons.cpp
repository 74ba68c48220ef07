#include <array>
#include <cstddef>
#include <span>

#include <lockstone/net/reasons.h>

namespace lockstone::net {
namespace {

constexpr std::array<std::string_view, k_refuse_reasons> k_refuse_texts{
    "none",
    "protocol mismatch",
    "insecure not allowed",
    "simulation mismatch",
    "match full",
    "slot taken",
    "match running",
    "handshake timeout",
    "token refused",
    "token expired",
    "token of another match",
    "token of other servers",
    "token of another slot",
    "replaced by a newer connection",
    "flooding",
    "damaged stream",
    "sent away from this match"};
constexpr std::array<std::string_view, 11> k_refuse_fields{
    "none",   "protocol",  "insecure",     "abi",         "config_hash", "scene_hash",
    "canary", "tick_rate", "player_count", "input_bytes", "slot"};
constexpr std::array<std::string_view, k_verdicts> k_verdict_texts{"client diverged", "minority",
                                                                   "undecided", "server diverged"};
constexpr std::array<std::string_view, 4> k_finish_reasons{"completed", "stopped", "desync",
                                                           "no players"};
constexpr std::array<std::string_view, k_leave_reasons> k_leave_texts{
    "left",           "disconnected", "timed out", "malformed", "desync",
    "too far behind", "match over",   "flooding",  "no hashes"};

template <class E>
std::string_view name_of(std::span<const std::string_view> names, E value) {
  const auto index = static_cast<std::size_t>(value);
  return index < names.size() ? names[index] : "unknown";
}

}  // namespace

std::string_view to_string(LatePolicy policy) {
  constexpr std::array<std::string_view, 2> k_names{"deadline", "strict"};
  return name_of(k_names, policy);
}
std::string_view to_string(Pacing pacing) {
  constexpr std::array<std::string_view, 2> k_names{"real time", "fast"};
  return name_of(k_names, pacing);
}
std::string_view to_string(AskKind kind) {
  constexpr std::array<std::string_view, 3> k_names{"pause", "resume", "vote"};
  return name_of(k_names, kind);
}
std::string_view to_string(RefuseReason reason) {
  return name_of(k_refuse_texts, reason);
}
std::string_view to_string(RefuseField field) {
  return name_of(k_refuse_fields, field);
}
std::string_view to_string(Verdict verdict) {
  return name_of(k_verdict_texts, verdict);
}
std::string_view to_string(FinishReason reason) {
  return name_of(k_finish_reasons, reason);
}
std::string_view to_string(LeaveReason reason) {
  return name_of(k_leave_texts, reason);
}

}  // namespace lockstone::net
