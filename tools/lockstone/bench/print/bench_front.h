// Time against error of all engines, measured in one go: `bench accuracy --plot`, `bench scenes`.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/charts/front.h"
#include "tools/lockstone/support/output_file.h"

namespace CLI {
class App;
}

namespace lockstone::tool {

struct FrontOptions {
  std::vector<std::string> scenes;  ///< none: all
  std::vector<int> settings{1, 2, 4, 8, 16, 32};
  int repeats = 3;
  bool quick = false;  ///< small scenes, fewer settings
  bool alone = false;  ///< ours alone
  std::string node;    ///< folder of the runner of engines under Node; empty: none
  std::string wasm;    ///< lockstone_scene_player, for Node; empty: none
};

/// --scenes, --settings, --repeats, --quick, --alone, --node, --wasm
void add_front_options(CLI::App& command, FrontOptions& options);

struct MeasuredFront {
  std::vector<bench::EngineRuns> engines;
  std::vector<std::string> absent;        ///< with their requirements
  int same_states = 0;                    ///< of ours in WebAssembly at the end, as natively
  std::vector<std::string> other_states;  ///< scenes and settings that ended otherwise
};

/// Each engine by turns, at each setting; shows how far it is.
[[nodiscard]] MeasuredFront measure_front(FrontOptions options);

/// Before measuring: true when write_front() may write there, else a complaint.
[[nodiscard]] bool may_write_front(const Output& output);

/// Writes charts and pages into a folder, or all charts into one file *.svg, and prints the counts.
/// False, with a complaint, when the system refuses.
[[nodiscard]] bool write_front(const MeasuredFront& measured, const Output& output,
                               const std::string& command);

}  // namespace lockstone::tool
