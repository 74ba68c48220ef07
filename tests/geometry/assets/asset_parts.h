// Helpers for tests of assets: collected parts, and small solids as meshes.
#pragma once

#include <array>
#include <vector>

#include <lockstone/mesh.h>

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/mesh_contact/triangle_polytope.h"
#include "tests/geometry/scene.h"

namespace lockstone::test {

struct SeenPart {
  std::uint32_t index = 0;
  geometry::TriangleVertices vertices{};
  geometry::TriangleTopology topology{};
  const Surface* surface = nullptr;
};

inline SeenPart seen(const geometry::Part& part) {
  const auto v = part.polytope->vertices;
  return {part.index, {v[0], v[1], v[2]}, part.triangle, part.surface};
}

class CollectParts final : public geometry::PartVisitor {
 public:
  CollectParts() : PartVisitor(true) {}

  std::vector<SeenPart> parts;
  void visit(const geometry::Part& part) override { parts.push_back(seen(part)); }
};

/// Never shortens the ray.
class CollectRayParts final : public geometry::WayPartVisitor {
 public:
  std::vector<std::uint32_t> parts;
  Unit visit(const geometry::Part& part) override {
    parts.push_back(part.index);
    return Unit::from_integer(1);
  }
};

inline std::vector<SeenPart> all_parts(const Asset& asset) {
  CollectParts collect;
  asset.geometry().visit_parts(asset.geometry().bounds(), collect);
  return collect.parts;
}

struct Triangles {
  std::vector<Vec3<Length>> vertices;
  std::vector<TriangleIndices> triangles;

  [[nodiscard]] MeshDef def() const {
    MeshDef def;
    def.vertices = vertices;
    def.triangles = triangles;
    return def;
  }
};

/// Twelve triangles that face outward, or inward.
inline Triangles cube(double half, bool inverted = false) {
  Triangles cube;
  for (int i = 0; i < 8; ++i) {
    cube.vertices.push_back(metres((i & 1) != 0 ? half : -half, (i & 2) != 0 ? half : -half,
                                   (i & 4) != 0 ? half : -half));
  }
  const std::array<std::array<std::uint32_t, 4>, 6> faces{
      {{0, 4, 6, 2}, {1, 3, 7, 5}, {0, 1, 5, 4}, {2, 6, 7, 3}, {0, 2, 3, 1}, {4, 5, 7, 6}}};
  for (const auto& [a, b, c, d] : faces) {
    cube.triangles.push_back(inverted ? TriangleIndices{a, c, b} : TriangleIndices{a, b, c});
    cube.triangles.push_back(inverted ? TriangleIndices{a, d, c} : TriangleIndices{a, c, d});
  }
  return cube;
}

/// (columns − 1) · (rows − 1) cells on x and z, y up, split like a height field; height(i, j).
template <class Height>
Triangles grid(int columns, int rows, double cell, Height height) {
  Triangles grid;
  const auto at = [columns](int i, int j) { return static_cast<std::uint32_t>(j * columns + i); };
  for (int j = 0; j < rows; ++j) {
    for (int i = 0; i < columns; ++i) {
      Vec3<Length> v = metres(0, height(i, j), 0);
      v.x = metres(cell) * i;
      v.z = metres(cell) * j;
      grid.vertices.push_back(v);
    }
  }
  for (int j = 0; j + 1 < rows; ++j) {
    for (int i = 0; i + 1 < columns; ++i) {
      grid.triangles.push_back({at(i, j), at(i, j + 1), at(i + 1, j + 1)});
      grid.triangles.push_back({at(i, j), at(i + 1, j + 1), at(i + 1, j)});
    }
  }
  return grid;
}

inline Triangles random_triangles(Dice& dice, int count, double extent, double size) {
  Triangles soup;
  for (int i = 0; i < count; ++i) {
    const double x = dice.uniform(-extent, extent);
    const double y = dice.uniform(-extent, extent);
    const double z = dice.uniform(-extent, extent);
    for (int k = 0; k < 3; ++k) {
      soup.vertices.push_back(metres(x + dice.uniform(-size, size), y + dice.uniform(-size, size),
                                     z + dice.uniform(-size, size)));
    }
    const auto first = static_cast<std::uint32_t>(3 * i);
    soup.triangles.push_back({first, first + 1, first + 2});
  }
  return soup;
}

inline geometry::LocalBounds random_region(Dice& dice, double extent, double size) {
  const double x = dice.uniform(-extent, extent);
  const double y = dice.uniform(-extent, extent);
  const double z = dice.uniform(-extent, extent);
  return {metres(x, y, z),
          metres(x + dice.uniform(0, size), y + dice.uniform(0, size), z + dice.uniform(0, size))};
}

/// Whether a ray meets a box, in long double: then a conservative test
/// must not miss it.
inline bool surely_meets(const Vec3<Length>& origin, const Vec3<Length>& way,
                         const geometry::LocalBounds& box) {
  long double enter = 0;
  long double leave = 1;
  for (int axis = 0; axis < 3; ++axis) {
    const long double o = origin[axis].raw;
    const long double d = way[axis].raw;
    const long double low = box.lower[axis].raw - o;
    const long double high = box.upper[axis].raw - o;
    if (d == 0) {
      if (low > 0 || high < 0) return false;
      continue;
    }
    enter = std::max(enter, std::min(low / d, high / d));
    leave = std::min(leave, std::max(low / d, high / d));
  }
  return enter <= leave;
}

}  // namespace lockstone::test
