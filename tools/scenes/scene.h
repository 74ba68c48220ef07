// The scenes that tests, benchmarks and the command share: each a world to build and, for some,
// commands tick by tick.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <lockstone/world.h>

namespace lockstone::scenes {

/// Those who play in a scene; bots, where nobody does.
struct ScenePlayers {
  std::uint32_t count;      ///< 1 … k_max_players
  std::size_t input_bytes;  ///< of a player and tick
  /// Writes a bot's input for the coming tick.
  void (*press)(const World& world, std::size_t slot, std::span<std::byte> out);
  /// Gives the commands of an input, which may hold any bytes.
  void (*apply)(World& world, std::size_t slot, ByteView input);
};

/// A scene has no memory besides its world: its commands of a tick follow from seed, tick and
/// world.
struct Scene {
  std::string_view name;
  std::string_view description;
  std::uint32_t golden_ticks;  ///< small enough for a slow emulator

  WorldDef (*define)();
  void (*build)(World& world, std::uint64_t seed);

  /// Commands before a step; may be null. Of a scene with players those of all its bots.
  void (*drive)(World& world, std::uint64_t seed) = nullptr;

  /// After a step, while its events can be read; may be null.
  void (*observe)(World& world) = nullptr;

  /// The assets of the scene's bodies; null for none. Assets are named by content, so `build` makes
  /// the same list again to learn their names.
  std::vector<AssetPtr> (*assets)(std::uint64_t seed) = nullptr;

  /// In a match their inputs take the place of `drive`; null: nobody plays.
  const ScenePlayers* players = nullptr;
};

/// All scenes on a bare world, in the order in which they are listed. The arena, which has players,
/// is not among them: see play.h.
[[nodiscard]] std::span<const Scene> world_scenes();

/// Null for an unknown name.
[[nodiscard]] const Scene* find_scene(std::string_view name);

}  // namespace lockstone::scenes
