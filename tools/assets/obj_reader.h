// Wavefront OBJ files: vertices, faces as triangles, and the names of objects, groups and
// materials.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include <lockstone/mesh.h>

#include "tools/assets/import_fault.h"
#include "tools/assets/scientific_decimal.h"

namespace lockstone::assets {

inline constexpr std::size_t k_max_face_corners = 256;

struct ObjOptions {
  ScientificDecimal scale{false, 1, 0};  ///< metres in the file's unit
  bool z_up = false;                     ///< turn the file's z axis up to y
  bool banks = false;                    ///< of a path: the fourth number of a vertex, degrees
};

struct ObjTriangle {
  TriangleIndices corners{};
  std::uint32_t line = 0;
  std::uint32_t object = 0;  ///< indices into the names of the model
  std::uint32_t group = 0;
  std::uint32_t material = 0;
};

struct ObjModel {
  std::vector<Vec3<Length>> vertices;
  std::vector<Angle> banks;                 ///< by vertex; none where they are not asked for
  std::vector<std::uint32_t> vertex_lines;  ///< line of the file, by vertex
  std::vector<ObjTriangle> triangles;
  // In order of appearance. The first is "": the part before any name.
  std::vector<std::string> objects{""};
  std::vector<std::string> groups{""};
  std::vector<std::string> materials{""};
};

/// Reads a whole file into an empty model. Every statement must be a known one and well formed;
/// normals, texture coordinates, lines and points are passed over, material files not opened.
[[nodiscard]] ImportOutcome read_obj(std::string_view text, const ObjOptions& options,
                                     ObjModel& model);

}  // namespace lockstone::assets
