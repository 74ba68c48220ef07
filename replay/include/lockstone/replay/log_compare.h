// Compares two logs without simulating anything.
#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lockstone/replay/format.h>
#include <lockstone/replay/source.h>
#include <lockstone/replay/verifier.h>

namespace lockstone::replay {

/// One input in which two logs differ.
struct InputDifference {
  std::uint64_t tick = 0;
  std::uint8_t slot = 0;
  bool in_origin = false;  ///< the bytes are equal, where they came from is not
  std::size_t byte = 0;    ///< first differing byte
  std::uint8_t here = 0;   ///< the byte, or the InputOrigin
  std::uint8_t there = 0;
};

/// The first command that differs, or that one log lacks.
struct CommandDifference {
  struct Side {
    std::uint8_t slot = 0;  ///< of the player that gave it, or k_server_slot
    std::size_t size = 0;   ///< bytes
  };

  std::uint64_t tick = 0;
  std::size_t index = 0;  ///< among the tick's commands
  std::size_t byte = 0;   ///< first differing byte, of two commands
  std::optional<Side> here{};
  std::optional<Side> there{};
};

struct HashDifference {
  std::uint64_t tick = 0;
  std::uint64_t here = 0;
  std::uint64_t there = 0;
};

/// The common part of two logs, and their first difference: `here` is the first, `there` the
/// second.
struct LogComparison {
  std::vector<FieldMismatch> header;  ///< `log` is the first, `here` the second
  bool same_config = true;
  std::uint64_t first_tick = 0;  ///< the ticks that both hold: first_tick …
  std::uint64_t ticks = 0;       ///< … this many
  std::optional<InputDifference> input;
  std::optional<CommandDifference> command;
  std::optional<HashDifference> hash;
  std::uint64_t end_here = 0;  ///< the tick behind the last
  std::uint64_t end_there = 0;
  /// Why less than everything was compared: the first bad status of reading either.
  Status status = Status::ok;
  std::string what;

  [[nodiscard]] bool same() const;

  /// The first tick at which the inputs, the commands or the hashes differ.
  [[nodiscard]] std::optional<std::uint64_t> first_difference() const;
};

/// Compares headers, configurations, and each tick that both logs hold.
[[nodiscard]] LogComparison compare_logs(Source& here, Source& there);

}  // namespace lockstone::replay
