// The games that a tool knows, and matches of them.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <lockstone/replay/format.h>
#include <lockstone/simulation.h>
#include <lockstone/tool.h>

namespace lockstone::tool {

/// A new match with the configuration bytes that it was made from.
struct Match {
  const GameDef* game = nullptr;
  std::vector<std::byte> config;
  std::unique_ptr<Simulation> simulation;
};

class Games {
 public:
  explicit Games(std::vector<GameDef> list) : list_(std::move(list)) {}

  /// Puts a game in front: it becomes the default, and hides another of the same name.
  void add_front(GameDef game) { list_.insert(list_.begin(), std::move(game)); }

  [[nodiscard]] const std::vector<GameDef>& list() const { return list_; }

  /// Null for an unknown name.
  [[nodiscard]] const GameDef* find(std::string_view name) const;

  /// The game that plays this log: the one that its header names, or, of a log that names none, the
  /// first whose configuration it is. Null when no game here has that name.
  [[nodiscard]] const GameDef* of_log(const replay::LogHeader& header, ByteView config) const;

  /// The game that has this scene, or is called so; the first game for an empty name. Null: none.
  [[nodiscard]] const GameDef* of_scene(std::string_view scene) const;

  /// Makes whatever simulation one of the games knows these configuration bytes for: for clients,
  /// which learn nothing else of a match.
  [[nodiscard]] SimulationFactory any() const;

  /// "arena, scenes".
  [[nodiscard]] std::string names() const;

  /// not_found for an unknown scene, unsupported_version from a game that configures no matches.
  [[nodiscard]] Result<Match> start(const MatchRequest& request) const;

 private:
  std::vector<GameDef> list_;
};

/// "this log is of game 'sumo' 1.2; this tool knows arena, scenes; use --game".
[[nodiscard]] std::string foreign_game_text(const replay::MatchMetadata& match, const Games& games);

/// GameDef::build, or the name and version.
[[nodiscard]] std::string build_of(const GameDef& game);

/// The part of a log's header that names the game.
void name_game(const GameDef& game, replay::MatchMetadata& match);

/// The game's world, or null where it has none to show.
[[nodiscard]] World* world_of(const GameDef& game, Simulation& simulation);

/// The players of the match that a game starts by this request; nothing when it refuses.
[[nodiscard]] std::optional<unsigned> players_of(const GameDef& game, const MatchRequest& request);

/// Writes a bot's input for one tick; false when nobody plays the slot.
[[nodiscard]] bool press(const GameDef& game, const BotView& view, std::span<std::byte> out);

/// Inputs of a match that runs by itself.
class MatchInputs {
 public:
  MatchInputs(const GameDef& game, std::uint64_t seed) : game_(game), seed_(seed) {}

  /// For the next tick of a simulation of this game; valid until the next call.
  [[nodiscard]] std::span<const PlayerInput> next(const Simulation& simulation);

 private:
  const GameDef& game_;
  std::uint64_t seed_;
  SimulationInfo info_{};  ///< once known: it may be slow to ask for
  std::array<std::array<std::byte, k_max_input_bytes>, k_max_players> bytes_{};
  std::array<PlayerInput, k_max_players> inputs_{};
};

}  // namespace lockstone::tool
