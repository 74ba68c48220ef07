// Everything that the studio's page asks for: the page itself, the logs, and where they part.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "tools/lockstone/studio/live_match.h"
#include "tools/lockstone/studio/page_server.h"
#include "tools/tool/games.h"

namespace lockstone::tool {

/// The files for a session: no path opens the testbed, one .lks the log, two of them or one .tar
/// the desync; `connections` a match and a game that run. Nothing, with a complaint and `exit_code`, where they cannot be
/// shown.
[[nodiscard]] std::optional<ServedFiles> studio_files(const Games& games,
                                                      const std::vector<std::string>& paths,
                                                      const Connections& connections,
                                                      int& exit_code);

}  // namespace lockstone::tool
