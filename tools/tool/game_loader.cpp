#include "tools/tool/game_loader.h"

#include <algorithm>
#include <memory>
#include <utility>

#if defined(LOCKSTONE_WITH_GAME_LIBRARIES)
#include <dlfcn.h>
#endif

#include "tools/tool/games.h"
#include "tools/tool/loaded_simulation.h"

namespace lockstone::tool {
namespace {

constexpr std::size_t k_most_config_bytes = 64U << 10;

std::string text_of(const char* text) {
  return text == nullptr ? std::string() : std::string(text);
}

Result<std::vector<std::byte>> configure_loaded(const lockstone_game_table& table,
                                                const MatchRequest& request) {
  const std::string scene(request.scene);
  const lockstone_game_request asked{
      .scene = scene.c_str(),
      .seed = request.seed,
      .bodies = request.bodies ? std::int64_t{*request.bodies} : std::int64_t{-1},
      .players = request.players};
  std::vector<std::byte> bytes(k_most_config_bytes);
  std::size_t size = bytes.size();
  const Status status =
      game_status(table.configure(&asked, reinterpret_cast<std::uint8_t*>(bytes.data()), &size));
  if (status != Status::ok) return status;
  bytes.resize(std::min(size, bytes.size()));
  return bytes;
}

// The match behind a simulation of this library.
const void* match_of(const Simulation& simulation) {
  const auto* loaded = dynamic_cast<const LoadedSimulation*>(&simulation);
  return loaded == nullptr ? nullptr : loaded->match();
}

bool press_loaded(const lockstone_game_table& table, const BotView& view,
                  std::span<std::byte> out) {
  const void* match = match_of(view.simulation);
  return match != nullptr && table.bot(match, view.seed, static_cast<std::uint32_t>(view.slot),
                                       view.tick, reinterpret_cast<std::uint8_t*>(out.data())) != 0;
}

std::string draw_loaded(const lockstone_game_table& table, const Simulation& simulation) {
  const void* match = match_of(simulation);
  if (match == nullptr) return {};
  std::string picture(table.draw(match, nullptr, 0), '\0');
  picture.resize(std::min(table.draw(match, picture.data(), picture.size()), picture.size()));
  return picture;
}

}  // namespace

Result<GameDef> game_of_table(const lockstone_game_table* table, std::string& why) {
  auto checked = full_table(table, why);
  if (!checked) return checked.status();
  const auto full = std::move(checked).value();
  GameDef game;
  game.name = text_of(full->name).substr(0, replay::k_max_game_bytes);
  game.version = text_of(full->version).substr(0, replay::k_max_game_bytes);
  game.build = text_of(full->build);
  game.make = [full](ByteView config) { return make_loaded(full, config); };
  if (full->configure != nullptr) {
    game.configure = [full](const MatchRequest& asked) { return configure_loaded(*full, asked); };
  }
  for (std::size_t i = 0; full->scenes != nullptr && i < full->scene_count; ++i) {
    const lockstone_game_scene& scene = full->scenes[i];
    game.scenes.push_back({text_of(scene.name), text_of(scene.description), scene.ticks});
  }
  if (full->bot != nullptr) {
    game.bot = [full](const BotView& view, std::span<std::byte> out) {
      return press_loaded(*full, view, out);
    };
  }
  if (full->draw != nullptr) {
    game.draw = [full](const Simulation& simulation) { return draw_loaded(*full, simulation); };
  }
  return game;
}

#if defined(LOCKSTONE_WITH_GAME_LIBRARIES)

Result<GameDef> load_game(const std::string& path, std::string& why) {
  using Entry = const lockstone_game_table* (*)();
  // A bare name is a file here, not one of the system's folders.
  const std::string file = path.find('/') == std::string::npos ? "./" + path : path;
  void* library = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (library == nullptr) {
    why = text_of(dlerror());
    return Status::io_error;
  }
  const auto entry = reinterpret_cast<Entry>(dlsym(library, "lockstone_game"));
  if (entry == nullptr) {
    why = "it exports no lockstone_game: see LOCKSTONE_GAME_LIBRARY in lockstone/game_library.h";
    return Status::io_error;
  }
  return game_of_table(entry(), why);
}

#else

Result<GameDef> load_game(const std::string&, std::string& why) {
  why = "this build loads no libraries; use the game's own tool";
  return Status::incompatible;
}

#endif

}  // namespace lockstone::tool
