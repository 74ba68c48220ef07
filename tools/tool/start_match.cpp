#include "tools/tool/start_match.h"

#include <fmt/format.h>

#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

std::string scene_names(const Games& games) {
  std::string text;
  for (const GameDef& game : games.list()) {
    for (const SceneDef& scene : game.scenes)
      text += (text.empty() ? "" : ", ") + scene.name;
  }
  return text;
}

std::nullopt_t refuse_start(const std::string& why) {
  complain(why);
  return std::nullopt;
}

// A game for bytes alone: the one that is named, or the first that takes them.
std::optional<Match> start_from_file(const Games& games, const StartOptions& options) {
  const std::optional<std::string> text = read_file(options.config);
  if (!text) return refuse_start(options.config + ": cannot be read");
  const ByteView bytes = std::as_bytes(std::span(*text));
  Match match;
  match.config.assign(bytes.begin(), bytes.end());
  match.game = options.scene.empty() ? games.of_log({}, bytes) : games.of_scene(options.scene);
  if (match.game == nullptr) return refuse_start("no game here has the scene " + options.scene);
  Result<std::unique_ptr<Simulation>> made = match.game->make(bytes);
  if (!made) {
    return refuse_start(fmt::format("{}: the game '{}' refuses the configuration: {}",
                                    options.config, match.game->name, to_string(made.status())));
  }
  match.simulation = std::move(made).value();
  return match;
}

std::string why_not(const Games& games, const StartOptions& options, Status status) {
  if (status == Status::not_found)
    return fmt::format("unknown scene {}; there are: {}", options.scene, scene_names(games));
  if (status == Status::unsupported_version)
    return "this game makes no configurations; give one with --config FILE";
  return fmt::format("scene {}: {}", options.scene, to_string(status));
}

}  // namespace

void add_start_options(CLI::App& command, const Games& games, StartOptions& options) {
  const std::string names = scene_names(games);
  command.add_option("--scene", options.scene,
                     "Kind of match; default: the first of " + (names.empty() ? "none" : names));
  command.add_option("--config", options.config,
                     "File with the configuration bytes of the match, instead of --scene");
  command
      .add_option("--seed", options.seed, "Seed of the level and of random choices in the rules")
      ->capture_default_str();
  command.add_option("--players", options.players, "Player slots; 0: the usual number")
      ->check(CLI::Range(0U, 16U))
      ->capture_default_str();
}

std::optional<Match> start_match(const Games& games, const StartOptions& options) {
  if (!options.config.empty()) return start_from_file(games, options);
  Result<Match> match = games.start({.scene = options.scene,
                                     .seed = options.seed,
                                     .players = static_cast<std::uint8_t>(options.players),
                                     .bodies = options.bodies});
  if (!match) return refuse_start(why_not(games, options, match.status()));
  return std::move(match).value();
}

bool has_matches(const Games& games) {
  if (games.list().front().configure) return true;
  complain("this command makes matches by itself: the game needs GameDef::configure");
  return false;
}

}  // namespace lockstone::tool
