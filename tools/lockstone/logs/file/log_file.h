// Helpers of the subcommands that read and write logs.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>

#include <lockstone/replay/format.h>
#include <lockstone/replay/signature.h>
#include <lockstone/replay/sink.h>
#include <lockstone/replay/source.h>
#include <lockstone/status.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/output_file.h"
#include "tools/tool/games.h"

namespace lockstone::tool {

/// The exit code for a log that cannot be read at all.
[[nodiscard]] inline int exit_code_of(Status status) {
  const bool foreign = status == Status::unsupported_version || status == Status::incompatible;
  return foreign ? k_incompatible : k_corrupt;
}

/// Null, with a complaint, when it cannot be opened, or may not be made.
[[nodiscard]] std::unique_ptr<replay::FileSource> open_log(const std::string& path);

/// A log and the game that plays it.
struct GameLog {
  std::unique_ptr<replay::FileSource> source;  ///< null: it cannot be opened, or `game` is null
  const GameDef* game = nullptr;
  replay::MatchMetadata match;  ///< of the header, where that can be read
  std::string what;             ///< why there is no source
  int exit_code = k_ok;         ///< then
};

/// A log whose header cannot be read gets the first game: a reader of the rest finds the damage.
[[nodiscard]] GameLog find_game_log(const Games& games, const std::string& path);

/// The same, with a complaint when there is no source.
[[nodiscard]] GameLog open_game_log(const Games& games, const std::string& path);

/// In its place from the beginning, so that a recorder that is killed leaves a log.
[[nodiscard]] std::unique_ptr<replay::FileSink> create_log(const Output& output);

/// From the system's randomness: a log is that of one match.
[[nodiscard]] std::uint64_t random_match_id();

/// The key in a key file, or nothing after printing an error. Made by `lockstone keygen`.
[[nodiscard]] std::optional<replay::SigningKey> read_signing_key(const std::string& path);
[[nodiscard]] std::optional<replay::PublicKey> read_public_key(const std::string& path);

}  // namespace lockstone::tool
