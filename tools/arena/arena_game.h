// The arena as a game of the command-line tools.
#pragma once

#include <lockstone/tool.h>

namespace lockstone::arena {

/// Everything but a picture, which would need the renderer.
[[nodiscard]] GameDef arena_game();

}  // namespace lockstone::arena
