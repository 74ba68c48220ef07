// Inputs of a match that runs by itself: bots in the arena, nobody in a scene.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <lockstone/simulation.h>

namespace lockstone::tool {

/// A scene or the arena with the configuration bytes that it was made from.
struct Match {
  std::vector<std::byte> config;
  std::unique_ptr<Simulation> simulation;
};

/// not_found for an unknown name.
[[nodiscard]] Result<Match> make_match(std::string_view scene, std::uint64_t seed);

/// The inputs that `lockstone run` would give.
class MatchInputs {
 public:
  explicit MatchInputs(std::uint64_t seed) : seed_(seed) {}

  /// For the next tick of a simulation that make_match() made; valid until the next call.
  [[nodiscard]] std::span<const PlayerInput> next(const Simulation& simulation);

 private:
  std::uint64_t seed_;
  std::array<std::array<std::byte, k_max_input_bytes>, k_max_players> bytes_{};
  std::array<PlayerInput, k_max_players> inputs_{};
};

}  // namespace lockstone::tool
