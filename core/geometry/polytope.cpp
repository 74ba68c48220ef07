#include "core/geometry/polytope.h"

namespace lockstone::geometry {

Support support_of(const Polytope& polytope, const Vec3<Unit>& n) {
  Support best{0, lockstone::dot(polytope.vertices[0], n).raw};
  const int count = static_cast<int>(polytope.vertices.size());
  for (int i = 1; i < count; ++i) {
    const Fine height = lockstone::dot(polytope.vertices[static_cast<std::size_t>(i)], n).raw;
    if (height > best.height) best = {i, height};
  }
  return best;
}

int most_opposed_face(const Polytope& polytope, int vertex, const Vec3<Unit>& direction) {
  std::size_t first = 0;
  while (polytope.edges[first].origin != vertex)
    ++first;
  int best = polytope.edges[first].face;
  std::int64_t least =
      lockstone::dot(polytope.faces[static_cast<std::size_t>(best)].normal, direction).raw;
  std::uint16_t edge = next_edge(polytope, polytope.edges[first].twin);
  for (; edge != first; edge = next_edge(polytope, polytope.edges[edge].twin)) {
    const int face = polytope.edges[edge].face;
    const std::int64_t lean =
        lockstone::dot(polytope.faces[static_cast<std::size_t>(face)].normal, direction).raw;
    if (lean > least || (lean == least && face > best)) continue;
    best = face;
    least = lean;
  }
  return best;
}

}  // namespace lockstone::geometry
