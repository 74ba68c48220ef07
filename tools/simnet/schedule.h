// The faults of one simulated match: the kind, the victim, the time and the amount of each.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lockstone::simnet {

enum class FaultKind : std::uint8_t {
  loss,         ///< amount: ppm of packets
  burst,        ///< amount: ppm of packets that begin a burst of four on average
  duplicate,    ///< amount: ppm
  reorder,      ///< amount: ppm, held back by up to 100 ms
  delay,        ///< amount: ms, one way
  jitter,       ///< amount: ms
  corrupt,      ///< amount: ppm of unreliable packets with one byte changed
  truncate,     ///< amount: ppm
  forge,        ///< amount: forged packets a second to the server, as from this client
  cut,          ///< nothing passes, either way
  cut_sending,  ///< the server does not hear the client
  cut_hearing,  ///< the client does not hear the server
  pause,        ///< the client's process stands still
  kill,         ///< the client's process dies, and starts again when the time is over
  skew,         ///< amount: the client's clock is off by amount - 500 ppm
  disk_full,    ///< the recorder's disk takes no more; client is 0
};
inline constexpr std::size_t k_fault_kinds = 16;

[[nodiscard]] std::string_view to_string(FaultKind kind);

/// Whether a client is not heard, or hears nothing, meanwhile.
[[nodiscard]] bool silences(FaultKind kind);

/// A set of kinds; bit n stands for FaultKind n.
using FaultMask = std::uint32_t;
inline constexpr FaultMask k_all_faults = (1U << k_fault_kinds) - 1;

/// From `all`, `none`, or names with commas between. Nothing for an unknown name.
[[nodiscard]] std::optional<FaultMask> parse_faults(std::string_view text);

struct FaultEvent {
  FaultKind kind = FaultKind::loss;
  std::uint8_t client = 0;
  std::uint32_t from_ms = 0;
  std::uint32_t until_ms = 0;
  std::uint32_t amount = 0;
  friend bool operator==(const FaultEvent&, const FaultEvent&) = default;
};
using Schedule = std::vector<FaultEvent>;

/// `loss@2:1000-5000=120000,kill@0:2000-2500=0`; `none` for an empty one.
[[nodiscard]] std::string to_text(const Schedule& schedule);
[[nodiscard]] std::optional<Schedule> parse_schedule(std::string_view text);

/// Draws the faults of a match of `match_ms` from a seed. Each kind has its own random stream, and
/// all faults are over at `heal_ms`. A client that is cut off or stands still, does so for at most
/// 4 s; one that is dead, for 12 s; each is left alone for 4 s after.
[[nodiscard]] Schedule draw_schedule(std::uint64_t seed, FaultMask kinds, std::size_t clients,
                                     std::uint32_t heal_ms);

}  // namespace lockstone::simnet
