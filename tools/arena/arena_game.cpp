#include "tools/arena/arena_game.h"

#include "tools/arena/arena_command.h"
#include "tools/arena/arena_simulation.h"
#include "tools/arena/bots.h"

namespace lockstone::arena {
namespace {

constexpr std::uint32_t k_golden_ticks = 150;

Result<std::vector<std::byte>> configure(const MatchRequest& request) {
  ArenaConfig config;
  config.seed = request.seed;
  if (request.players != 0) config.players = request.players;
  if (request.bodies) {
    if (*request.bodies > k_max_loose_bodies) return Status::invalid_argument;
    config.loose_bodies = static_cast<std::uint16_t>(*request.bodies);
  }
  const auto bytes = config.encode();
  return std::vector<std::byte>(bytes.begin(), bytes.end());
}

bool press(const BotView& view, std::span<std::byte> out) {
  const auto* game = dynamic_cast<const ArenaSimulation*>(&view.simulation);
  if (game == nullptr) return false;
  Input input = bot_input(game->arena(), view.seed, view.slot);
  input.sequence = static_cast<std::uint16_t>(view.tick & 0xffff);
  input.encode(out);
  return true;
}

World* world_of(Simulation& simulation) {
  auto* game = dynamic_cast<ArenaSimulation*>(&simulation);
  return game == nullptr ? nullptr : &game->arena_for_tests().world;
}

}  // namespace

GameDef arena_game() {
  GameDef game;
  game.name = "arena";
  game.version = "0.1";
  game.make = make_arena;
  game.configure = configure;
  game.scenes = {{"arena", "four bots play among 216 bodies", k_golden_ticks}};
  game.bot = press;
  game.world = world_of;
  game.chat_command = chat_command;
  game.chat_text = chat_text;
  return game;
}

}  // namespace lockstone::arena
