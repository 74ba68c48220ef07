#include <algorithm>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <lockstone/load_asset.h>

#include "tools/lockstone/assets/asset_info.h"
#include "tools/lockstone/logs/file/log_file.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"

namespace lockstone::tool {

void add_asset_build_command(CLI::App& asset, int& exit_code);

namespace {

using nlohmann::ordered_json;

struct InfoOptions {
  std::vector<std::string> files;
  bool json = false;
};

Result<AssetPtr> load_file(const std::string& file, const AssetSet& known) {
  const std::optional<std::string> bytes = read_file(file);
  if (!bytes) return Status::io_error;
  return load_asset(std::as_bytes(std::span(*bytes)), known);
}

// Compounds wait until the hulls and meshes among the files are known.
std::vector<Result<AssetPtr>> load_files(const std::vector<std::string>& files) {
  std::vector<Result<AssetPtr>> loaded;
  std::vector<AssetPtr> known;
  for (const std::string& file : files) {
    loaded.push_back(load_file(file, {}));
    if (loaded.back()) known.push_back(loaded.back().value());
  }
  const AssetSet set(std::move(known));
  for (std::size_t i = 0; i < files.size(); ++i)
    if (loaded[i].status() == Status::not_found) loaded[i] = load_file(files[i], set);
  return loaded;
}

std::string reason_of(Status status) {
  if (status == Status::not_found) return "a hull or mesh of this compound is not among the files";
  if (status == Status::io_error) return "cannot be read";
  return std::string(to_string(status));
}

int info(const InfoOptions& options) {
  const std::vector<Result<AssetPtr>> loaded = load_files(options.files);
  int worst = k_ok;
  ordered_json json = ordered_json::array();
  for (std::size_t i = 0; i < loaded.size(); ++i) {
    const std::string& file = options.files[i];
    if (loaded[i]) {
      json.push_back(asset_json(file, *loaded[i].value()));
      if (!options.json) print_asset(json.back());
      continue;
    }
    const Status status = loaded[i].status();
    worst = std::max(worst, exit_code_of(status));
    json.push_back({{"file", file}, {"error", reason_of(status)}});
    fmt::print(stderr, "{}: {}\n", file, reason_of(status));
  }
  if (options.json) write_json(json);
  return worst;
}

}  // namespace

void add_asset_command(CLI::App& app, int& exit_code) {
  CLI::App* asset = app.add_subcommand("asset", "Make hulls, meshes, height fields and compounds");
  asset->require_subcommand(1);
  add_asset_build_command(*asset, exit_code);
  auto options = std::make_shared<InfoOptions>();
  CLI::App* command = asset->add_subcommand("info", "Describe assets");
  command
      ->add_option("files", options->files,
                   "Assets (.lka), a compound's hulls and meshes among them")
      ->required();
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, &exit_code] { exit_code = info(*options); });
}

}  // namespace lockstone::tool
