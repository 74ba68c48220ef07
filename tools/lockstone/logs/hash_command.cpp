// hash, compare-hashes: writes one machine's hashes to a file, and compares such files.
#include <algorithm>
#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "core/kernels/target.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/logs/log_commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/lockstone/support/options.h"
#include "tools/scenes/play.h"

namespace lockstone::tool {
namespace {

using nlohmann::ordered_json;

struct HashOptions {
  std::string suite = "golden";
  std::string name;
};

std::string compiler_text() {
#if defined(__clang__)
  return "clang " __clang_version__;
#elif defined(__GNUC__)
  return "gcc " __VERSION__;
#else
  return "unknown compiler";
#endif
}

std::string processor_text() {
#if defined(__EMSCRIPTEN__)
  return "wasm32";
#elif defined(__x86_64__)
  return "x86-64";
#elif defined(__i386__)
  return "i386";
#elif defined(__aarch64__)
  return "aarch64";
#elif defined(__arm__)
  return "arm";
#elif defined(__riscv)
  return "riscv";
#elif defined(__s390x__)
  return "s390x";
#else
  return "unknown processor";
#endif
}

// All hashes on the way of a golden scene.
ordered_json chain_of(const scenes::SceneSummary& scene) {
  ordered_json chain = ordered_json::array();
  const auto play = scenes::make_play(scene.name, 1);
  for (std::uint32_t tick = 1; tick <= scene.golden_ticks; ++tick) {
    play.value()->step();
    if (tick % 10 == 0 || tick == scene.golden_ticks) {
      chain.push_back(hash_text(play.value()->simulation().hash()));
    }
  }
  return chain;
}

int hash(const HashOptions& options) {
  ordered_json json{{"format", 1},
                    {"suite", options.suite},
                    {"name", options.name.empty() ? processor_text() : options.name},
                    {"processor", processor_text()},
                    {"compiler", compiler_text()},
                    {"simd", std::string(lanes::current_target())},
                    {"abi", k_simulation_abi},
                    {"canary", hash_text(canary_hash())}};
  Progress progress;
  const std::vector<scenes::SceneSummary> list = scenes::list_scenes();
  for (std::size_t i = 0; i < list.size(); ++i) {
    progress.show(std::string(list[i].name), i, list.size());
    json["scenes"][std::string(list[i].name)] = chain_of(list[i]);
  }
  progress.clear();
  write_json(json, 1);
  return k_ok;
}

struct HashFile {
  std::string path;
  ordered_json json;
};

std::vector<HashFile> read_files(const std::vector<std::string>& paths, bool& readable) {
  std::vector<HashFile> files;
  for (const std::string& path : paths) {
    const std::optional<std::string> text = read_file(path);
    ordered_json json = ordered_json::parse(text.value_or(""), nullptr, false);
    if (json.is_object() && json.contains("scenes") && json["scenes"].is_object() &&
        !json["scenes"].empty()) {
      files.push_back({path, std::move(json)});
      continue;
    }
    complain(
        fmt::format("{}: {}", path, text ? "no output of `lockstone hash`" : "cannot be read"));
    readable = false;
  }
  return files;
}

// Where two chains part; −1 when they do not.
std::ptrdiff_t first_difference(const ordered_json& here, const ordered_json& there) {
  for (std::size_t i = 0; i < std::max(here.size(), there.size()); ++i) {
    if (i >= here.size() || i >= there.size() || here[i] != there[i]) {
      return static_cast<std::ptrdiff_t>(i);
    }
  }
  return -1;
}

// The complaints about one file, held against the first.
std::size_t compare(const HashFile& first, const HashFile& file) {
  std::size_t complaints = 0;
  const auto differs = [&](const std::string& what) {
    fmt::print("{}: {}\n", file.path, what);
    ++complaints;
  };
  for (const char* field : {"abi", "canary"}) {
    if (first.json.value(field, ordered_json()) == file.json.value(field, ordered_json())) continue;
    differs(fmt::format("{} {} there, {} in {}", field,
                        file.json.value(field, ordered_json()).dump(),
                        first.json.value(field, ordered_json()).dump(), first.path));
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

int compare_hashes(const std::vector<std::string>& paths) {
  bool readable = true;
  const std::vector<HashFile> files = read_files(paths, readable);
  if (!readable) return k_corrupt;
  std::size_t complaints = 0;
  for (const HashFile& file : files) {
    const std::size_t found = compare(files.front(), file);
    complaints += found;
    fmt::print("{:<24} {:<10} {:<8} {}\n", file.json.value("name", ""),
               file.json.value("processor", ""), file.json.value("simd", ""),
               found == 0 ? "equal" : "DIFFERENT");
  }
  fmt::print("{} scenes, {} machines: {}\n", files.front().json["scenes"].size(), files.size(),
             complaints == 0 ? "all equal" : fmt::format("{} differences", complaints));
  return complaints == 0 ? k_ok : k_different;
}

}  // namespace

void add_hash_command(CLI::App& app, int& exit_code) {
  auto options = std::make_shared<HashOptions>();
  CLI::App* command = app.add_subcommand(
      "hash", "Print, as JSON, the hashes that this machine computes, for `compare-hashes`");
  command->add_option("--suite", options->suite, "Which scenes: golden")
      ->capture_default_str()
      ->check(CLI::IsMember({"golden"}));
  command->add_option("--name", options->name, "Of the machine, for the table");
  add_simd_option(*command);
  command->callback([options, &exit_code] { exit_code = hash(*options); });
}

void add_compare_hashes_command(CLI::App& app, int& exit_code) {
  auto paths = std::make_shared<std::vector<std::string>>();
  CLI::App* command =
      app.add_subcommand("compare-hashes", "Compare the output of several machines' `hash`");
  command->add_option("files", *paths, "JSON files, two or more")->required()->expected(2, -1);
  command->callback([paths, &exit_code] { exit_code = compare_hashes(*paths); });
}

}  // namespace lockstone::tool
