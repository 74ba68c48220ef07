#include "rolling_game.h"

#include "rolling.h"

namespace {

// The configuration of a match is one byte: the number of players.
Result<std::vector<std::byte>> configure(const MatchRequest& request) {
  if (request.players > k_max_players) return Status::invalid_argument;
  return std::vector<std::byte>{static_cast<std::byte>(request.players == 0 ? 2 : request.players)};
}

World* world_of(Simulation& simulation) {
  auto* game = dynamic_cast<RollingGame*>(&simulation);
  return game == nullptr ? nullptr : &game->world();
}

}  // namespace

GameDef rolling_game() {
  return {.name = "rolling",
          .version = "1.0",
          .make = make_game,
          .configure = configure,
          .scenes = {{.name = "floor", .description = "balls on a floor"}},
          .world = world_of};
}
