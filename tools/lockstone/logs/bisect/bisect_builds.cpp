#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include <fmt/format.h>
#include <unistd.h>

#include <lockstone/replay/seek.h>
#include <lockstone/replay/snapshot_file.h>

#include "tools/lockstone/logs/bisect/bisect.h"
#include "tools/lockstone/logs/bisect/trace.h"
#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/logs/state/canonical_bytes.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

std::string quoted(const std::string& text) {
  std::string result = "'";
  for (const char letter : text)
    result += letter == '\'' ? std::string("'\\''") : std::string(1, letter);
  return result + '\'';
}

// Another build of this program. `program` may begin with an emulator, so the shell splits it.
class OtherBuild {
 public:
  explicit OtherBuild(std::string program, std::string log)
      : program_(std::move(program)), log_(std::move(log)) {}

  /// The JSON that it prints; nothing, with a complaint, when it fails.
  [[nodiscard]] std::optional<nlohmann::json> ask(const std::string& command,
                                                  const std::string& options) const {
    const std::string line = program_ + ' ' + command + ' ' + quoted(log_) + ' ' + options;
    std::FILE* pipe = popen(line.c_str(), "r");
    if (pipe == nullptr) return std::nullopt;
    std::string text(1U << 16, '\0'), all;
    for (std::size_t bytes = 1; bytes > 0;) {
      bytes = std::fread(text.data(), 1, text.size(), pipe);
      all.append(text, 0, bytes);
    }
    const int status = pclose(pipe);
    nlohmann::json answer = nlohmann::json::parse(all, nullptr, false);
    if (!answer.is_discarded()) return answer;
    complain(fmt::format("`{}` answered nothing that can be read (status {})", line, status));
    return std::nullopt;
  }

 private:
  std::string program_;
  std::string log_;
};

std::optional<std::vector<std::uint64_t>> hashes_of(const std::optional<nlohmann::json>& trace) {
  if (!trace || !trace->contains("hashes")) return std::nullopt;
  std::vector<std::uint64_t> hashes;
  for (const nlohmann::json& hash : trace->at("hashes")) {
    if (!hash.is_string()) return std::nullopt;
    hashes.push_back(std::strtoull(hash.get_ref<const std::string&>().c_str(), nullptr, 16));
  }
  return hashes;
}

// A file that is removed at the end.
class TemporaryFile {
 public:
  TemporaryFile()
      : path_(
            (std::filesystem::temp_directory_path() / fmt::format("lockstone-{}.state", ::getpid()))
                .string()) {
    std::error_code ignored;  // of a process of this number that was killed
    std::filesystem::remove(path_, ignored);
  }
  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;
  ~TemporaryFile() {
    std::error_code ignored;
    std::filesystem::remove(path_, ignored);
  }
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;
};

StageTrace stages_from(const std::optional<nlohmann::json>& answer) {
  StageTrace stages;
  if (!answer || !answer->is_array()) return stages;
  for (const nlohmann::json& stage : *answer) {
    if (!stage.is_object()) return {};
    const std::string digest = stage.value("digest", "");
    stages.push_back({stage.value("stage", ""), std::strtoull(digest.c_str(), nullptr, 16)});
  }
  return stages;
}

// Describes the difference of the two builds' states after the tick.
bool describe(const GameLog& log, const OtherBuild& other, BisectReport& report) {
  const std::uint64_t after = report.tick + 1;
  const replay::SeekResult found =
      replay::seek(*log.source, log.game->make, after, replay::SeekFrom::beginning);
  const TemporaryFile state;
  const auto answer =
      other.ask("seek", fmt::format("{} --replay --json --state {}", after, quoted(state.path())));
  const std::optional<std::string> there = read_file(state.path());
  if (found.status != Status::ok || !answer || !there) return false;
  const auto unpacked = replay::unpack_snapshot(std::as_bytes(std::span(*there)));
  if (!unpacked.ok()) return false;
  report.difference =
      found.simulation->describe(canonical_bytes(*found.simulation), unpacked.value());
  report.difference_tick = after;
  return true;
}

BisectReport failed(int exit_code) {
  BisectReport report;
  report.exit_code = exit_code;
  return report;
}

}  // namespace

BisectReport bisect_builds(const Games& games, const std::string& log,
                           const std::string& other_program) {
  const GameLog opened = open_game_log(games, log);
  if (opened.source == nullptr) return failed(opened.exit_code);
  const OtherBuild other(other_program, log);
  const Result<Trace> here = trace_log(opened);
  if (!here) return failed(exit_code_of(here.status()));
  const auto there = hashes_of(other.ask("trace", ""));
  if (!there) return failed(k_incompatible);
  const auto [first, unused] = std::mismatch(here.value().hashes.begin(), here.value().hashes.end(),
                                             there->begin(), there->end());
  static_cast<void>(unused);
  BisectReport report;
  const auto ticks = static_cast<std::uint64_t>(first - here.value().hashes.begin());
  report.note = fmt::format("{} ticks are the same in both; of the recorded hashes, {} here", ticks,
                            here.value().agreed);
  if (first == here.value().hashes.end()) return report;
  report.exit_code = k_different;
  report.found = true;
  report.tick = here.value().first_tick + ticks;
  const std::optional<StageTrace> stages = stages_of(opened, report.tick);
  const auto others = stages_from(other.ask("trace", fmt::format("--stages {}", report.tick)));
  if (stages) report.stage = first_difference(*stages, others);
  if (!describe(opened, other, report)) report.note += "; the states could not be compared";
  return report;
}

}  // namespace lockstone::tool
