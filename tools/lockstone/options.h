// Options that several subcommands have.
#pragma once

#include <CLI/App.hpp>

#include <lockstone/world.h>

namespace lockstone::tool {

/// --broad-phase tree|sweep
void add_broad_phase_option(CLI::App& command, BroadPhaseKind& broad_phase);

}  // namespace lockstone::tool
