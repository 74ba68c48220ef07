// A match that runs, for the page to watch or to play in.
#pragma once

#include <optional>
#include <string>
#include <string_view>

namespace lockstone::tool {

struct LiveMatch {
  std::string origin;  ///< "ws://127.0.0.1:9000": the page may connect there
  std::string token;   ///< the text of `token issue`; empty: an insecure match
  std::string name;    ///< that other players see
  bool plays = false;  ///< begins as a player, not as a spectator
};

/// The origin of an address: "ws://HOST:PORT/", "wss://HOST:PORT/", or HOST:PORT for the first.
/// Nothing where it is none; then no character of it reaches a header of the page.
[[nodiscard]] std::optional<std::string> origin_of(std::string_view address);

}  // namespace lockstone::tool
