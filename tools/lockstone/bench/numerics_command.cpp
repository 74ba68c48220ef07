#include <cstdio>
#include <memory>
#include <optional>
#include <string>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/lockstone/support/output_file.h"
#include "tools/numerics/vectors.h"

namespace lockstone::tool {
namespace {

struct NumericsOptions {
  std::string write_file;
  std::string check_file;
  bool force = false;
  bool json = false;
};

void print_json(const numerics::CheckResult& result) {
  nlohmann::ordered_json json{{"vectors", result.lines},
                              {"functions", numerics::functions().size()},
                              {"different", result.different},
                              {"malformed", result.malformed}};
  if (result.first_line != 0) {
    json["first_difference"] = {
        {"line", result.first_line}, {"file", result.expected}, {"here", result.found}};
  }
  write_json(json);
}

void print_text(const numerics::CheckResult& result) {
  fmt::print("{} vectors, {} different, {} unreadable\n", result.lines, result.different,
             result.malformed);
  if (result.first_line == 0) return;
  fmt::print("line {}\n  file {}\n  here {}\n", result.first_line, result.expected, result.found);
}

/// Without a file, this build reads back its own vectors: every domain holds its own inputs.
int check(const NumericsOptions& options) {
  const std::optional<std::string> text =
      options.check_file.empty() ? numerics::golden_text() : read_file(options.check_file);
  if (!text) {
    complain(fmt::format("{}: cannot be read", options.check_file));
    return k_corrupt;
  }
  const numerics::CheckResult result = numerics::check(*text);
  options.json ? print_json(result) : print_text(result);
  const bool same = result.lines > 0 && result.different + result.malformed == 0;
  return same ? k_ok : k_different;
}

int numerics_command(const NumericsOptions& options) {
  if (options.write_file.empty()) return check(options);
  return write_text_file({options.write_file, options.force}, numerics::golden_text())
             ? k_ok
             : k_unavailable;
}

}  // namespace

void add_numerics_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<NumericsOptions>();
  CLI::App* command = app.add_subcommand("numerics", "Check the numbers against golden vectors");
  CLI::Option* write =
      command->add_option("--write", options->write_file, "Write the vectors to this file");
  command->add_option("--check", options->check_file, "Verify the vectors in this file")
      ->expected(0, 1)
      ->excludes(write);
  add_force_option(*command, options->force);
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, &exit_code] { exit_code = numerics_command(*options); });
}

}  // namespace lockstone::tool
