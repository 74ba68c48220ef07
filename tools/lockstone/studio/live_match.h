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

/// A game that shows its world by a watch::WorldServer.
struct WatchedWorld {
  std::string origin;  ///< as of LiveMatch
  std::string token;
};

/// Hosts that the page may connect to besides its own server.
struct Connections {
  std::optional<LiveMatch> live;
  std::optional<WatchedWorld> world;
};

/// The parts of "ws://HOST:PORT/TOKEN", which a WorldServer has as its address.
[[nodiscard]] std::optional<WatchedWorld> watched_world_of(std::string_view address);

/// The origin of an address: "ws://HOST:PORT/", "wss://HOST:PORT/", or HOST:PORT for the first.
/// Nothing where it is none; then no character of it reaches a header of the page.
[[nodiscard]] std::optional<std::string> origin_of(std::string_view address);

}  // namespace lockstone::tool
