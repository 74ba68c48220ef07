#include <algorithm>
#include <cstdio>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <lockstone/replay/signature.h>
#include <lockstone/replay/source.h>
#include <lockstone/replay/transcript.h>
#include <lockstone/replay/verifier.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

using nlohmann::ordered_json;
using replay::VerifyReport;

struct VerifyOptions {
  std::vector<std::string> files;
  bool json = false;
  bool strict = false;
  unsigned jobs = 0;
  std::string key;
};

ordered_json divergence_json(const replay::Divergence& divergence) {
  ordered_json json{{"tick", divergence.tick},
                    {"expected", hash_text(divergence.expected)},
                    {"actual", hash_text(divergence.actual)}};
  if (divergence.difference) json["difference"] = divergence.difference->to_line();
  return json;
}

/// The verdict on a log's signature, given the expected key or none.
struct SignatureVerdict {
  replay::SignatureState state = replay::SignatureState::none;
  std::string fault;  ///< why it does not pass
};

std::string text_of(const SignatureVerdict& verdict) {
  return verdict.fault.empty() ? std::string(to_string(verdict.state)) : verdict.fault;
}

/// The verdict on one log.
struct LogVerdict {
  VerifyReport report;
  std::string foreign;   ///< in its place: whose log it is
  std::string versions;  ///< beside it: of the game, where they differ

  [[nodiscard]] std::string to_line() const {
    if (!foreign.empty()) return "incompatible: " + foreign;
    const bool tell = report.outcome == replay::VerifyOutcome::incompatible;
    return report.to_line() + (tell ? versions : std::string());
  }
};

ordered_json report_json(const std::string& file, const LogVerdict& verdict,
                         const SignatureVerdict& signature) {
  const VerifyReport& report = verdict.report;
  ordered_json json{{"file", file},
                    {"outcome", to_string(report.outcome)},
                    {"exit_code", exit_code(report.outcome)},
                    {"ticks_verified", report.ticks_verified},
                    {"final_hash", hash_text(report.final_hash)},
                    {"complete", report.complete},
                    {"torn_tail", report.torn_tail},
                    {"line", verdict.to_line()},
                    {"signature", text_of(signature)},
                    {"not_proved", report.not_proved(signature.state)}};
  if (report.complete) {
    json["end"] = to_string(report.end_kind);
    json["transcript"] = replay::to_text(report.transcript);
  }
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

/// Logs of one game, by their places among the files.
struct GameFiles {
  std::vector<std::size_t> places;
  std::vector<replay::SourceOpener> openers;
};

replay::SourceOpener opener_of(const std::string& file) {
  return [&file]() -> Result<std::unique_ptr<replay::Source>> {
    auto source = replay::FileSource::open(file);
    if (!source) return source.status();
    return std::unique_ptr<replay::Source>(std::move(source).value());
  };
}

std::vector<LogVerdict> verify_files(const Games& games, const VerifyOptions& options) {
  std::vector<LogVerdict> verdicts(options.files.size());
  std::map<std::string, GameFiles> by_game;
  for (std::size_t i = 0; i < options.files.size(); ++i) {
    const GameLog log = find_game_log(games, options.files[i]);
    if (log.source == nullptr && log.exit_code == k_incompatible) {
      verdicts[i].report.outcome = replay::VerifyOutcome::incompatible;
      verdicts[i].foreign = log.what;
      continue;
    }
    const GameDef& game = log.game == nullptr ? games.list().front() : *log.game;
    if (log.match.game == game.name && log.match.game_version != game.version) {
      verdicts[i].versions = fmt::format("; the log is of {} {}, this tool plays {}", game.name,
                                         log.match.game_version, game.version);
    }
    GameFiles& files = by_game[game.name];
    files.places.push_back(i);
    files.openers.push_back(opener_of(options.files[i]));
  }
  const unsigned cores = std::max(1U, std::thread::hardware_concurrency());
  Progress progress;
  for (const auto& [name, files] : by_game) {
    std::vector<VerifyReport> reports = replay::verify_all(
        files.openers, games.find(name)->make, {.strict = options.strict},
        options.jobs == 0 ? cores : options.jobs,
        [&](std::uint64_t ticks, std::uint64_t total) { progress.show("verify", ticks, total); });
    for (std::size_t i = 0; i < reports.size(); ++i)
      verdicts[files.places[i]].report = std::move(reports[i]);
  }
  return verdicts;
}

// A log that must be signed must be so to its end. Without a key to expect, a good signature says
// nothing; a bad one says that the log was altered.
SignatureVerdict judge_signature(const std::string& file,
                                 const std::optional<replay::PublicKey>& key) {
  using replay::SignatureState;
  const auto source = replay::FileSource::open(file);
  if (!source) return {};
  const replay::SignatureReport report = replay::check_signatures(*source.value(), key);
  SignatureVerdict verdict{report.state, {}};
  if (!key) {
    if (report.state == SignatureState::good) verdict.state = SignatureState::unchecked;
    if (report.state == SignatureState::bad) verdict.fault = "signature: bad";
  } else if (report.state != SignatureState::good) {
    verdict.fault = fmt::format("signature: {}", to_string(report.state));
  } else if (!report.covers_end) {
    verdict.fault = fmt::format("signature: covers {} ticks and no end", report.covered_ticks);
  }
  return verdict;
}

void print_text(const std::string& file, const LogVerdict& verdict,
                const SignatureVerdict& signature) {
  fmt::print("{}: {}{}{}\n", file, verdict.to_line(), signature.fault.empty() ? "" : "; ",
             signature.fault);
  for (const std::string& line : verdict.report.not_proved(signature.state))
    fmt::print("  {}\n", line);
}

// The worst file decides: a diverged one is news, but one that cannot be judged is no pass either.
int verify(const Games& games, const VerifyOptions& options) {
  std::optional<replay::PublicKey> key;
  if (!options.key.empty()) {
    key = read_public_key(options.key);
    if (!key) return k_usage;
  }
  const std::vector<LogVerdict> verdicts = verify_files(games, options);
  int worst = k_ok;
  ordered_json json = ordered_json::array();
  for (std::size_t i = 0; i < verdicts.size(); ++i) {
    const std::string& file = options.files[i];
    const SignatureVerdict signature = judge_signature(file, key);
    const int signature_code = signature.fault.empty() ? k_ok : k_corrupt;
    worst = std::max({worst, exit_code(verdicts[i].report.outcome), signature_code});
    if (options.json) {
      json.push_back(report_json(file, verdicts[i], signature));
    } else {
      print_text(file, verdicts[i], signature);
    }
  }
  if (options.json) write_json(json);
  return worst;
}

}  // namespace

void add_verify_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<VerifyOptions>();
  CLI::App* command =
      app.add_subcommand("verify", "Re-simulate logs and compare the hash of every tick");
  command->add_option("files", options->files, "Logs (.lks)")->required();
  command->add_flag("--json", options->json, "Print JSON");
  command->add_flag("--strict", options->strict, "A log without an end counts as damaged");
  command->add_option("--jobs", options->jobs, "Threads; 0: one for each core")
      ->capture_default_str();
  command->add_option("--key", options->key,
                      "A public key: the log must be signed with it, up to its end");
  command->callback([options, &tool] { tool.exit_code = verify(tool.games, *options); });
}

}  // namespace lockstone::tool
