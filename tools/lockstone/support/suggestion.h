// Suggestions for an argument that no command knows.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace lockstone::tool {

/// The candidate that `word` was most likely meant to be, the first of equals; empty where none is
/// near: a mistake for each three letters at most, of which a swap of neighbours is one.
[[nodiscard]] std::string nearest(std::string_view word,
                                  const std::vector<std::string>& candidates);

/// After `app` failed to parse: "unknown command 'verfy'; did you mean 'verify'?", or the same of
/// an option; empty where something else is wrong.
[[nodiscard]] std::string unknown_argument(CLI::App& app);

}  // namespace lockstone::tool
