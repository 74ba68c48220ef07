#include "tools/lockstone/logs/state/hash_file.h"

#include <filesystem>

#include <fmt/format.h>

#include <lockstone/hash.h>
#include <lockstone/simulation.h>
#include <lockstone/world.h>

#include "core/kernels/target.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

using nlohmann::ordered_json;

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

// The text of a member; empty where it is missing or something else.
std::string text_of(const ordered_json& json, const char* member) {
  const auto found = json.find(member);
  return found != json.end() && found->is_string() ? found->get<std::string>() : std::string();
}

// [[tick, "hash"], …], each tick once and in order.
bool parse_chain(const ordered_json& json, LogHashes& file) {
  const auto chain = json.find("chain");
  if (chain == json.end() || !chain->is_array() || chain->empty()) return false;
  for (const ordered_json& entry : *chain) {
    if (!entry.is_array() || entry.size() != 2 || !entry[0].is_number_unsigned() ||
        !entry[1].is_string()) {
      return false;
    }
    const auto tick = entry[0].get<std::uint64_t>();
    if (!file.hashes.empty() && tick <= file.hashes.rbegin()->first) return false;
    file.hashes[tick] = entry[1].get<std::string>();
  }
  return true;
}

// [{"tick": 64, "bodies": "…", …}, …]; may be missing, for a game without parts.
bool parse_parts(const ordered_json& json, LogHashes& file) {
  const auto list = json.find("parts");
  if (list == json.end()) return true;
  if (!list->is_array()) return false;
  for (const ordered_json& entry : *list) {
    const auto tick = entry.is_object() ? entry.find("tick") : entry.end();
    if (tick == entry.end() || !tick->is_number_unsigned()) return false;
    auto& parts = file.parts[tick->get<std::uint64_t>()];
    for (const auto& [name, hash] : entry.items()) {
      if (name == "tick") continue;
      if (!hash.is_string()) return false;
      parts[name] = hash.get<std::string>();
    }
  }
  return true;
}

}  // namespace

ordered_json machine_json(unsigned format, const std::string& name) {
  return {{"format", format},
          {"name", name.empty() ? processor_text() : name},
          {"processor", processor_text()},
          {"compiler", compiler_text()},
          {"simd", std::string(lanes::current_target())},
          {"abi", k_simulation_abi},
          {"canary", hash_text(canary_hash())}};
}

std::optional<ordered_json> read_hash_file(const std::string& path) {
  const std::optional<std::string> text = read_file(path);
  if (!text) {
    complain(path + ": cannot be read");
    return std::nullopt;
  }
  ordered_json json = ordered_json::parse(*text, nullptr, false);
  const bool of_scenes = json.is_object() && json.contains("scenes") &&
                         json["scenes"].is_object() && !json["scenes"].empty();
  const bool of_log = json.is_object() && json.contains("chain");
  if (of_scenes || of_log) return json;
  complain(path + ": no output of `hash`");
  return std::nullopt;
}

std::optional<LogHashes> parse_log_hashes(const std::string& path, const ordered_json& json) {
  LogHashes file;
  file.path = path;
  file.name = text_of(json, "name");
  file.processor = text_of(json, "processor");
  file.simd = text_of(json, "simd");
  file.game = text_of(json, "game");
  if (json.contains("config")) file.config = text_of(json, "config");
  file.match = text_of(json, "match");
  const std::string states = text_of(json, "states");
  if (!states.empty()) {
    const std::filesystem::path folder(states);
    file.states = (std::filesystem::path(path).parent_path() / folder.filename()).string();
  }
  if (parse_chain(json, file) && parse_parts(json, file)) return file;
  complain(path +
           ": a chain is [[tick, \"hash\"], …], parts are [{\"tick\": …, NAME: \"hash\"}, …]");
  return std::nullopt;
}

std::string state_file(const std::string& folder, std::uint64_t tick) {
  return fmt::format("{}/{}.state", folder, tick);
}

}  // namespace lockstone::tool
