// The catalogue of scenes as a page with pictures.
#pragma once

#include <span>
#include <string>

#include "tools/scenes/play.h"

namespace lockstone::tool {

/// Writes the page of these scenes, and a picture of each into the folder of the page's name beside
/// it: `docs/scenes.md` and `docs/scenes/NAME.svg`. False, with a complaint, when a file is there
/// and `force` is not given, or the system refuses.
[[nodiscard]] bool write_scenes_page(std::span<const scenes::SceneSummary> list,
                                     const std::string& path, bool force);

}  // namespace lockstone::tool
