// The subcommands around logs and states; as commands.h.
#pragma once

#include <CLI/App.hpp>

namespace lockstone::tool {

void add_record_command(CLI::App& app, int& exit_code);
void add_seek_command(CLI::App& app, int& exit_code);
void add_trace_command(CLI::App& app, int& exit_code);
void add_diff_command(CLI::App& app, int& exit_code);
void add_bisect_command(CLI::App& app, int& exit_code);
void add_repair_command(CLI::App& app, int& exit_code);
void add_cut_command(CLI::App& app, int& exit_code);
void add_keygen_command(CLI::App& app, int& exit_code);
void add_flips_command(CLI::App& app, int& exit_code);
void add_hash_command(CLI::App& app, int& exit_code);
void add_compare_hashes_command(CLI::App& app, int& exit_code);

}  // namespace lockstone::tool
