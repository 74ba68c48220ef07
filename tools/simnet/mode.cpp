// How a match is played: drawn from its seed, told in words.
#include <algorithm>
#include <array>
#include <string>

#include <fmt/format.h>

#include "net/transport/random.h"
#include "tools/simnet/match.h"

namespace lockstone::simnet {

using net::Random;

std::uint32_t heal_ms(std::uint64_t ticks, std::uint16_t tick_rate) {
  // A server takes five seconds to miss a player that died, and in a relay nobody enters before.
  constexpr std::int64_t k_time_to_enter_ms = 9'000;
  const auto match_ms = static_cast<std::int64_t>(ticks * 1000 / tick_rate);
  return static_cast<std::uint32_t>(
      std::min(match_ms * 85 / 100, std::max(match_ms - k_time_to_enter_ms, match_ms / 2)));
}

MatchMode draw_mode(std::uint64_t seed, std::size_t clients, std::uint32_t heal_ms) {
  constexpr std::array<std::uint8_t, 6> k_delays{0, 1, 3, 4, 8, 20};
  constexpr std::array<std::uint32_t, 3> k_spectator_delays{0, 60, 240};
  constexpr std::array<std::uint8_t, 4> k_predictions{0, 0, 4, 8};
  Random random(seed ^ 0x30de);
  MatchMode mode;
  const std::uint64_t pace = random.below(100);
  if (pace < 25) mode.late_policy = net::LatePolicy::strict;
  if (pace >= 90) mode.pacing = net::Pacing::fast;
  mode.authoritative = random.below(100) < 70;
  mode.input_delay_ticks = k_delays[static_cast<std::size_t>(random.below(k_delays.size()))];
  if (clients > 2 && random.below(100) < 30) mode.late_clients = 1;
  mode.late_ms = static_cast<std::uint32_t>(random.below(heal_ms));
  if (random.below(100) < 40) mode.spectators = 1 + static_cast<std::size_t>(random.below(2));
  mode.spectator_delay_ticks = k_spectator_delays[static_cast<std::size_t>(random.below(3))];
  mode.prediction_ticks = k_predictions[static_cast<std::size_t>(random.below(4))];
  mode.sync_test = random.below(100) < 25;
  return mode;
}

std::string to_text(const MatchMode& mode) {
  const bool strict = mode.late_policy == net::LatePolicy::strict;
  const bool fast = mode.pacing == net::Pacing::fast;
  std::string text =
      fmt::format("{}, {}, input delay {}", fast ? "fast" : (strict ? "strict" : "deadline"),
                  mode.authoritative ? "authoritative" : "relay", mode.input_delay_ticks);
  if (mode.late_clients > 0) text += fmt::format(", one comes after {} ms", mode.late_ms);
  if (mode.spectators > 0) {
    text +=
        fmt::format(", {} spectators {} ticks late", mode.spectators, mode.spectator_delay_ticks);
  }
  if (mode.prediction_ticks > 0) text += fmt::format(", prediction {}", mode.prediction_ticks);
  if (mode.prediction_ticks > 0 && mode.sync_test) text += ", sync test";
  return text;
}

}  // namespace lockstone::simnet
