#include "tools/tool/games.h"

#include <algorithm>

#include <lockstone/bytes.h>
#include <lockstone/hash.h>

namespace lockstone::tool {
namespace {

// Bytes of a player who presses anything and holds it for eight ticks: any input is legal.
void press_anything(const BotView& view, std::span<std::byte> out) {
  std::array<std::byte, 16> key{};
  ByteWriter writer(key);
  writer.put(view.tick / 8);
  writer.put(std::uint64_t{view.slot});
  for (std::size_t i = 0; i < out.size(); ++i)
    out[i] = static_cast<std::byte>(hash64(key, view.seed + i) & 0xff);
}

bool knows_scene(const GameDef& game, std::string_view scene) {
  return game.name == scene ||
         std::ranges::any_of(game.scenes, [&](const SceneDef& def) { return def.name == scene; });
}

}  // namespace

const GameDef* Games::find(std::string_view name) const {
  const auto found = std::ranges::find(list_, name, &GameDef::name);
  return found == list_.end() ? nullptr : &*found;
}

const GameDef* Games::of_log(const replay::LogHeader& header, ByteView config) const {
  if (!header.match.game.empty()) return find(header.match.game);
  const auto makes = [config](const GameDef& game) { return game.make(config).ok(); };
  const auto found = list_.size() == 1 ? list_.begin() : std::ranges::find_if(list_, makes);
  return found == list_.end() ? &list_.front() : &*found;
}

const GameDef* Games::of_scene(std::string_view scene) const {
  if (scene.empty()) return &list_.front();
  const auto found = std::ranges::find_if(
      list_, [scene](const GameDef& game) { return knows_scene(game, scene); });
  return found == list_.end() ? nullptr : &*found;
}

SimulationFactory Games::any() const {
  return [this](ByteView config) -> Result<std::unique_ptr<Simulation>> {
    Result<std::unique_ptr<Simulation>> made = list_.front().make(config);
    for (std::size_t i = 1; i < list_.size() && !made; ++i) {
      Result<std::unique_ptr<Simulation>> other = list_[i].make(config);
      if (other) return other;
    }
    return made;
  };
}

std::string Games::names() const {
  std::string text;
  for (const GameDef& game : list_)
    text += (text.empty() ? "" : ", ") + game.name;
  return text;
}

Result<Match> Games::start(const MatchRequest& request) const {
  Match match;
  match.game = of_scene(request.scene);
  if (match.game == nullptr) return Status::not_found;
  if (!match.game->configure) return Status::unsupported_version;
  MatchRequest asked = request;
  const bool named = std::ranges::any_of(
      match.game->scenes, [&](const SceneDef& def) { return def.name == request.scene; });
  if (!named) {
    asked.scene = match.game->scenes.empty() ? std::string_view() : match.game->scenes.front().name;
  }
  Result<std::vector<std::byte>> config = match.game->configure(asked);
  if (!config) return config.status();
  match.config = std::move(config).value();
  Result<std::unique_ptr<Simulation>> made = match.game->make(match.config);
  if (!made) return made.status();
  match.simulation = std::move(made).value();
  return match;
}

std::string foreign_game_text(const replay::MatchMetadata& match, const Games& games) {
  const std::string version = match.game_version.empty() ? "" : ' ' + match.game_version;
  return "this log is of game '" + match.game + '\'' + version + "; this tool knows " +
         games.names() + "; use --game";
}

std::string build_of(const GameDef& game) {
  if (!game.build.empty()) return game.build;
  return game.version.empty() ? game.name : game.name + ' ' + game.version;
}

void name_game(const GameDef& game, replay::MatchMetadata& match) {
  match.build = build_of(game);
  match.game = game.name;
  match.game_version = game.version;
}

World* world_of(const GameDef& game, Simulation& simulation) {
  return game.world ? game.world(simulation) : nullptr;
}

std::optional<unsigned> players_of(const GameDef& game, const MatchRequest& request) {
  if (!game.configure) return std::nullopt;
  const Result<std::vector<std::byte>> config = game.configure(request);
  if (!config) return std::nullopt;
  const auto simulation = game.make(config.value());
  if (!simulation) return std::nullopt;
  return simulation.value()->info().player_count;
}

bool press(const GameDef& game, const BotView& view, std::span<std::byte> out) {
  std::ranges::fill(out, std::byte{0});
  if (game.bot) return game.bot(view, out);
  press_anything(view, out);
  return true;
}

std::span<const PlayerInput> MatchInputs::next(const Simulation& simulation) {
  if (info_.player_count == 0) info_ = simulation.info();
  const std::uint64_t tick = simulation.tick();
  for (std::size_t slot = 0; slot < info_.player_count; ++slot) {
    const std::span<std::byte> bytes = std::span(bytes_[slot]).first(info_.input_bytes);
    const bool played = press(game_, {simulation, seed_, slot, tick}, bytes);
    if (!played) std::ranges::fill(bytes, std::byte{0});
    inputs_[slot] = {bytes, played ? InputOrigin::received : InputOrigin::absent};
  }
  return std::span(inputs_).first(info_.player_count);
}

}  // namespace lockstone::tool
