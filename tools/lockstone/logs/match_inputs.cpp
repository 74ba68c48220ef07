#include "tools/lockstone/logs/match_inputs.h"

#include "tools/arena/arena_simulation.h"
#include "tools/arena/bots.h"
#include "tools/scenes/play.h"
#include "tools/scenes/scene_simulation.h"

namespace lockstone::tool {

Result<Match> make_match(std::string_view scene, std::uint64_t seed) {
  const auto to_vector = [](const auto& bytes) {
    return std::vector<std::byte>(bytes.begin(), bytes.end());
  };
  Match match;
  if (scene == "arena") {
    arena::ArenaConfig config;
    config.seed = seed;
    match.config = to_vector(config.encode());
  } else {
    if (scenes::find_scene(scene) == nullptr) return Status::not_found;
    match.config = to_vector(scenes::encode_config(scene, seed));
  }
  Result<std::unique_ptr<Simulation>> made = scenes::make_simulation(match.config);
  if (!made) return made.status();
  match.simulation = std::move(made).value();
  return match;
}

std::span<const PlayerInput> MatchInputs::next(const Simulation& simulation) {
  const auto* game = dynamic_cast<const arena::ArenaSimulation*>(&simulation);
  if (game == nullptr) {
    inputs_[0] = {std::span(bytes_[0]).first(1), InputOrigin::absent};
    return std::span(inputs_).first(1);
  }
  const std::size_t players = game->arena().config.players;
  for (std::size_t slot = 0; slot < players; ++slot) {
    const std::span<std::byte, arena::k_input_bytes> bytes =
        std::span(bytes_[slot]).first<arena::k_input_bytes>();
    arena::bot_input(game->arena(), seed_, slot).encode(bytes);
    inputs_[slot] = {bytes, InputOrigin::received};
  }
  return std::span(inputs_).first(players);
}

}  // namespace lockstone::tool
