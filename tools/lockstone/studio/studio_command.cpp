#include <cstdio>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include "tools/lockstone/commands.h"
#include "tools/lockstone/studio/page_server.h"
#include "tools/lockstone/studio/studio_files.h"
#include "tools/tool/tool_command.h"

namespace lockstone::tool {
namespace {

struct StudioOptions {
  std::vector<std::string> files;
  std::uint16_t port = 0;
};

int studio(const Games& games, const StudioOptions& options) {
  int exit_code = k_ok;
  std::optional<ServedFiles> files = studio_files(games, options.files, exit_code);
  if (!files) return exit_code;
  const std::unique_ptr<PageServer> server = PageServer::open(options.port, std::move(*files));
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
  command->callback([options, &tool] { tool.exit_code = studio(tool.games, *options); });
}

}  // namespace lockstone::tool
