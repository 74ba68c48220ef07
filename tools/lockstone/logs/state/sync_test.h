// Whether a game's saved bytes are its whole state.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <lockstone/simulation.h>
#include <lockstone/tool.h>

namespace lockstone::tool {

/// A second copy of a match that each tick starts from nothing but the canonical bytes of the
/// first: its next step shows whether the bytes are the whole state. The first one goes through its
/// own native snapshot, and drops its derived data where the game shows a world.
class SyncTest {
 public:
  /// `forget` names a field of the world ("body.spin.x") that the copies lose: the negative
  /// control.
  SyncTest(const GameDef& game, Simulation& first, std::unique_ptr<Simulation> second,
           std::string forget = {});

  /// Steps both; empty, or a line that says how they differ.
  [[nodiscard]] std::string step(std::span<const PlayerInput> inputs);

  /// How often the field to forget was there and not zero.
  [[nodiscard]] std::uint64_t forgotten() const { return forgotten_; }

 private:
  [[nodiscard]] std::string loss();
  void forget(std::span<std::byte> saved);

  const GameDef& game_;
  Simulation& first_;
  std::unique_ptr<Simulation> second_;
  std::string forget_;
  std::vector<std::byte> bytes_;
  std::vector<std::byte> other_bytes_;
  std::vector<std::byte> native_;
  std::uint64_t forgotten_ = 0;
};

}  // namespace lockstone::tool
