#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <lockstone/replay/source.h>
#include <lockstone/replay/verifier.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/console.h"
#include "tools/scenes/play.h"

namespace lockstone::tool {
namespace {

using nlohmann::ordered_json;
using replay::VerifyReport;

struct VerifyOptions {
  std::vector<std::string> files;
  bool json = false;
  bool strict = false;
};

ordered_json divergence_json(const replay::Divergence& divergence) {
  ordered_json json{{"tick", divergence.tick},
                    {"expected", hash_text(divergence.expected)},
                    {"actual", hash_text(divergence.actual)}};
  if (divergence.difference) json["difference"] = divergence.difference->to_line();
  return json;
}

ordered_json report_json(const std::string& file, const VerifyReport& report) {
  ordered_json json{{"file", file},
                    {"outcome", to_string(report.outcome)},
                    {"exit_code", exit_code(report.outcome)},
                    {"ticks_verified", report.ticks_verified},
                    {"final_hash", hash_text(report.final_hash)},
                    {"complete", report.complete},
                    {"torn_tail", report.torn_tail},
                    {"line", report.to_line()}};
  if (report.divergence) json["divergence"] = divergence_json(*report.divergence);
  if (report.damage) {
    json["damage"] = {{"offset", report.damage->offset},
                      {"chunk", to_string(report.damage->type)},
                      {"what", report.damage->what}};
  }
  for (const replay::FieldMismatch& mismatch : report.mismatches) {
    json["mismatches"].push_back(
        {{"field", mismatch.field}, {"log", mismatch.log}, {"here", mismatch.here}});
  }
  return json;
}

VerifyReport verify_file(const std::string& file, const VerifyOptions& options) {
  auto source = replay::FileSource::open(file);
  if (!source) {
    VerifyReport report;
    report.outcome = replay::VerifyOutcome::corrupt;
    report.damage = replay::Damage{source.status(), 0, replay::ChunkType::none,
                                   "cannot be opened: " + std::string(to_string(source.status()))};
    return report;
  }
  Progress progress;
  return replay::verify(
      *source.value(), scenes::make_simulation, {.strict = options.strict},
      [&](std::uint64_t ticks, std::uint64_t total) { progress.show(file, ticks, total); });
}

// The worst file decides: a diverged one is news, but one that cannot be judged is no pass either.
int verify(const VerifyOptions& options) {
  int worst = k_ok;
  ordered_json json = ordered_json::array();
  for (const std::string& file : options.files) {
    const VerifyReport report = verify_file(file, options);
    worst = std::max(worst, exit_code(report.outcome));
    if (options.json) {
      json.push_back(report_json(file, report));
    } else {
      fmt::print("{}: {}\n", file, report.to_line());
    }
  }
  if (options.json) fmt::print("{}\n", json.dump(2));
  return worst;
}

}  // namespace

void add_verify_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<VerifyOptions>();
  CLI::App* command =
      app.add_subcommand("verify", "Re-simulate logs and compare the hash of every tick");
  command->add_option("files", options->files, "Logs (.lks)")->required();
  command->add_flag("--json", options->json, "Print JSON");
  command->add_flag("--strict", options->strict, "A log without an end counts as damaged");
  command->callback([options, &exit_code] { exit_code = verify(*options); });
}

}  // namespace lockstone::tool
