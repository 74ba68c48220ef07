// A polytope's vertices and planes by coordinate, as wide lanes read them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/geometry/convex/polytope.h"

namespace lockstone::geometry {

/// Keeps the columns; views stay valid until the next `fill` and through moves.
class PolytopeColumns {
 public:
  void fill(std::span<const Vec3<Length>> vertices, std::span<const PolytopeFace> faces,
            std::span<const HalfEdge> edges);

  [[nodiscard]] const PolytopeLanes& view() const { return lanes_; }

 private:
  std::vector<std::int32_t> vertices_;
  std::vector<std::int32_t> normals_;
  std::vector<Fine> offsets_;
  std::vector<std::uint16_t> leaving_;
  PolytopeLanes lanes_;
};

}  // namespace lockstone::geometry
