#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <lockstone/replay/seek.h>
#include <lockstone/replay/snapshot_file.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/logs/log_commands.h"
#include "tools/lockstone/logs/state/canonical_bytes.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct SeekOptions {
  std::string file;
  std::uint64_t tick = 0;
  std::string state;
  std::string svg;
  bool force = false;
  bool replay = false;
  bool json = false;
};

bool write_state(const SeekOptions& options, const Simulation& simulation) {
  if (options.state.empty()) return true;
  const std::vector<std::byte> bytes = replay::pack_snapshot(canonical_bytes(simulation));
  return write_text_file({options.state, options.force},
                         std::string(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
}

bool draw(const SeekOptions& options, const GameDef& game, const Simulation& simulation) {
  if (options.svg.empty()) return true;
  return write_text_file({options.svg, options.force}, game.draw(simulation));
}

void print(const SeekOptions& options, const replay::SeekResult& found) {
  const std::uint64_t hash = found.simulation->hash();
  if (options.json) {
    nlohmann::ordered_json json{{"tick", options.tick},
                                {"hash", hash_text(hash)},
                                {"loaded_tick", found.loaded_tick},
                                {"diverged", found.diverged}};
    if (found.diverged) json["diverged_tick"] = found.diverged_tick;
    write_json(json);
    return;
  }
  fmt::print("tick {}, hash {}, from tick {}\n", options.tick, hash_text(hash), found.loaded_tick);
  if (found.diverged) fmt::print("another hash than the log's at tick {}\n", found.diverged_tick);
}

int seek(const Games& games, const SeekOptions& options) {
  const bool writable =
      may_write({options.state, options.force}) && may_write({options.svg, options.force});
  if (!writable) return k_unavailable;
  const GameLog log = open_game_log(games, options.file);
  if (log.source == nullptr) return log.exit_code;
  if (!options.svg.empty() && !log.game->draw) {
    complain(fmt::format("--svg: the game '{}' draws no pictures", log.game->name));
    return k_usage;
  }
  const replay::SeekResult found =
      replay::seek(*log.source, log.game->make, options.tick,
                   options.replay ? replay::SeekFrom::beginning : replay::SeekFrom::keyframe);
  if (found.status != Status::ok) {
    complain(fmt::format("{}: {}", options.file, found.what));
    return exit_code_of(found.status);
  }
  print(options, found);
  if (!write_state(options, *found.simulation) || !draw(options, *log.game, *found.simulation)) {
    return k_unavailable;
  }
  return found.diverged ? k_different : k_ok;
}

}  // namespace

void add_seek_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<SeekOptions>();
  CLI::App* command = app.add_subcommand("seek", "Bring a match to a tick, and show or save it");
  command->add_option("file", options->file, "A .lks log")->required();
  command->add_option("tick", options->tick, "The state before this tick")->required();
  command->add_option("--state", options->state,
                      "Write the canonical snapshot into this file, packed");
  command->add_option("--svg", options->svg, "Draw the state into this file");
  add_force_option(*command, options->force);
  command->add_flag("--replay", options->replay, "Use no keyframe but the first");
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, &tool] { tool.exit_code = seek(tool.games, *options); });
}

}  // namespace lockstone::tool
