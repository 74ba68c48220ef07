#include <cstdio>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/studio/live_match.h"
#include "tools/lockstone/studio/page_server.h"
#include "tools/lockstone/studio/studio_files.h"
#include "tools/lockstone/support/console.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct StudioOptions {
  std::vector<std::string> files;
  std::uint16_t port = 0;
  std::string live;
  std::string world;
  std::string token;  // its file
  std::string name = "studio";
  bool plays = false;
};

/// Whether `--live` and its options can be used; fills `live` where they are given.
bool take_live(const StudioOptions& options, std::optional<LiveMatch>& live, int& exit_code) {
  if (options.live.empty()) return true;
  const std::optional<std::string> origin = origin_of(options.live);
  if (!origin) {
    complain(fmt::format("studio: --live {}: no address like ws://127.0.0.1:9000/", options.live));
    exit_code = k_usage;
    return false;
  }
  live = {*origin, "", options.name, options.plays};
  if (options.token.empty()) return true;
  std::optional<std::string> token = read_file(options.token);
  if (!token) {
    complain(fmt::format("studio: --token {}: cannot be read", options.token));
    exit_code = k_usage;
    return false;
  }
  live->token = std::move(*token);
  return true;
}

/// Whether `--world` can be used; fills `world` where it is given.
bool take_world(const StudioOptions& options, std::optional<WatchedWorld>& world, int& exit_code) {
  if (options.world.empty()) return true;
  world = watched_world_of(options.world);
  if (world) return true;
  complain(fmt::format("studio: --world {}: no address like ws://127.0.0.1:9000/0123456789abcdef",
                       options.world));
  exit_code = k_usage;
  return false;
}

int studio(const Games& games, const StudioOptions& options) {
  int exit_code = k_ok;
  Connections connections;
  if (!take_live(options, connections.live, exit_code) ||
      !take_world(options, connections.world, exit_code))
    return exit_code;
  std::optional<ServedFiles> files = studio_files(games, options.files, connections, exit_code);
  if (!files) return exit_code;
  std::string origins;
  if (connections.live) origins = connections.live->origin;
  if (connections.world) origins += ' ' + connections.world->origin;
  const std::unique_ptr<PageServer> server =
      PageServer::open(options.port, std::move(*files), origins);
  if (server == nullptr) return k_unavailable;
  fmt::print("{}\n", server->address());
  std::fflush(stdout);
  server->run();
  return k_ok;
}

}  // namespace

bool has_studio() {
  return true;
}

void add_studio_command(CLI::App& app, Tool& tool) {
  auto options = std::make_shared<StudioOptions>();
  CLI::App* command = app.add_subcommand(
      "studio", "Serve a page on this machine: scenes to play with, a log, or where two logs part");
  command
      ->add_option("files", options->files,
                   "Nothing, a .lks log, two logs of one match, or a .tar bundle of a desync")
      ->expected(0, 2);
  command->add_option("--port", options->port, "0: any that is free")->capture_default_str();
  CLI::Option* live = command->add_option(
      "--live", options->live, "Watch the match of a `serve --ws`, like ws://127.0.0.1:9000/");
  command->add_option("--world", options->world,
                      "Watch the world of a game that shows it: the address of its WorldServer");
  command->add_flag("--play", options->plays, "Take a seat of that match")->needs(live);
  command->add_option("--token", options->token, "File with a token of `token issue` for it")
      ->needs(live);
  command->add_option("--name", options->name, "Name that the match shows for this page")
      ->capture_default_str()
      ->needs(live);
  command->callback([options, &tool] { tool.exit_code = studio(tool.games, *options); });
}

}  // namespace lockstone::tool
