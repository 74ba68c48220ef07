// A subcommand that this build lacks.
#pragma once

#include <string>

#include <CLI/App.hpp>

namespace lockstone::tool {

/// Adds `name` to `parent`: whatever it is given, it complains with the `reason` and ends with
/// k_unavailable.
void add_absent_command(CLI::App& parent, int& exit_code, const std::string& name,
                        const std::string& reason);

}  // namespace lockstone::tool
