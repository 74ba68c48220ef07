// Command-line options that `serve` and `demo` share.
#pragma once

#include <CLI/App.hpp>

#include "tools/lockstone/match/match_host.h"
#include "tools/lockstone/support/output_file.h"

namespace lockstone::tool {

inline void add_match_options(CLI::App& command, MatchOptions& options) {
  command.add_option("--players", options.players, "Player slots")
      ->check(CLI::Range(1U, 16U))
      ->capture_default_str();
  command.add_option("--ticks", options.ticks, "Ticks to play; 0: until interrupted")
      ->capture_default_str();
  command.add_option("--seed", options.seed, "Of the level and of chance in the rules")
      ->capture_default_str();
  command.add_option("--bodies", options.bodies, "Crates, balls and barrels in the arena")
      ->check(CLI::Range(0, 600))
      ->capture_default_str();
  command.add_option("--input-delay", options.input_delay, "Ticks from a press to its effect")
      ->check(CLI::Range(0, 60))
      ->capture_default_str();
  add_force_option(command, options.force);
  command.add_flag("--fast", options.fast, "As fast as inputs come, not 60 ticks a second");
}

}  // namespace lockstone::tool
