#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <lockstone/decimal.h>
#include <lockstone/hull.h>

#include "tools/assets/import.h"
#include "tools/lockstone/assets/asset_info.h"
#include "tools/lockstone/commands.h"
#include "tools/lockstone/support/console.h"
#include "tools/lockstone/support/json_text.h"
#include "tools/lockstone/support/output_file.h"

namespace lockstone::tool {
namespace {

using assets::Imported;
using assets::ImportFault;
using assets::ImportOutcome;

/// As on the command line.
struct BuildOptions {
  std::string input;
  std::string output;
  std::string kind;
  std::string scale = "1";
  std::vector<std::string> surfaces;
  std::string weld = "0";
  std::string cell = "1";
  std::string height;
  std::string base = "0";
  int max_vertices = 64;
  bool z_up = false;
  bool groups = false;
  bool closed = false;
  bool banks = false;
  bool force = false;
  bool json = false;
};

/// Files of programs, or nothing.
enum class Source { obj, png, unknown };

Source source_of(const BuildOptions& options) {
  std::string extension = std::filesystem::path(options.input).extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (extension == ".obj") return Source::obj;
  return extension == ".png" ? Source::png : Source::unknown;
}

int misuse(const std::string& why) {
  complain("asset build: " + why);
  return k_usage;
}

/// NAME=FRICTION[,RESTITUTION]
bool parse_surface(const std::string& text, assets::ObjImport& import) {
  const std::size_t equals = text.rfind('=');
  if (equals == std::string::npos || import.surfaces.size() == k_max_surfaces) return false;
  const std::string numbers = text.substr(equals + 1);
  const std::size_t comma = std::min(numbers.find(','), numbers.size());
  const auto friction = parse_decimal<Coefficient>(numbers.substr(0, comma));
  const bool bounces = comma < numbers.size();
  const auto restitution = parse_decimal<Coefficient>(bounces ? numbers.substr(comma + 1) : "0");
  if (!friction || !restitution) return false;
  import.surfaces.emplace_back(text.substr(0, equals),
                               Surface{friction.value(), restitution.value()});
  return true;
}

ShapeKind kind_of(const std::string& name) {
  if (name == "hull") return ShapeKind::hull;
  if (name == "path") return ShapeKind::path;
  return name == "compound" ? ShapeKind::compound : ShapeKind::mesh;
}

/// The fault in the options, or nothing.
std::string parse(const BuildOptions& options, assets::ObjImport& import) {
  if (options.kind == "height-field") return "an OBJ file makes no height field";
  const auto scale = assets::read_scientific(options.scale, assets::k_max_scale_digits);
  const auto weld = parse_decimal<Length>(options.weld);
  if (!scale || scale->digits == 0 || scale->negative)
    return "--scale: a number above 0 of at most nine digits";
  if (!weld) return "--weld: not a length";
  import.kind = kind_of(options.kind);
  import.closed = options.closed;
  import.reading = {*scale, options.z_up};
  import.max_vertices = options.max_vertices;
  import.weld_tolerance = weld.value();
  import.groups = options.groups;
  import.reading.banks = options.banks;
  for (const std::string& surface : options.surfaces)
    if (!parse_surface(surface, import)) return "--surface: NAME=FRICTION[,RESTITUTION]";
  return {};
}

std::string parse(const BuildOptions& options, assets::PngImport& import) {
  if (!options.kind.empty() && options.kind != "height-field")
    return "a picture makes a height field only";
  const auto cell = parse_decimal<Length>(options.cell);
  const auto height = parse_decimal<Length>(options.height);
  const auto base = parse_decimal<Length>(options.base);
  if (!cell || !base || !height || cell.value().raw <= 0 || height.value().raw < 0)
    return "a height field needs --height and --cell, lengths in metres";
  import = {cell.value(), height.value(), base.value()};
  return {};
}

/// Beside the compound's file.
std::string hull_file(const std::string& file, const Asset& hull) {
  const std::filesystem::path path(file);
  const std::string name =
      fmt::format("{}-{}.lka", path.stem().string(), hash_text(hull.id().value));
  return (path.parent_path() / name).string();
}

bool write_asset(const Output& file, const Asset& asset) {
  const std::vector<std::byte> bytes = asset.canonical_bytes();
  return write_text_file(file, {reinterpret_cast<const char*>(bytes.data()), bytes.size()});
}

int write(const BuildOptions& options, const Imported& imported) {
  std::string file = options.output;
  if (file.empty()) file = std::filesystem::path(options.input).replace_extension(".lka").string();
  auto json = nlohmann::ordered_json::array();
  std::vector<std::pair<std::string, AssetPtr>> files{{file, imported.asset}};
  const AssetSet hulls(imported.hulls);  // each once
  for (const AssetPtr& hull : hulls.all())
    files.emplace_back(hull_file(file, *hull), hull);
  const auto is_writable = [&](const auto& entry) {
    return may_write({entry.first, options.force});
  };
  if (!std::ranges::all_of(files, is_writable)) return k_unavailable;
  for (const auto& [path, asset] : files) {
    if (!write_asset({path, options.force}, *asset)) return k_unavailable;
    json.push_back(asset_json(path, *asset));
    if (!options.json)
      fmt::print("{}: {} {}\n", path, kind_name(asset->kind()), hash_text(asset->id().value));
  }
  if (options.json) write_json(json);
  return k_ok;
}

int refuse(const std::string& file, const ImportFault& fault) {
  const std::string line = fault.line == 0 ? "" : fmt::format(":{}", fault.line);
  fmt::print(stderr, "{}{}: {}\n", file, line, fault.reason);
  return k_corrupt;
}

int build(const BuildOptions& options) {
  assets::ObjImport obj;
  assets::PngImport png;
  const Source source = source_of(options);
  if (source == Source::unknown) return misuse("neither an .obj nor a .png file");
  const std::string wrong = source == Source::obj ? parse(options, obj) : parse(options, png);
  if (!wrong.empty()) return misuse(wrong);
  const std::optional<std::string> text = read_file(options.input);
  if (!text) return refuse(options.input, {0, "cannot be read"});
  Imported imported;
  const ImportOutcome fault =
      source == Source::obj ? assets::import_obj(*text, obj, imported)
                            : assets::import_png(std::as_bytes(std::span(*text)), png, imported);
  if (fault) return refuse(options.input, *fault);
  for (const std::string& note : imported.notes)
    fmt::print(stderr, "{}: {}\n", options.input, note);
  return write(options, imported);
}

}  // namespace

void add_asset_build_command(CLI::App& asset, int& exit_code) {
  auto options = std::make_shared<BuildOptions>();
  CLI::App* command = asset.add_subcommand("build", "Make an asset of an OBJ or PNG file");
  command->add_option("file", options->input, "An .obj model or a 16-bit grey .png")->required();
  command->add_option("-o,--output", options->output, "The asset (default: the name with .lka)");
  command
      ->add_option("--as", options->kind,
                   "The kind of asset to build (default: mesh, height-field)")
      ->check(CLI::IsMember({"hull", "mesh", "compound", "path", "height-field"}));
  command->add_option("--scale", options->scale, "OBJ: metres in the file's unit (default 1)");
  command->add_flag("--z-up", options->z_up, "OBJ: turn its z axis up to y");
  command
      ->add_option("--surface", options->surfaces,
                   "OBJ: NAME=FRICTION[,RESTITUTION] of a material; repeatable")
      ->allow_extra_args(false);
  command
      ->add_option("--max-vertices", options->max_vertices, "Most vertices of a hull (default 64)")
      ->check(CLI::Range(4, k_max_hull_vertices));
  command->add_option("--weld", options->weld, "Mesh: metres within which vertices become one");
  command->add_flag("--groups", options->groups,
                    "Mesh: each object of the OBJ file is a group that a world may switch off");
  command->add_flag("--closed", options->closed,
                    "Path: it goes on from the last vertex to the first");
  command->add_flag("--banks", options->banks,
                    "Path: the fourth number of a vertex is its bank in degrees, to the right");
  command->add_option("--cell", options->cell, "PNG: metres between samples (default 1)");
  command->add_option("--height", options->height, "PNG: metres from black to white");
  command->add_option("--base", options->base, "PNG: height of black in metres (default 0)");
  add_force_option(*command, options->force);
  command->add_flag("--json", options->json, "Print JSON");
  command->callback([options, &exit_code] { exit_code = build(*options); });
}

}  // namespace lockstone::tool
