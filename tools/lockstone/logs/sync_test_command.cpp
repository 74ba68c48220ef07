// sync-test: steps a match beside a copy that knows nothing but the saved bytes.
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/log_commands.h"
#include "tools/lockstone/logs/state/sync_test.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/tool/start_match.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct SyncTestOptions {
  StartOptions start;
  std::uint64_t ticks = 300;
  std::string forget;
  bool json = false;
};

int report(const SyncTestOptions& options, std::uint64_t tick, const std::string& difference) {
  if (options.json) {
    nlohmann::ordered_json json{{"same", difference.empty()}, {"ticks", tick}};
    if (!difference.empty()) json["difference"] = difference;
    write_json(json);
  } else if (difference.empty()) {
    fmt::print("{} ticks: the saved bytes are the whole state\n", tick);
  } else {
    fmt::print("tick {}: a saved and loaded copy went another way: {}\n", tick, difference);
  }
  return difference.empty() ? k_ok : k_different;
}

int sync_test(const Games& games, const SyncTestOptions& options) {
  std::optional<Match> match = start_match(games, options.start);
  if (!match) return k_usage;
  Result<std::unique_ptr<Simulation>> copy = match->game->make(match->config);
  if (!copy) return k_usage;
  SyncTest test(*match->game, *match->simulation, std::move(copy).value(), options.forget);
  MatchInputs inputs(*match->game, options.start.seed);
  Progress progress;
  for (std::uint64_t tick = 1; tick <= options.ticks; ++tick) {
    progress.show("sync-test", tick, options.ticks);
    const std::string difference = test.step(inputs.next(*match->simulation));
    progress.clear();
    if (!difference.empty()) return report(options, tick, difference);
  }
  if (!options.forget.empty() && test.forgotten() == 0) {
    complain(fmt::format("no field {} of a world that is not zero", options.forget));
    return k_usage;
  }
  return report(options, options.ticks, {});
}

}  // namespace

void add_sync_test_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<SyncTestOptions>();
  CLI::App* command = app.add_subcommand(
      "sync-test", "Each tick, also step a copy loaded from the saved state, and compare");
  add_start_options(*command, tool.games, options->start);
  command->add_option("--ticks", options->ticks, "Ticks to play")->capture_default_str();
  command->add_option(
      "--forget", options->forget,
      "As if `save` left out this field of the world (body.spin.x): it must differ");
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, &tool] { tool.exit_code = sync_test(tool.games, *options); });
}

}  // namespace lockstone::tool
