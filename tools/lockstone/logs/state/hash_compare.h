// Where the runs of one log on several machines part, and into which groups.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <lockstone/simulation.h>

#include "tools/lockstone/logs/state/hash_file.h"
#include "tools/tool/games.h"

namespace lockstone::tool {

/// Machines with equal hashes after the first tick that differs, the largest group first.
struct HashGroup {
  std::vector<std::size_t> files;
  std::string hash;  ///< after that tick; "ends" where the chain is shorter
};

struct HashComparison {
  std::vector<HashGroup> groups;  ///< one: all are equal
  std::uint64_t ticks = 0;        ///< compared, up to the first that differs
  std::uint64_t first_tick = 0;   ///< whose inputs led to different states; with several groups
  std::string part;               ///< of the state, the first that differs; empty: not known
  std::uint64_t part_tick = 0;    ///< the state that it was found in
  std::optional<StateDifference> field;  ///< between the first two groups, where states were kept
  std::uint64_t field_tick = 0;          ///< the state that it was found in
  std::string note;                      ///< why part or field are not known

  [[nodiscard]] bool same() const { return groups.size() == 1; }
  /// `tick 241, part bodies (state at 256), body 17, velocity.y: 0x… in A, 0x… in B (state at
  /// 256)`, or "all equal, 600 ticks".
  [[nodiscard]] std::string to_line() const;
};

/// Two or more files of one match.
[[nodiscard]] HashComparison compare_log_hashes(const std::vector<LogHashes>& files,
                                                const Games& games);

}  // namespace lockstone::tool
