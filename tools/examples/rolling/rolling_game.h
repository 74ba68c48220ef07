#pragma once

#include <lockstone/tool.h>

/// The game of the page "How to embed Lockstone", for the command-line tools.
[[nodiscard]] lockstone::GameDef rolling_game();
