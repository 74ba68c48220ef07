// Options that several subcommands have.
#pragma once

#include <CLI/App.hpp>

#include <lockstone/world.h>

namespace lockstone::tool {

/// --broad-phase tree|sweep
void add_broad_phase_option(CLI::App& command, BroadPhaseKind& broad_phase);

/// --simd NAME: forces vectors that this processor has.
void add_simd_option(CLI::App& command);

/// --threads N
void add_threads_option(CLI::App& command, std::uint32_t& threads);

}  // namespace lockstone::tool
