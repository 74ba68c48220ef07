// New matches by options: a scene that a game knows by name, or configuration bytes from a file.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

#include <CLI/App.hpp>

#include "tools/tool/games.h"

namespace lockstone::tool {

struct StartOptions {
  std::string scene;   ///< empty: the first game's first
  std::string config;  ///< a file, instead
  std::uint64_t seed = 1;
  unsigned players = 0;  ///< 0: the usual number
  std::optional<std::uint32_t> bodies;
};

/// --scene, --config, --seed, --players.
void add_start_options(CLI::App& command, const Games& games, StartOptions& options);

/// Nothing, with a complaint, when no game knows the scene, or refuses the configuration.
[[nodiscard]] std::optional<Match> start_match(const Games& games, const StartOptions& options);

/// True, or a complaint that the first game cannot make a match of this many players by itself.
[[nodiscard]] bool has_matches(const Games& games);

}  // namespace lockstone::tool
