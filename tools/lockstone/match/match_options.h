// Command-line options that `serve` and `demo` share.
#pragma once

#include <CLI/App.hpp>

#include "tools/lockstone/match/match_host.h"
#include "tools/lockstone/support/output_file.h"

namespace lockstone::tool {

inline void add_match_options(CLI::App& command, const Games& games, MatchOptions& options) {
  add_start_options(command, games, options.start);
  command.add_option("--ticks", options.ticks, "Ticks to play; 0: until interrupted")
      ->capture_default_str();
  command.add_option("--bodies", options.start.bodies,
                     "Loose bodies, in games that take such a number; default: theirs");
  command.add_option("--input-delay", options.input_delay, "Ticks from a press to its effect")
      ->check(CLI::Range(0, 60))
      ->capture_default_str();
  add_force_option(command, options.force);
  command.add_flag("--fast", options.fast, "As fast as inputs come, not 60 ticks a second");
}

}  // namespace lockstone::tool
