#include <algorithm>
#include <map>

#include <fmt/format.h>

#include <lockstone/compound.h>
#include <lockstone/hull.h>
#include <lockstone/path.h>

#include "tools/assets/import.h"

namespace lockstone::assets {
namespace {

using Points = std::vector<Vec3<Length>>;

ImportFault fault_at(std::uint32_t line, std::string_view reason) {
  return {line, std::string(reason)};
}

/// By material of the model: an index into the surfaces of the options, or k_own_surface.
ImportOutcome surfaces_of_materials(const ObjModel& model, const ObjImport& options,
                                    std::vector<std::uint8_t>& indices) {
  indices.assign(model.materials.size(), k_own_surface);
  for (std::size_t i = 0; i < options.surfaces.size(); ++i) {
    const std::string& name = options.surfaces[i].first;
    const auto found = std::ranges::find(model.materials, name);
    if (found == model.materials.end()) return fault_at(0, "no material '" + name + "'");
    indices[static_cast<std::size_t>(found - model.materials.begin())] =
        static_cast<std::uint8_t>(i);
  }
  return std::nullopt;
}

std::uint32_t line_of(const MeshResult& built, const ObjModel& model) {
  const bool vertex = built.fault == MeshFault::coordinate_out_of_range;
  if (vertex && built.index < model.vertex_lines.size()) return model.vertex_lines[built.index];
  const bool triangle = built.fault == MeshFault::index_out_of_range;
  return triangle && built.index < model.triangles.size() ? model.triangles[built.index].line : 0;
}

void note_dropped(std::uint32_t count, std::string_view what, Imported& out) {
  if (count != 0) out.notes.push_back(fmt::format("dropped {} {}", count, what));
}

/// The object of a triangle: a group, where the file names no objects.
std::uint32_t object_of(const ObjModel& model, const ObjTriangle& triangle) {
  return model.objects.size() > 1 ? triangle.object : triangle.group;
}

/// Of the triangles for which `is_in(triangle)` holds.
template <class IsIn>
ImportOutcome build_mesh_of(const ObjModel& model, const ObjImport& options,
                            const std::vector<std::uint8_t>& surface_of, IsIn&& is_in,
                            AssetPtr& made, Imported& out) {
  std::vector<TriangleIndices> triangles;
  std::vector<std::uint8_t> triangle_surfaces;
  std::vector<std::uint16_t> groups;
  for (const ObjTriangle& t : model.triangles) {
    if (!is_in(t)) continue;
    triangles.push_back(t.corners);
    if (!options.surfaces.empty()) triangle_surfaces.push_back(surface_of[t.material]);
    const std::uint32_t group = object_of(model, t);
    if (options.groups) groups.push_back(static_cast<std::uint16_t>(std::min(group, 0xffffU)));
  }
  std::vector<Surface> surfaces;
  for (const auto& [name, surface] : options.surfaces)
    surfaces.push_back(surface);
  MeshDef def;
  def.vertices = model.vertices;
  def.triangles = triangles;
  def.triangle_surfaces = triangle_surfaces;
  def.surfaces = surfaces;
  def.weld_tolerance = options.weld_tolerance;
  def.triangle_groups = groups;
  const MeshResult built = Mesh::build(def);
  if (!built.ok()) return fault_at(line_of(built, model), to_string(built.fault));
  made = built.mesh;
  note_dropped(built.welded_vertices, "vertices equal to others", out);
  note_dropped(built.degenerate_triangles, "triangles without area", out);
  note_dropped(built.duplicate_triangles, "repeated triangles", out);
  return std::nullopt;
}

ImportOutcome build_mesh(const ObjModel& model, const ObjImport& options,
                         const std::vector<std::uint8_t>& surface_of, Imported& out) {
  if (model.triangles.empty()) return fault_at(0, "no faces");
  const auto all = [](const ObjTriangle&) { return true; };
  return build_mesh_of(model, options, surface_of, all, out.asset, out);
}

HullResult hull_of(const Points& points, const ObjImport& options) {
  HullOptions hull_options;
  hull_options.max_vertices = options.max_vertices;
  return Hull::build(points, hull_options);
}

ImportOutcome build_hull(const ObjModel& model, const ObjImport& options, Imported& out) {
  const HullResult built = hull_of(model.vertices, options);
  if (!built.ok()) return fault_at(0, to_string(built.fault));
  out.asset = built.hull;
  return std::nullopt;
}

/// The faces of one object.
struct ObjectFaces {
  std::vector<std::uint32_t> vertices;  ///< of the model
  std::uint32_t line = 0;               ///< of the first
  std::uint8_t surface = k_own_surface;
};

/// By index of the object's name, so in the order in which the file names them.
using Objects = std::map<std::uint32_t, ObjectFaces>;

Objects objects_of(const ObjModel& model, const std::vector<std::uint8_t>& surface_of) {
  Objects objects;
  for (const ObjTriangle& t : model.triangles) {
    const std::uint8_t surface = surface_of[t.material];
    const auto [at, is_new] =
        objects.try_emplace(object_of(model, t), ObjectFaces{{}, t.line, surface});
    ObjectFaces& faces = at->second;
    for (const std::uint32_t corner : {t.corners.a, t.corners.b, t.corners.c})
      faces.vertices.push_back(corner);
    if (faces.surface != surface) faces.surface = k_own_surface;
  }
  return objects;
}

Points points_of(const ObjModel& model, std::vector<std::uint32_t> vertices) {
  std::ranges::sort(vertices);
  vertices.erase(std::unique(vertices.begin(), vertices.end()), vertices.end());
  Points points;
  for (const std::uint32_t vertex : vertices)
    points.push_back(model.vertices[vertex]);
  return points;
}

/// A name of an object that is none, or nothing.
ImportOutcome check_meshes(const std::vector<std::string>& names, const ObjImport& options) {
  for (const std::string& mesh : options.meshes)
    if (std::ranges::find(names, mesh) == names.end())
      return fault_at(0, fmt::format("no object '{}'", mesh));
  return std::nullopt;
}

ImportOutcome build_compound(const ObjModel& model, const ObjImport& options,
                             const std::vector<std::uint8_t>& surface_of, Imported& out) {
  const auto& names = model.objects.size() > 1 ? model.objects : model.groups;
  if (ImportOutcome fault = check_meshes(names, options)) return fault;
  std::vector<CompoundChild> children;
  for (const auto& [index, faces] : objects_of(model, surface_of)) {
    CompoundChild child;
    if (std::ranges::find(options.meshes, names[index]) != options.meshes.end()) {
      const auto is_in = [&, object = index](const ObjTriangle& t) {
        return object_of(model, t) == object;
      };
      if (ImportOutcome fault = build_mesh_of(model, options, surface_of, is_in, child.asset, out))
        return fault_at(faces.line, fmt::format("'{}': {}", names[index], fault->reason));
    } else {
      const HullResult built = hull_of(points_of(model, faces.vertices), options);
      const std::string_view reason = to_string(built.fault);
      if (!built.ok()) return fault_at(faces.line, fmt::format("'{}': {}", names[index], reason));
      child.asset = built.hull;
      if (faces.surface != k_own_surface) child.surface = options.surfaces[faces.surface].second;
    }
    child.shape = child.asset->shape();
    children.push_back(child);
    out.children.push_back(child.asset);
  }
  const CompoundResult built = Compound::build(children);
  if (!built.ok()) return fault_at(0, to_string(built.fault));
  out.asset = built.compound;
  return std::nullopt;
}

ImportOutcome build_path(const ObjModel& model, const ObjImport& options, Imported& out) {
  std::vector<PathPoint> points;
  for (const Vec3<Length>& vertex : model.vertices)
    points.push_back({vertex});
  const PathResult built = Path::build(points, model.banks, options.closed);
  const std::size_t lines = model.vertex_lines.size();
  if (!built.ok())
    return fault_at(built.point < lines ? model.vertex_lines[built.point] : 0,
                    to_string(built.fault));
  out.asset = built.path;
  return std::nullopt;
}

}  // namespace

ImportOutcome import_obj(std::string_view text, const ObjImport& options, Imported& out) {
  ObjModel model;
  if (ImportOutcome fault = read_obj(text, options.reading, model)) return fault;
  if (options.kind == ShapeKind::path) return build_path(model, options, out);
  if (options.kind == ShapeKind::hull) return build_hull(model, options, out);
  std::vector<std::uint8_t> surface_of;
  if (ImportOutcome fault = surfaces_of_materials(model, options, surface_of)) return fault;
  return options.kind == ShapeKind::compound ? build_compound(model, options, surface_of, out)
                                             : build_mesh(model, options, surface_of, out);
}

}  // namespace lockstone::assets
