// `bench speed --instructions` and `--compare`.
#pragma once

#include <string>
#include <vector>

#include "tools/bench/speed/speed_scene.h"
#include "tools/lockstone/support/output_file.h"

namespace lockstone::tool {

/// Counts a hundredth of each scene's ticks, at least three, or `ticks`, into a file. An exit code.
[[nodiscard]] int write_instructions(const std::vector<const bench::SpeedScene*>& scenes,
                                     std::uint32_t ticks, const Output& output);

/// Counts a file's scenes again and prints both figures: k_different when a scene takes over a
/// fiftieth more.
[[nodiscard]] int compare_instructions(const std::string& path);

}  // namespace lockstone::tool
