// The scenes on a bare world as one game of the command-line tools: nobody plays in them.
#pragma once

#include <lockstone/tool.h>

namespace lockstone::scenes {

[[nodiscard]] GameDef scenes_game();

}  // namespace lockstone::scenes
