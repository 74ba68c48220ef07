// compare-hashes: compares the files of several machines' `hash`.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/log_commands.h"
#include "tools/lockstone/logs/state/hash_compare.h"
#include "tools/lockstone/logs/state/hash_file.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

using nlohmann::ordered_json;

struct CompareOptions {
  std::vector<std::string> paths;
  std::vector<std::string> expected;  ///< names of machines
  bool json = false;
  bool markdown = false;
};

struct HashFile {
  std::string path;
  ordered_json json;
};

// Where two chains part; −1 when they do not.
std::ptrdiff_t first_difference(const ordered_json& here, const ordered_json& there) {
  for (std::size_t i = 0; i < std::max(here.size(), there.size()); ++i) {
    if (i >= here.size() || i >= there.size() || here[i] != there[i]) {
      return static_cast<std::ptrdiff_t>(i);
    }
  }
  return -1;
}

// A member's text; empty where it is missing or something else.
std::string member(const HashFile& file, const char* name) {
  const auto found = file.json.find(name);
  return found != file.json.end() && found->is_string() ? found->get<std::string>() : "";
}

// The expected machines of which there is no file.
std::vector<std::string> missing_of(const CompareOptions& options,
                                    const std::vector<HashFile>& files) {
  std::vector<std::string> missing;
  for (const std::string& name : options.expected) {
    const auto is_of = [&](const HashFile& file) { return member(file, "name") == name; };
    if (std::ranges::none_of(files, is_of)) missing.push_back(name);
  }
  return missing;
}

// The complaints about one file of scenes, held against the first.
std::size_t compare_scenes(const HashFile& first, const HashFile& file) {
  std::size_t complaints = 0;
  const auto differs = [&](const std::string& what) {
    fmt::print("{}: {}\n", file.path, what);
    ++complaints;
  };
  for (const char* field : {"abi", "canary"}) {
    const ordered_json here = first.json.value(field, ordered_json());
    const ordered_json there = file.json.value(field, ordered_json());
    if (here == there) continue;
    differs(fmt::format("{} {} there, {} in {}", field, there.dump(), here.dump(), first.path));
  }
  for (const auto& [scene, chain] : first.json["scenes"].items()) {
    if (!file.json["scenes"].contains(scene)) {
      differs(scene + ": missing");
      continue;
    }
    const std::ptrdiff_t place = first_difference(chain, file.json["scenes"][scene]);
    if (place >= 0) differs(fmt::format("{}: differs by tick {}", scene, 10 * (place + 1)));
  }
  if (file.json["scenes"].size() > first.json["scenes"].size()) {
    differs(fmt::format("has scenes that {} lacks", first.path));
  }
  return complaints;
}

int compare_scene_files(const std::vector<HashFile>& files) {
  std::size_t complaints = 0;
  for (const HashFile& file : files) {
    const std::size_t found = compare_scenes(files.front(), file);
    complaints += found;
    fmt::print("{:<24} {:<10} {:<8} {}\n", member(file, "name"), member(file, "processor"),
               member(file, "simd"), found == 0 ? "equal" : "DIFFERENT");
  }
  fmt::print("{} scenes, {} machines: {}\n", files.front().json["scenes"].size(), files.size(),
             complaints == 0 ? "all equal" : fmt::format("{} differences", complaints));
  return complaints == 0 ? k_ok : k_different;
}

// "A", "B", …, "Z", "27", …
std::string letter_of(std::size_t group) {
  if (group < 26) return std::string(1, static_cast<char>('A' + group));
  return std::to_string(group + 1);
}

std::string group_of(const HashComparison& comparison, std::size_t file) {
  for (std::size_t i = 0; i < comparison.groups.size(); ++i)
    if (std::ranges::count(comparison.groups[i].files, file) > 0) return letter_of(i);
  return {};
}

void print_table(const std::vector<LogHashes>& files, const HashComparison& comparison,
                 bool markdown) {
  const char* row = markdown ? "| {} | {} | {} | {} | {} |\n" : "{:<24} {:<10} {:<8} {:>7} {}\n";
  fmt::print(fmt::runtime(row), "machine", "processor", "simd", "ticks", "group");
  if (markdown) fmt::print("|---|---|---|---|---|\n");
  for (std::size_t i = 0; i < files.size(); ++i) {
    fmt::print(fmt::runtime(row), files[i].name, files[i].processor, files[i].simd,
               files[i].hashes.size(), group_of(comparison, i));
  }
  fmt::print("{}{}\n", markdown ? "\n" : "", comparison.to_line());
  if (!comparison.note.empty()) fmt::print("{}{}\n", markdown ? "\n" : "", comparison.note);
}

ordered_json comparison_json(const std::vector<LogHashes>& files, const HashComparison& comparison,
                             const std::vector<std::string>& missing) {
  ordered_json json{{"same", comparison.same()}, {"equal_ticks", comparison.ticks}};
  if (!missing.empty()) json["missing"] = missing;
  for (const HashGroup& group : comparison.groups) {
    ordered_json names = ordered_json::array();
    for (const std::size_t file : group.files)
      names.push_back(files[file].name);
    json["groups"].push_back({{"hash", group.hash}, {"machines", names}});
  }
  if (!comparison.same()) json["tick"] = comparison.first_tick;
  if (!comparison.part.empty()) {
    json["part"] = comparison.part;
    json["part_at"] = comparison.part_tick;
  }
  if (comparison.field) {
    json["state_at"] = comparison.field_tick;
    json["store"] = comparison.field->store;
    json["object"] = comparison.field->object;
    json["field"] = comparison.field->field;
    json["a"] = comparison.field->here;
    json["b"] = comparison.field->there;
  }
  if (!comparison.note.empty()) json["note"] = comparison.note;
  json["line"] = comparison.to_line();
  return json;
}

int compare_log_files(const Games& games, const CompareOptions& options,
                      const std::vector<HashFile>& read, const std::vector<std::string>& missing) {
  std::vector<LogHashes> files;
  for (const HashFile& file : read) {
    std::optional<LogHashes> hashes = parse_log_hashes(file.path, file.json);
    if (!hashes) return k_corrupt;
    files.push_back(std::move(*hashes));
    if (files.back().match == files.front().match) continue;
    complain(fmt::format("{}: of another match than {}", file.path, read.front().path));
    return k_incompatible;
  }
  const HashComparison comparison = compare_log_hashes(files, games);
  if (options.json) {
    write_json(comparison_json(files, comparison, missing));
  } else {
    print_table(files, comparison, options.markdown);
  }
  return comparison.same() ? k_ok : k_different;
}

int compare_hashes(const Games& games, const CompareOptions& options) {
  if (options.paths.size() < 2 && options.expected.empty()) {
    complain("compare-hashes takes two or more files");
    return k_usage;
  }
  std::vector<HashFile> files;
  std::size_t of_logs = 0;
  for (const std::string& path : options.paths) {
    std::optional<ordered_json> json = read_hash_file(path);
    if (!json) continue;
    of_logs += json->contains("chain") ? 1U : 0U;
    files.push_back({path, std::move(*json)});
  }
  if (files.size() != options.paths.size()) return k_corrupt;
  if (of_logs != 0 && of_logs != files.size()) {
    complain("some files hold hashes of scenes and others those of a log");
    return k_incompatible;
  }
  const std::vector<std::string> missing = missing_of(options, files);
  const int code =
      of_logs == 0 ? compare_scene_files(files) : compare_log_files(games, options, files, missing);
  for (const std::string& name : missing)
    complain(fmt::format("--expect {}: no file is of this machine", name));
  return code == k_ok && !missing.empty() ? k_corrupt : code;
}

}  // namespace

void add_compare_hashes_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<CompareOptions>();
  CLI::App* command =
      app.add_subcommand("compare-hashes", "Compare the output of several machines' `hash`");
  command->add_option("files", options->paths, "JSON files, two or more; one with --expect")
      ->required()
      ->expected(1, -1);
  command->add_option("--expect", options->expected,
                      "Names of the machines of which there must be a file");
  CLI::Option* json = command->add_flag("--json", options->json, "Print JSON (of logs)");
  command->add_flag("--markdown", options->markdown, "Print a table for a page (of logs)")
      ->excludes(json);
  command->callback([options, &tool] { tool.exit_code = compare_hashes(tool.games, *options); });
}

}  // namespace lockstone::tool
