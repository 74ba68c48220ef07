// The command line for a game of your own: verify, bisect, trace, seek, cut, diff, repair, hash,
// flips, sync-test, record, serve, join, siege, simnet and the rest of `lockstone`, on your
// Simulation.
//
//     int main(int argc, char** argv) {
//       return lockstone::tool_main(argc, argv, {.name = "sumo", .version = "1.2", .make =
//       make_game});
//     }
//
// docs/how-to: "Your own game on the command line".
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <lockstone/simulation.h>

namespace lockstone {

class World;

/// A match that a command wants to start, by its options.
struct MatchRequest {
  std::string_view scene = {};  ///< --scene: a name in GameDef::scenes; empty: the first
  std::uint64_t seed = 1;       ///< --seed
  std::uint8_t players = 0;     ///< --players; 0: the usual number
  std::optional<std::uint32_t> bodies = {};  ///< --bodies: a size for games that have one
};

/// A bot's view when it chooses the input of its slot for one tick.
struct BotView {
  const Simulation&
      simulation;  ///< made by GameDef::make, before that tick or some ticks before it
  std::uint64_t seed = 1;
  std::size_t slot = 0;
  std::uint64_t tick = 0;
};

/// A kind of match that a game can start by name.
struct SceneDef {
  std::string name;
  std::string description = {};
  std::uint32_t ticks = 300;  ///< length of its run in `hash --suite golden`
};

/// A game, as the tools use it. `name` and `make` are required; every other member lets the
/// commands do more. The functions are called on several threads at a time.
struct GameDef {
  /// Written into each log, by which a tool finds the game again: 1 … 64 bytes of text.
  std::string name;
  std::string version = {};  ///< for people, at most 64 bytes of text
  std::string build = {};    ///< of the program, for people; empty: name and version

  SimulationFactory make;

  /// The configuration bytes of a match, for `make`. Without it `record`, `serve`, … take the bytes
  /// from a file (--config).
  std::function<Result<std::vector<std::byte>>(const MatchRequest& request)> configure = {};
  std::vector<SceneDef> scenes =
      {};  ///< the names that `configure` knows; the first is the default

  /// Writes a bot's input, of SimulationInfo::input_bytes zeros so far; false: nobody plays this
  /// slot. Only integers, the view and no memory may decide. Without it bots press random bytes.
  std::function<bool(const BotView& view, std::span<std::byte> out)> bot = {};

  /// The game's world, or null. Names the stages of a tick in `bisect`, and lets `flips` and
  /// `--flip-bit-at` change one bit of it.
  std::function<World*(Simulation& simulation)> world = {};

  /// A picture of the state as SVG, for `seek --svg`.
  std::function<std::string(const Simulation& simulation)> draw = {};

  /// A line of chat as a player command, for `join --say`; and the other way round, for the lines
  /// that `serve` and `join` print.
  std::function<std::vector<std::byte>(std::string_view text)> chat_command = {};
  std::function<std::optional<std::string>(ByteView command)> chat_text = {};
};

/// Runs the command that the arguments name, and returns the program's exit code: 0 ok, 1 states
/// differ, 2 damaged or unreadable input, 3 incompatible, 64 wrong usage, 69 the network or the
/// system refused. With several games a log's own name chooses the game; the first is the default.
[[nodiscard]] int tool_main(int argc, char** argv, const GameDef& game);
[[nodiscard]] int tool_main(int argc, char** argv, std::span<const GameDef> games);

/// The same for a game that takes its name from the program's file name.
[[nodiscard]] int tool_main(int argc, char** argv, const SimulationFactory& make);

}  // namespace lockstone
