// The tetrahedron that EPA begins with.
#pragma once

#include <array>

#include "core/geometry/distance/gjk/gjk.h"

namespace lockstone::geometry {

/// Vertices of B − A in general position, up to four.
struct DifferenceFrame {
  int count = 0;
  std::array<DifferenceVertex, 4> vertices{};

  [[nodiscard]] const RawVec& point(std::size_t i) const { return vertices[i].point; }
  [[nodiscard]] RawVec edge(std::size_t i) const { return point(i) - point(0); }
  void add(const DifferenceVertex& vertex) { vertices[static_cast<std::size_t>(count++)] = vertex; }
};

/// The simplex of cores that overlap, with vertices for the dimensions that it lacks: less than
/// four only if the difference is flat.
[[nodiscard]] DifferenceFrame frame_of(const GapQuery& query);

}  // namespace lockstone::geometry
