#include "core/geometry/convex/polytope_columns.h"

namespace lockstone::geometry {
namespace {

std::size_t padded(std::size_t count) {
  return (count + lanes::k_point_step - 1) / lanes::k_point_step * lanes::k_point_step;
}

/// Three columns one after the other. The last places hold the first item once more, which is the
/// first of equals never but itself.
template <class Items, class VectorOf>
lanes::PointColumns fill_columns(std::vector<std::int32_t>& out, const Items& items,
                                 const VectorOf& vector_of) {
  const std::size_t count = padded(items.size());
  out.resize(3 * count);
  for (std::size_t i = 0; i < count; ++i) {
    const auto& v = vector_of(items[i < items.size() ? i : 0]);
    out[i] = v.x.raw;
    out[count + i] = v.y.raw;
    out[2 * count + i] = v.z.raw;
  }
  return {out.data(), out.data() + count, out.data() + 2 * count, count};
}

}  // namespace

void PolytopeColumns::fill(std::span<const Vec3<Length>> vertices,
                           std::span<const PolytopeFace> faces, std::span<const HalfEdge> edges) {
  offsets_.assign(padded(faces.size()), faces.front().offset);
  for (std::size_t i = 0; i < faces.size(); ++i)
    offsets_[i] = faces[i].offset;
  leaving_.assign(vertices.size(), 0);
  for (std::size_t i = 0; i < edges.size(); ++i)
    leaving_[edges[i].origin] = static_cast<std::uint16_t>(i);
  lanes_ = {fill_columns(
                vertices_, vertices, [](const Vec3<Length>& v) -> const auto& { return v; }),
            fill_columns(
                normals_, faces, [](const PolytopeFace& f) -> const auto& { return f.normal; }),
            offsets_.data(), leaving_.data()};
}

}  // namespace lockstone::geometry
