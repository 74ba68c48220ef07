// Games in shared libraries: see lockstone/game_abi.h.
#pragma once

#include <string>

#include <lockstone/game_abi.h>
#include <lockstone/status.h>
#include <lockstone/tool.h>

namespace lockstone::tool {

/// Loads the library for the rest of the process. On an error, `why` names the fault:
/// io_error, no such file or symbol; unsupported_version, a table of another ABI; malformed, a
/// required function is missing; incompatible, this build loads no libraries.
[[nodiscard]] Result<GameDef> load_game(const std::string& path, std::string& why);

/// The same for a table at hand. It lives as long as the result.
[[nodiscard]] Result<GameDef> game_of_table(const lockstone_game_table* table, std::string& why);

}  // namespace lockstone::tool
