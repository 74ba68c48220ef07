#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <lockstone/replay/log_compare.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/logs/log_commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

using replay::LogComparison;

struct DiffOptions {
  std::string here;
  std::string there;
  bool json = false;
};

std::string input_text(const replay::InputDifference& input) {
  return fmt::format("tick {}, player {}, {}: {:#04x} here, {:#04x} there", input.tick, input.slot,
                     input.in_origin ? std::string("origin") : fmt::format("byte {}", input.byte),
                     input.here, input.there);
}

std::string side_text(const std::optional<replay::CommandDifference::Side>& side) {
  if (!side) return "none";
  const std::string giver =
      side->slot == k_server_slot ? "the server" : fmt::format("player {}", side->slot);
  return fmt::format("{} bytes of {}", side->size, giver);
}

std::string command_text(const replay::CommandDifference& command) {
  return fmt::format(
      "tick {}, command {}{}: {} here, {} there", command.tick, command.index,
      command.here && command.there ? fmt::format(", byte {}", command.byte) : std::string(),
      side_text(command.here), side_text(command.there));
}

std::string hash_line(const replay::HashDifference& hash) {
  return fmt::format("tick {}: {} here, {} there", hash.tick, hash_text(hash.here),
                     hash_text(hash.there));
}

void print_json(const LogComparison& comparison) {
  nlohmann::ordered_json json{
      {"same", comparison.same()},           {"same_config", comparison.same_config},
      {"first_tick", comparison.first_tick}, {"ticks", comparison.ticks},
      {"end_here", comparison.end_here},     {"end_there", comparison.end_there}};
  for (const replay::FieldMismatch& field : comparison.header) {
    json["header"].push_back({{"field", field.field}, {"here", field.log}, {"there", field.here}});
  }
  if (comparison.input) json["input"] = input_text(*comparison.input);
  if (comparison.command) json["command"] = command_text(*comparison.command);
  if (comparison.hash) json["hash"] = hash_line(*comparison.hash);
  write_json(json);
}

void print_text(const LogComparison& comparison) {
  for (const replay::FieldMismatch& field : comparison.header)
    fmt::print("header   {}: {} here, {} there\n", field.field, field.log, field.here);
  if (!comparison.same_config) fmt::print("config   differs\n");
  if (comparison.input) fmt::print("input    {}\n", input_text(*comparison.input));
  if (comparison.command) fmt::print("command  {}\n", command_text(*comparison.command));
  if (comparison.hash) fmt::print("hash     {}\n", hash_line(*comparison.hash));
  if (comparison.end_here != comparison.end_there) {
    fmt::print("end      tick {} here, {} there\n", comparison.end_here, comparison.end_there);
  }
  fmt::print("{} ticks compared{}\n", comparison.ticks,
             comparison.same() ? ": the same match" : "");
}

int diff(const DiffOptions& options) {
  const auto here = open_log(options.here), there = open_log(options.there);
  if (here == nullptr || there == nullptr) return k_corrupt;
  const LogComparison comparison = replay::compare_logs(*here, *there);
  if (comparison.status != Status::ok && comparison.status != Status::truncated) {
    complain(comparison.what);
    return exit_code_of(comparison.status);
  }
  options.json ? print_json(comparison) : print_text(comparison);
  return comparison.same() ? k_ok : k_different;
}

}  // namespace

void add_diff_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<DiffOptions>();
  CLI::App* command = app.add_subcommand(
      "diff", "Compare the inputs, the commands of players and the hashes of two logs");
  command->add_option("here", options->here, "A .lks log")->required();
  command->add_option("there", options->there, "Another one")->required();
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, &tool] { tool.exit_code = diff(*options); });
}

}  // namespace lockstone::tool
