#include "tools/scenes/scenes_game.h"

#include "tools/scenes/scene.h"
#include "tools/scenes/scene_simulation.h"

namespace lockstone::scenes {
namespace {

Result<std::vector<std::byte>> configure(const MatchRequest& request) {
  if (find_scene(request.scene) == nullptr) return Status::not_found;
  const auto bytes = encode_config(request.scene, request.seed);
  return std::vector<std::byte>(bytes.begin(), bytes.end());
}

bool press(const BotView& view, std::span<std::byte> out) {
  const auto* scene = dynamic_cast<const SceneSimulation*>(&view.simulation);
  if (scene == nullptr || scene->scene().players == nullptr) return false;
  scene->scene().players->press(scene->world(), view.slot, out);
  return true;
}

World* world_inside(Simulation& simulation) {
  auto* scene = dynamic_cast<SceneSimulation*>(&simulation);
  return scene == nullptr ? nullptr : &scene->world_for_tests();
}

}  // namespace

GameDef scenes_game() {
  GameDef game;
  game.name = "scenes";
  game.version = "0.1";
  game.make = make_scene;
  game.configure = configure;
  for (const Scene& scene : world_scenes())
    game.scenes.push_back(
        {std::string(scene.name), std::string(scene.description), scene.golden_ticks});
  game.bot = press;
  game.world = world_inside;
  return game;
}

}  // namespace lockstone::scenes
