// Files of modelling programs to assets.
#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include <lockstone/asset.h>
#include <lockstone/bytes.h>

#include "tools/assets/import_fault.h"
#include "tools/assets/obj_reader.h"

namespace lockstone::assets {

struct ObjImport {
  ShapeKind kind = ShapeKind::mesh;  ///< hull, mesh, compound or path
  bool closed = false;               ///< of a path
  ObjOptions reading;
  int max_vertices = 64;            ///< of a hull, 4 … 128
  Length weld_tolerance{};          ///< of a mesh
  bool groups = false;              ///< of a mesh: an object (a group, without objects) is a group
  std::vector<std::string> meshes;  ///< objects of a compound that are meshes, by name
  /// The surface of a mesh's faces of a material, or of a compound's hull of that material alone.
  /// Faces of other materials have the body's own surface.
  std::vector<std::pair<std::string, Surface>> surfaces;
};

struct PngImport {
  Length cell = Length::from_integer(1);     ///< between samples, both ways
  Length height = Length::from_integer(64);  ///< of the sample 65535 above the sample 0
  Length base{};                             ///< of the sample 0
};

struct Imported {
  AssetPtr asset;
  std::vector<AssetPtr> children;  ///< hulls and meshes that the asset, a compound, needs
  std::vector<std::string> notes;  ///< dropped parts of the file
};

/// A hull of all vertices; a path through them in the order of the file, up along y and banked by
/// ObjOptions::banks; a mesh of all faces; or a compound with one hull an object (a group where the
/// file names no objects), of the vertices of its faces, or one mesh of these faces.
[[nodiscard]] ImportOutcome import_obj(std::string_view text, const ObjImport& options,
                                       Imported& out);

/// A height field whose middle is at x = z = 0; columns along x, rows along z from the top.
[[nodiscard]] ImportOutcome import_png(ByteView file, const PngImport& options, Imported& out);

}  // namespace lockstone::assets
