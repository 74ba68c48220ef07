#include <algorithm>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/format.h>

#include <lockstone/decimal.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/load_asset.h>
#include <lockstone/mesh.h>
#include <lockstone/scaled_asset.h>

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
  std::vector<std::string> meshes;
  std::string factors;
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

/// Files of programs, an asset as it is, or nothing.
enum class Source { obj, png, asset, unknown };

Source source_of(const BuildOptions& options) {
  std::string extension = std::filesystem::path(options.input).extension().string();
  for (char& c : extension)
    if (c >= 'A' && c <= 'Z') c = static_cast<char>(c - 'A' + 'a');
  if (extension == ".obj") return Source::obj;
  if (extension == ".lka") return Source::asset;
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
  import.meshes = options.meshes;
  if (!options.meshes.empty() && import.kind != ShapeKind::compound)
    return "--mesh: only with --as compound";
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
std::string child_file(const std::string& file, const Asset& child) {
  const std::filesystem::path path(file);
  const std::string name =
      fmt::format("{}-{}.lka", path.stem().string(), hash_text(child.id().value));
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
  const AssetSet children(imported.children);  // each once
  for (const AssetPtr& child : children.all())
    files.emplace_back(child_file(file, *child), child);
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

/// X,Y,Z, or one factor for all axes.
std::optional<Vec3<Number>> parse_factors(const std::string& text) {
  std::vector<Number> numbers;
  for (std::size_t at = 0; at <= text.size() && numbers.size() < 4;) {
    const std::size_t comma = std::min(text.find(',', at), text.size());
    const auto number = parse_decimal<Number>(text.substr(at, comma - at));
    if (!number) return std::nullopt;
    numbers.push_back(number.value());
    at = comma + 1;
  }
  if (numbers.size() == 1) numbers.resize(3, numbers[0]);
  if (numbers.size() != 3) return std::nullopt;
  return Vec3<Number>{numbers[0], numbers[1], numbers[2]};
}

/// The fault, or nothing once the asset is its scaled copy.
ImportOutcome scale(AssetPtr& asset, const Vec3<Number>& factors) {
  const auto take = [&](const auto& copy, const auto& result) -> ImportOutcome {
    if (!result.ok()) return ImportFault{0, "scaled: " + std::string(to_string(result.fault))};
    asset = copy;
    return std::nullopt;
  };
  if (const auto* hull = dynamic_cast<const Hull*>(asset.get())) {
    const HullResult copy = scaled(*hull, factors);
    return take(copy.hull, copy);
  }
  if (const auto* mesh = dynamic_cast<const Mesh*>(asset.get())) {
    const MeshResult copy = scaled(*mesh, factors);
    return take(copy.mesh, copy);
  }
  if (const auto* field = dynamic_cast<const HeightField*>(asset.get())) {
    const HeightFieldResult copy = scaled(*field, factors);
    return take(copy.height_field, copy);
  }
  return ImportFault{0, "only a hull, mesh or height field can be scaled"};
}

ImportOutcome import_asset(ByteView bytes, Imported& out) {
  Result<AssetPtr> loaded = load_asset(bytes);
  if (!loaded) return ImportFault{0, std::string(to_string(loaded.status()))};
  out.asset = std::move(loaded).value();
  return std::nullopt;
}

int refuse(const std::string& file, const ImportFault& fault) {
  const std::string line = fault.line == 0 ? "" : fmt::format(":{}", fault.line);
  fmt::print(stderr, "{}{}: {}\n", file, line, fault.reason);
  return k_corrupt;
}

/// The fault in the options of the source, or nothing.
std::string parse(const BuildOptions& options, Source source, assets::ObjImport& obj,
                  assets::PngImport& png) {
  if (source == Source::obj) return parse(options, obj);
  if (source == Source::png) return parse(options, png);
  if (!options.kind.empty()) return "an asset keeps its kind";
  if (options.output.empty() || options.factors.empty())
    return "an asset needs --factors, and --output for its copy";
  return {};
}

int build(const BuildOptions& options) {
  assets::ObjImport obj;
  assets::PngImport png;
  const Source source = source_of(options);
  if (source == Source::unknown) return misuse("neither an .obj nor a .png nor an .lka file");
  const std::string wrong = parse(options, source, obj, png);
  if (!wrong.empty()) return misuse(wrong);
  const auto factors = parse_factors(options.factors.empty() ? "1" : options.factors);
  if (!factors) return misuse("--factors: X,Y,Z or one number");
  const std::optional<std::string> text = read_file(options.input);
  if (!text) return refuse(options.input, {0, "cannot be read"});
  const ByteView bytes = std::as_bytes(std::span(*text));
  Imported imported;
  ImportOutcome fault = source == Source::obj   ? assets::import_obj(*text, obj, imported)
                        : source == Source::png ? assets::import_png(bytes, png, imported)
                                                : import_asset(bytes, imported);
  if (!fault && !options.factors.empty()) fault = scale(imported.asset, *factors);
  if (fault) return refuse(options.input, *fault);
  for (const std::string& note : imported.notes)
    fmt::print(stderr, "{}: {}\n", options.input, note);
  return write(options, imported);
}

}  // namespace

void add_asset_build_command(CLI::App& asset, int& exit_code) {
  auto options = std::make_shared<BuildOptions>();
  CLI::App* command =
      asset.add_subcommand("build", "Make an asset of an OBJ or PNG file, or of another asset");
  command->add_option("file", options->input, "An .obj model, a 16-bit grey .png, or an .lka asset")
      ->required();
  command->add_option("-o,--output", options->output, "The asset (default: the name with .lka)");
  command
      ->add_option("--as", options->kind,
                   "The kind of asset to build (default: mesh, height-field)")
      ->check(CLI::IsMember({"hull", "mesh", "compound", "path", "height-field"}));
  command->add_option("--scale", options->scale, "OBJ: metres in the file's unit (default 1)");
  command
      ->add_option("--factors", options->factors,
                   "X,Y,Z or one: scale the hull, mesh or height field along its axes; below 0 "
                   "mirrors")
      ->allow_extra_args(false);
  command->add_flag("--z-up", options->z_up, "OBJ: turn its z axis up to y");
  command
      ->add_option("--surface", options->surfaces,
                   "OBJ: NAME=FRICTION[,RESTITUTION] of a material; repeatable")
      ->allow_extra_args(false);
  command
      ->add_option("--max-vertices", options->max_vertices, "Most vertices of a hull (default 64)")
      ->check(CLI::Range(4, k_max_hull_vertices));
  command->add_option("--weld", options->weld, "Mesh: metres within which vertices become one");
  command
      ->add_option("--mesh", options->meshes,
                   "Compound: an object of the OBJ file that is a mesh; repeatable")
      ->allow_extra_args(false);
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
