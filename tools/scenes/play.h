// Any scene, being played: the simulation, its world to look at, and bots in its player slots.
#pragma once

#include <cstdint>
#include <memory>
#include <span>
#include <string_view>
#include <vector>

#include <lockstone/simulation.h>
#include <lockstone/world.h>

#include "tools/scenes/scene.h"

namespace lockstone::scenes {

/// The entry of a scene in the list of scenes.
struct SceneSummary {
  std::string_view name;
  std::string_view description;
  std::uint32_t golden_ticks;
};

/// All scenes, the arena last. Builds none of them.
[[nodiscard]] std::vector<SceneSummary> list_scenes();

/// Of a scene in the list, at the beginning, for seed 1. Builds it.
[[nodiscard]] std::uint32_t count_bodies(const SceneSummary& scene);

/// One scene with everything that it needs to go on by itself.
class ScenePlay {
 public:
  virtual ~ScenePlay() = default;

  /// Advances by one tick with the bots' inputs, if the scene has players.
  void step() { simulation().step(next_inputs()); }

  /// Those inputs; valid until the next call.
  [[nodiscard]] virtual std::span<const PlayerInput> next_inputs() = 0;

  [[nodiscard]] virtual Simulation& simulation() = 0;
  [[nodiscard]] virtual const World& world() const = 0;
  [[nodiscard]] virtual const StepReport& last_report() const = 0;
  virtual void drop_derived() = 0;

  /// As `World::set_task_runner`.
  virtual void set_task_runner(TaskRunner* runner, TaskPieces pieces) = 0;
};

/// Parameters of a scene in the list; the arena has none.
[[nodiscard]] std::vector<SceneParameter> parameters_of(std::string_view name);

/// not_found for an unknown name; invalid_argument for `values` that scene_values refuses. The
/// broad phase changes no result, and `spare_bodies`, room for bodies besides those of a scene on a
/// bare world, neither.
[[nodiscard]] Result<std::unique_ptr<ScenePlay>> make_play(
    std::string_view name, std::uint64_t seed, BroadPhaseKind broad_phase = BroadPhaseKind::tree,
    std::uint32_t spare_bodies = 0, std::span<const std::int32_t> values = {});

/// Makes whatever simulation configuration bytes name: the arena or a scene. For tests; the tools
/// go by their list of games.
[[nodiscard]] Result<std::unique_ptr<Simulation>> make_simulation(ByteView config);

/// The world inside a simulation that make_simulation made.
[[nodiscard]] const World* world_of(const Simulation& simulation);

}  // namespace lockstone::scenes
