// The scenes that tests, benchmarks and the command share: each a world to build and, for some,
// commands tick by tick.
#pragma once

#include <array>
#include <cstddef>
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

/// A whole number that a scene can be built with, such as a count of bodies.
struct SceneParameter {
  std::string_view name{};
  std::int32_t usual = 0;  ///< in the scene that the golden hashes are of
  std::int32_t least = 0;
  std::int32_t most = 0;
};

inline constexpr std::size_t k_max_scene_parameters = 4;

/// Values of a scene's parameters, in their order.
using SceneValues = std::array<std::int32_t, k_max_scene_parameters>;

/// A function that builds the world of a scene with or without parameters.
class SceneBuilder {
 public:
  using Plain = void (*)(World& world, std::uint64_t seed);
  using Sized = void (*)(World& world, std::uint64_t seed, const SceneValues& values);
  constexpr SceneBuilder(Plain plain) : plain_(plain) {}  // NOLINT: a scene names its function
  constexpr SceneBuilder(Sized sized) : sized_(sized) {}  // NOLINT

  void operator()(World& world, std::uint64_t seed, const SceneValues& values) const {
    plain_ != nullptr ? plain_(world, seed) : sized_(world, seed, values);
  }

 private:
  Plain plain_ = nullptr;
  Sized sized_ = nullptr;
};

/// A scene has no memory besides its world: its commands of a tick follow from seed, tick and
/// world.
struct Scene {
  std::string_view name;
  std::string_view description;
  std::uint32_t golden_ticks;  ///< small enough for a slow emulator

  WorldDef (*define)();
  SceneBuilder builder;

  /// Commands before a step; may be null. Of a scene with players those of all its bots.
  void (*drive)(World& world, std::uint64_t seed) = nullptr;

  /// After a step, while its events can be read; may be null.
  void (*observe)(World& world) = nullptr;

  /// The assets of the scene's bodies; null for none. Assets are named by content, so `build` makes
  /// the same list again to learn their names.
  std::vector<AssetPtr> (*assets)(std::uint64_t seed) = nullptr;

  /// In a match their inputs take the place of `drive`; null: nobody plays.
  const ScenePlayers* players = nullptr;

  /// Its own ones; those after the last have no name. `parameters_of` has all.
  std::array<SceneParameter, 2> own_parameters{};

  /// Builds the scene that the golden hashes are of.
  void build(World& world, std::uint64_t seed) const;
};

/// Those of the scene, then those of every scene: `substeps`, and `gravity` downwards in cm/s².
[[nodiscard]] std::vector<SceneParameter> parameters_of(const Scene& scene);

/// The usual values with those of `given`, which may be fewer than there are parameters, in front;
/// invalid_argument for more, or for one out of its range.
[[nodiscard]] Result<SceneValues> scene_values(const Scene& scene,
                                               std::span<const std::int32_t> given);

/// Makes the world that a scene with these values is built in: where they are not the usual ones it
/// has room for more bodies, contacts and joints.
[[nodiscard]] WorldDef define_scene(const Scene& scene, const SceneValues& values);

/// All scenes on a bare world, in the order in which they are listed. The arena, which has players,
/// is not among them: see play.h.
[[nodiscard]] std::span<const Scene> world_scenes();

/// Null for an unknown name.
[[nodiscard]] const Scene* find_scene(std::string_view name);

}  // namespace lockstone::scenes
