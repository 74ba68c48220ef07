// The subcommands around logs and states; as commands.h.
#pragma once

namespace CLI {
class App;
}

namespace lockstone::tool {

struct Tool;

void add_info_command(CLI::App& app, Tool& tool);
void add_verify_command(CLI::App& app, Tool& tool);
void add_record_command(CLI::App& app, Tool& tool);
void add_seek_command(CLI::App& app, Tool& tool);
void add_trace_command(CLI::App& app, Tool& tool);
void add_diff_command(CLI::App& app, Tool& tool);
void add_bisect_command(CLI::App& app, Tool& tool);
void add_repair_command(CLI::App& app, Tool& tool);
void add_cut_command(CLI::App& app, Tool& tool);
void add_keygen_command(CLI::App& app, Tool& tool);
void add_flips_command(CLI::App& app, Tool& tool);
void add_sync_test_command(CLI::App& app, Tool& tool);
void add_hash_command(CLI::App& app, Tool& tool);
void add_compare_hashes_command(CLI::App& app, Tool& tool);

}  // namespace lockstone::tool
