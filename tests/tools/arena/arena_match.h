// A match of the arena for tests: the simulation and inputs for all its slots.
#pragma once

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "tools/arena/arena_simulation.h"
#include "tools/arena/bots.h"
#include "tools/arena/integers.h"

namespace lockstone::arena::test {

/// Inputs of one tick, for every slot.
class TickInputs {
 public:
  [[nodiscard]] std::span<std::byte> bytes(std::size_t slot) { return bytes_[slot]; }
  void set_origin(std::size_t slot, InputOrigin origin) { inputs_[slot].origin = origin; }

  [[nodiscard]] std::span<const PlayerInput> view(std::size_t players) {
    for (std::size_t slot = 0; slot < players; ++slot)
      inputs_[slot].bytes = bytes_[slot];
    return std::span(inputs_).first(players);
  }

  /// The inputs of the bots, from their view of `simulation`.
  void press_bots(const ArenaSimulation& simulation, std::uint64_t seed) {
    for (std::size_t slot = 0; slot < simulation.arena().config.players; ++slot) {
      bot_input(simulation.arena(), seed, slot).encode(bytes_[slot]);
    }
  }

  void press_anything(Random& random) {
    for (auto& slot : bytes_) {
      for (std::byte& byte : slot)
        byte = static_cast<std::byte>(random.next() & 0xff);
    }
    for (PlayerInput& input : inputs_) {
      input.origin = static_cast<InputOrigin>(random.below(4));
    }
  }

 private:
  std::array<std::array<std::byte, k_input_bytes>, k_max_players> bytes_{};
  std::array<PlayerInput, k_max_players> inputs_{};
};

inline void step_with_bots(ArenaSimulation& simulation, std::uint64_t seed = 1) {
  TickInputs inputs;
  inputs.press_bots(simulation, seed);
  simulation.step(inputs.view(simulation.arena().config.players));
}

inline std::vector<std::byte> saved(const Simulation& simulation, SnapshotKind kind) {
  std::vector<std::byte> bytes(simulation.snapshot_bytes_max(kind));
  bytes.resize(simulation.save(kind, bytes));
  return bytes;
}

}  // namespace lockstone::arena::test
