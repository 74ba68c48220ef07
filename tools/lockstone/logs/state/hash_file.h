// The files of `hash`: one machine's hashes of scenes or of a log, for `compare-hashes`.
#pragma once

#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

namespace lockstone::tool {

/// Format 1 holds chains of scenes, format 2 the chain of one log.
inline constexpr unsigned k_scene_hashes_format = 1;
inline constexpr unsigned k_log_hashes_format = 2;

/// The fields that both formats begin with; an empty name is the processor's.
[[nodiscard]] nlohmann::ordered_json machine_json(unsigned format, const std::string& name);

/// One machine's run of one log, as a file holds it.
struct LogHashes {
  using Parts = std::map<std::string, std::string>;  ///< the hash of each part of the state

  std::string path;
  std::string name;  ///< of the machine
  std::string processor;
  std::string simd;
  std::string game;
  std::optional<std::string> config;            ///< hexadecimal; missing where it is long
  std::string match;                            ///< names the log: another match has another
  std::map<std::uint64_t, std::string> hashes;  ///< after the ticks below the key
  std::map<std::uint64_t, Parts> parts;         ///< after the ticks below the key
  std::string states;  ///< folder of kept states, beside the file; empty: none
};

/// A file's JSON, or nothing, with a complaint.
[[nodiscard]] std::optional<nlohmann::ordered_json> read_hash_file(const std::string& path);

/// Nothing, with a complaint, when the fields are not those of format 2.
[[nodiscard]] std::optional<LogHashes> parse_log_hashes(const std::string& path,
                                                        const nlohmann::ordered_json& json);

/// The file of the state after the ticks below `tick`, in the folder.
[[nodiscard]] std::string state_file(const std::string& folder, std::uint64_t tick);

}  // namespace lockstone::tool
