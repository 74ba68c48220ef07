#include "tools/scenes/play.h"

#include <array>

#include "tools/arena/arena_simulation.h"
#include "tools/arena/bots.h"
#include "tools/scenes/scene.h"
#include "tools/scenes/scene_simulation.h"

namespace lockstone::scenes {
namespace {

constexpr std::string_view k_arena_name = "arena";
constexpr std::string_view k_arena_description = "four bots play among 216 bodies";
constexpr std::uint32_t k_arena_golden_ticks = 150;

class WorldPlay final : public ScenePlay {
 public:
  WorldPlay(const Scene& scene, std::uint64_t seed, BroadPhaseKind broad_phase,
            std::uint32_t spare_bodies, std::span<const std::int32_t> values)
      : simulation_(scene, seed, broad_phase, spare_bodies, values) {}

  [[nodiscard]] std::span<const PlayerInput> next_inputs() override {
    const ScenePlayers* players = simulation_.scene().players;
    if (players == nullptr) return {&k_absent, 1};
    for (std::size_t slot = 0; slot < players->count; ++slot) {
      const std::span<std::byte> input = std::span(bytes_[slot]).first(players->input_bytes);
      players->press(world(), slot, input);
      inputs_[slot] = {input, InputOrigin::received};
    }
    return std::span(inputs_).first(players->count);
  }
  [[nodiscard]] Simulation& simulation() override { return simulation_; }
  [[nodiscard]] const World& world() const override { return simulation_.world(); }
  [[nodiscard]] const StepReport& last_report() const override { return simulation_.last_report(); }
  void drop_derived() override { simulation_.world_for_tests().drop_derived(); }
  void set_task_runner(TaskRunner* runner, TaskPieces pieces) override {
    simulation_.world_for_tests().set_task_runner(runner, pieces);
  }

 private:
  static constexpr std::array<std::byte, 1> k_nothing{};
  static constexpr PlayerInput k_absent{k_nothing, InputOrigin::absent};

  SceneSimulation simulation_;
  std::array<std::array<std::byte, k_max_input_bytes>, k_max_players> bytes_{};
  std::array<PlayerInput, k_max_players> inputs_{};
};

class ArenaPlay final : public ScenePlay {
 public:
  ArenaPlay(const arena::ArenaConfig& config, BroadPhaseKind broad_phase)
      : simulation_(config, broad_phase) {}

  [[nodiscard]] std::span<const PlayerInput> next_inputs() override {
    const arena::ArenaConfig& config = simulation_.arena().config;
    for (std::size_t slot = 0; slot < config.players; ++slot) {
      arena::bot_input(simulation_.arena(), config.seed, slot).encode(bytes_[slot]);
      inputs_[slot] = {bytes_[slot], InputOrigin::received};
    }
    return std::span(inputs_).first(config.players);
  }
  [[nodiscard]] Simulation& simulation() override { return simulation_; }
  [[nodiscard]] const World& world() const override { return simulation_.arena().world; }
  [[nodiscard]] const StepReport& last_report() const override { return simulation_.last_report(); }
  void drop_derived() override { simulation_.arena_for_tests().world.drop_derived(); }
  void set_task_runner(TaskRunner* runner, TaskPieces pieces) override {
    simulation_.arena_for_tests().world.set_task_runner(runner, pieces);
  }

 private:
  arena::ArenaSimulation simulation_;
  std::array<std::array<std::byte, arena::k_input_bytes>, k_max_players> bytes_{};
  std::array<PlayerInput, k_max_players> inputs_{};
};

}  // namespace

std::vector<SceneSummary> list_scenes() {
  std::vector<SceneSummary> list;
  for (const Scene& scene : world_scenes())
    list.push_back({scene.name, scene.description, scene.golden_ticks});
  list.push_back({k_arena_name, k_arena_description, k_arena_golden_ticks});
  return list;
}

std::vector<SceneParameter> parameters_of(std::string_view name) {
  const Scene* scene = find_scene(name);
  return scene == nullptr ? std::vector<SceneParameter>{} : parameters_of(*scene);
}

std::uint32_t count_bodies(const SceneSummary& scene) {
  return make_play(scene.name, 1).value()->world().body_count();
}

Result<std::unique_ptr<ScenePlay>> make_play(std::string_view name, std::uint64_t seed,
                                             BroadPhaseKind broad_phase, std::uint32_t spare_bodies,
                                             std::span<const std::int32_t> values) {
  if (name == k_arena_name) {
    if (!values.empty()) return Status::invalid_argument;
    arena::ArenaConfig config;
    config.seed = seed;
    return std::unique_ptr<ScenePlay>(std::make_unique<ArenaPlay>(config, broad_phase));
  }
  const Scene* scene = find_scene(name);
  if (scene == nullptr) return Status::not_found;
  if (!scene_values(*scene, values).ok()) return Status::invalid_argument;
  return std::unique_ptr<ScenePlay>(
      std::make_unique<WorldPlay>(*scene, seed, broad_phase, spare_bodies, values));
}

Result<std::unique_ptr<Simulation>> make_simulation(ByteView config) {
  const auto magic = ByteReader(config).get<std::uint32_t>();
  if (magic == k_config_magic) return make_scene(config);
  return arena::make_arena(config);
}

const World* world_of(const Simulation& simulation) {
  if (const auto* scene = dynamic_cast<const SceneSimulation*>(&simulation)) return &scene->world();
  const auto* game = dynamic_cast<const arena::ArenaSimulation*>(&simulation);
  return game == nullptr ? nullptr : &game->arena().world;
}

}  // namespace lockstone::scenes
