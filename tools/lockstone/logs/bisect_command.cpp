#include <cstdio>
#include <memory>
#include <string>

#include <fmt/format.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/bisect/bisect.h"
#include "tools/lockstone/logs/log_commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct BisectOptions {
  std::string here;
  std::string there;
  std::string other_program;
  bool json = false;
};

int bisect(const Games& games, const BisectOptions& options) {
  if (options.there.empty() == options.other_program.empty()) {
    complain("bisect takes two logs, or one log and --with PROGRAM");
    return k_usage;
  }
  const BisectReport report = options.there.empty()
                                  ? bisect_builds(games, options.here, options.other_program)
                                  : bisect_logs(games, options.here, options.there);
  if (report.exit_code != k_ok && !report.found) return report.exit_code;
  if (options.json) {
    write_json(report.to_json());
  } else {
    fmt::print("{}\n", report.to_line());
    if (!report.note.empty()) fmt::print("{}\n", report.note);
  }
  return report.exit_code;
}

}  // namespace

std::string BisectReport::to_line() const {
  if (!found) return "no difference";
  std::string line = fmt::format("tick {}", tick);
  if (!stage.empty()) line += ", stage " + stage;
  if (!difference.differs) return line;
  if (difference_tick != tick + 1) {
    line += fmt::format(", at tick {}: ", difference_tick);
  } else {
    line += stage.empty() ? ", " : ", after the tick: ";  // a stage may lie before the whole step
  }
  return line + difference.to_line();
}

nlohmann::ordered_json BisectReport::to_json() const {
  nlohmann::ordered_json json{{"found", found}};
  if (!found) return json;
  json["tick"] = tick;
  if (!stage.empty()) json["stage"] = stage;
  if (difference.differs) {
    json["state_at"] = difference_tick;
    json["store"] = difference.store;
    json["object"] = difference.object;
    json["name"] = difference.name;
    json["field"] = difference.field;
    json["here"] = difference.here;
    json["there"] = difference.there;
  }
  json["note"] = note;
  json["line"] = to_line();
  return json;
}

void add_bisect_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<BisectOptions>();
  CLI::App* command = app.add_subcommand(
      "bisect",
      "Find the first tick, stage, object and field in which two logs or two builds part");
  command->add_option("here", options->here, "A .lks log")->required();
  command->add_option("there", options->there, "Another log of the same match");
  command->add_option("--with", options->other_program,
                      "Another build of this program, to run the log with both");
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, &tool] { tool.exit_code = bisect(tool.games, *options); });
}

}  // namespace lockstone::tool
