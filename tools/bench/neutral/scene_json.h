// Scenes as JSON, for engines outside of this program.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "tools/bench/neutral/play.h"
#include "tools/bench/neutral/scene.h"

namespace lockstone::bench {

[[nodiscard]] std::string scenes_to_json(std::span<const NeutralScene> scenes);

/// None when `scenes_to_json` does not write such a text.
[[nodiscard]] std::vector<NeutralScene> scenes_from_json(std::string_view text);

/// One line, as runners of other processes print it; see `played_from_json`.
[[nodiscard]] std::string played_to_json(const Played& played);

/// False when the line is none.
[[nodiscard]] bool played_from_json(std::string_view line, Played& played);

}  // namespace lockstone::bench
