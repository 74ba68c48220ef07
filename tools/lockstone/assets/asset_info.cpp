#include "tools/lockstone/assets/asset_info.h"

#include <cmath>
#include <cstdio>

#include <fmt/format.h>

#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/mesh.h>
#include <lockstone/path.h>
#include <lockstone/testing/floating.h>

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/convex/parts.h"
#include "core/geometry/convex/solid.h"
#include "tools/lockstone/support/console.h"

namespace lockstone::tool {
namespace {

using nlohmann::ordered_json;
using testing::to_double;

constexpr int k_density = 1000;

ordered_json vector_json(const Vec3<Length>& v) {
  return {to_double(v.x), to_double(v.y), to_double(v.z)};
}

void add_counts(const Asset& asset, ordered_json& json) {
  if (const auto* hull = dynamic_cast<const Hull*>(&asset)) {
    json["vertices"] = hull->vertices().size();
    json["faces"] = hull->face_count();
  } else if (const auto* mesh = dynamic_cast<const Mesh*>(&asset)) {
    json["vertices"] = mesh->vertex_count();
    json["triangles"] = mesh->triangle_count();
  } else if (const auto* field = dynamic_cast<const HeightField*>(&asset)) {
    json["columns"] = field->columns();
    json["rows"] = field->rows();
  } else if (const auto* compound = dynamic_cast<const Compound*>(&asset)) {
    json["children"] = compound->children().size();
  } else if (const auto* path = dynamic_cast<const Path*>(&asset)) {
    json["points"] = path->points().size();
    json["closed"] = path->is_closed();
    json["length"] = to_double(path->length());
  }
}

void add_mass(const geometry::Solid& solid, ordered_json& json) {
  const double volume = std::ldexp(solid.volume.mantissa, solid.volume.exponent);
  const double mass = volume * k_density;
  const double square_of_scale = std::ldexp(1, 2 * solid.scale_exponent);
  json["density"] = k_density;
  json["volume"] = volume;
  json["mass"] = mass;
  json["centre_of_mass"] = vector_json(solid.centre);
  for (int i = 0; i < 3; ++i)
    json["principal_moments"].push_back(to_double(solid.inertia[i]) * square_of_scale * mass);
}

/// An array's entries side by side.
std::string text_of(const ordered_json& value) {
  if (value.is_number_float()) return fmt::format("{:.9g}", value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (!value.is_array()) return value.dump();
  std::string text;
  for (const ordered_json& entry : value) {
    if (!text.empty()) text += ' ';
    text += text_of(entry);
  }
  return text;
}

}  // namespace

std::string kind_name(ShapeKind kind) {
  switch (kind) {
    case ShapeKind::hull:
      return "hull";
    case ShapeKind::mesh:
      return "mesh";
    case ShapeKind::height_field:
      return "height-field";
    case ShapeKind::path:
      return "path";
    default:
      return "compound";
  }
}

ordered_json asset_json(const std::string& file, const Asset& asset) {
  ordered_json json{{"file", file},
                    {"kind", kind_name(asset.kind())},
                    {"id", hash_text(asset.id().value)},
                    {"bytes", asset.canonical_bytes().size()}};
  add_counts(asset, json);
  json["lower"] = vector_json(asset.geometry().bounds().lower);
  json["upper"] = vector_json(asset.geometry().bounds().upper);
  if (const geometry::Solid* solid = asset.geometry().solid()) add_mass(*solid, json);
  if (const auto* compound = dynamic_cast<const Compound*>(&asset)) {
    json["hulls"] = json["meshes"] = ordered_json::array();
    for (const CompoundChild& child : compound->children()) {
      if (child.asset == nullptr) continue;
      const char* list = child.shape.kind == ShapeKind::mesh ? "meshes" : "hulls";
      json[list].push_back(hash_text(child.asset->id().value));
    }
  }
  return json;
}

void print_asset(const ordered_json& json) {
  for (const auto& [key, value] : json.items()) {
    if (key == "file") {
      fmt::print("{}\n", text_of(value));
    } else {
      fmt::print("  {:<18} {}\n", key, text_of(value));
    }
  }
}

}  // namespace lockstone::tool
