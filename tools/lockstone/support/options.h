// Options that several subcommands have.
#pragma once

#include <string>

#include <CLI/App.hpp>

#include <lockstone/world.h>

namespace lockstone::tool {

/// --broad-phase tree|sweep
void add_broad_phase_option(CLI::App& command, BroadPhaseKind& broad_phase);

/// --simd NAME: forces vectors that this processor has.
void add_simd_option(CLI::App& command);

/// --vectors NAME, of benchmarks: read by `use_vectors`.
void add_vectors_option(CLI::App& command, std::string& vectors);

/// Computes with these vectors from here on; empty: with the widest. False, with a complaint, where
/// this processor lacks them.
[[nodiscard]] bool use_vectors(const std::string& vectors);

/// --threads N
void add_threads_option(CLI::App& command, std::uint32_t& threads);

}  // namespace lockstone::tool
