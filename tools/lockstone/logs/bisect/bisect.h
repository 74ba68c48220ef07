// Finds the first tick, object and field in which two runs part.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include <lockstone/simulation.h>

#include "tools/tool/games.h"

namespace lockstone::tool {

/// The result of a bisection.
struct BisectReport {
  int exit_code = 0;
  bool found = false;      ///< false: no difference, or an error that was complained about
  std::uint64_t tick = 0;  ///< whose inputs lead to different states
  std::string stage;       ///< of that tick, the first that came to something else; may be empty
  StateDifference difference;  ///< after the tick, or at `difference_tick`
  std::uint64_t difference_tick = 0;
  std::string note;  ///< further remarks

  /// Canonical, at `difference_tick`: of two logs, where both are known; else empty.
  std::vector<std::byte> state_here;
  std::vector<std::byte> state_there;

  /// `tick 1842, body 17 "crate", velocity.y: 0x… here, 0x… there`
  [[nodiscard]] std::string to_line() const;
  [[nodiscard]] nlohmann::ordered_json to_json() const;
};

[[nodiscard]] BisectReport bisect_logs(const Games& games, const std::string& here,
                                       const std::string& there);

/// This build against another one of this program.
[[nodiscard]] BisectReport bisect_builds(const Games& games, const std::string& log,
                                         const std::string& other_program);

}  // namespace lockstone::tool
