#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <nlohmann/json.hpp>

#include <lockstone/replay/seek.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/bisect/trace.h"
#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/logs/log_commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

void print_hashes(const Trace& trace) {
  nlohmann::ordered_json json{{"first_tick", trace.first_tick}};
  nlohmann::ordered_json hashes = nlohmann::ordered_json::array();
  for (const std::uint64_t hash : trace.hashes)
    hashes.push_back(hash_text(hash));
  json["hashes"] = std::move(hashes);
  write_json(json, 1);
}

// Prints the hashes after the stages of one tick.
int print_stages(const GameLog& log, std::uint64_t tick) {
  const std::optional<StageTrace> stages = stages_of(log, tick);
  if (!stages) return k_corrupt;
  nlohmann::ordered_json json = nlohmann::ordered_json::array();
  for (const StageDigest& stage : *stages)
    json.push_back({{"stage", stage.name}, {"digest", hash_text(stage.digest)}});
  write_json(json, 1);
  return k_ok;
}

int trace(const Games& games, const std::string& file,
          const std::optional<std::uint64_t>& stages_at) {
  const GameLog log = open_game_log(games, file);
  if (log.source == nullptr) return log.exit_code;
  if (stages_at) return print_stages(log, *stages_at);
  const Result<Trace> trace = trace_log(log);
  if (!trace) return exit_code_of(trace.status());
  print_hashes(trace.value());
  return k_ok;
}

}  // namespace

std::optional<StageTrace> stages_of(const GameLog& log, std::uint64_t tick) {
  replay::SeekResult found =
      replay::seek(*log.source, log.game->make, tick, replay::SeekFrom::beginning);
  if (found.status == Status::ok && found.ticks->next())
    return step_traced(*log.game, *found.simulation, *found.ticks);
  complain(found.what.empty() ? "the log ends before that tick" : found.what);
  return std::nullopt;
}

Result<Trace> trace_log(const GameLog& log) {
  replay::LogReader header(*log.source);
  if (const Status status = header.open(); status != Status::ok) return status;
  const std::uint64_t first = header.header().match.start_tick;
  replay::SeekResult found =
      replay::seek(*log.source, log.game->make, first, replay::SeekFrom::beginning);
  if (found.status != Status::ok) {
    complain(found.what);
    return found.status;
  }
  Trace trace{.first_tick = first, .hashes = {}, .agreed = 0};
  Progress progress;
  bool agrees = true;
  while (found.ticks->next()) {
    progress.show("trace", trace.hashes.size(), 0);
    step_tick(*found.simulation, found.ticks->inputs(), found.ticks->commands());
    trace.hashes.push_back(found.simulation->hash());
    agrees = agrees && trace.hashes.back() == found.ticks->hash();
    trace.agreed += agrees ? 1U : 0U;
  }
  return trace;
}

void add_trace_command(CLI::App& app, Tool& tool) {
  auto file = std::make_shared<std::string>();
  auto stages_at = std::make_shared<std::optional<std::uint64_t>>();
  CLI::App* command = app.add_subcommand(
      "trace", "Print, as JSON, the hash that this build computes for each tick of a log");
  command->add_option("file", *file, "A .lks log")->required();
  command->add_option("--stages", *stages_at, "Instead, the hashes after each stage of this tick");
  command->callback(
      [file, stages_at, &tool] { tool.exit_code = trace(tool.games, *file, *stages_at); });
}

}  // namespace lockstone::tool
