// The catalogue of scenes as a page with pictures.
#pragma once

#include <string>

namespace lockstone::tool {

/// Writes the page, and a picture of each scene into the folder of the page's name beside it:
/// `docs/scenes.md` and `docs/scenes/NAME.svg`. False, with a complaint, when a file is there and
/// `force` is not given, or the system refuses.
[[nodiscard]] bool write_scenes_page(const std::string& path, bool force);

}  // namespace lockstone::tool
