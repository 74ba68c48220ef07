#include "core/geometry/distance/epa/expanding_polytope.h"

#include <algorithm>
#include <bit>

#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

constexpr int k_distance_bits = 30;

/// Distances of one plane, or of two that differ by less, are rounded apart by no more.
constexpr std::uint64_t k_same_distance = 2;

/// height / |normal| with k_distance_bits: relative error 2^-60 and half a last place. The height
/// is normal · vertex, not negative, |vertex| ≤ 2^30.
std::uint64_t plane_distance(const RawVec& normal, Int128 height) {
  LKS_ASSERT(!height.negative());
  const std::uint64_t all = magnitude(normal.x) | magnitude(normal.y) | magnitude(normal.z);
  LKS_ASSERT(all != 0);
  const int shift = std::max(0, std::countl_zero(all) - 2);
  const auto grown = [shift](std::int64_t x) { return x * (std::int64_t{1} << shift); };
  const std::uint64_t length = norm(grown(normal.x), grown(normal.y), grown(normal.z));
  return round_divide(height.bits() << (shift + k_distance_bits), length);
}

bool are_neighbours(const ExpandingFace& a, const ExpandingFace& b) {
  const auto is_of_b = [&b](std::uint8_t vertex) {
    return std::ranges::find(b.vertices, vertex) != b.vertices.end();
  };
  return std::ranges::count_if(a.vertices, is_of_b) == 2;
}

}  // namespace

ExpandingPolytope::ExpandingPolytope(const std::array<DifferenceVertex, 4>& tetrahedron) {
  for (const DifferenceVertex& vertex : tetrahedron)
    vertices_[static_cast<std::size_t>(vertex_count_++)] = vertex;
  const RawVec normal = narrow_cross(point(1) - point(0), point(2) - point(0));
  const Int128 volume = wide_dot(normal, point(3) - point(0));
  LKS_ASSERT(!is_zero(volume));
  // Vertex 3 above the triangle 012 as seen counter-clockwise.
  if (volume.negative()) std::swap(vertices_[1], vertices_[2]);
  add_face(0, 2, 1);
  add_face(0, 1, 3);
  add_face(1, 2, 3);
  add_face(2, 0, 3);
}

const ExpandingFace& ExpandingPolytope::nearest() const {
  std::size_t best = 0;
  for (std::size_t i = 1; i < static_cast<std::size_t>(face_count_); ++i) {
    if (faces_[i].distance < faces_[best].distance) best = i;
  }
  return faces_[best];
}

bool ExpandingPolytope::sees(const RawVec& from, const ExpandingFace& face) const {
  return is_positive(wide_dot(face.normal, from - point(face.vertices[0])));
}

bool ExpandingPolytope::sees_from_afar(const RawVec& from, const ExpandingFace& face,
                                       std::int64_t steps) const {
  const Int128 height = wide_dot(face.normal, from - point(face.vertices[0]));
  const std::uint64_t length = norm(face.normal.x, face.normal.y, face.normal.z);
  return is_positive(height - multiply_wide(static_cast<std::int64_t>(length), steps));
}

void ExpandingPolytope::add_face(std::uint8_t a, std::uint8_t b, std::uint8_t c) {
  LKS_ASSERT(face_count_ < k_max_expanding_faces);
  ExpandingFace& face = faces_[static_cast<std::size_t>(face_count_++)];
  face.vertices = {a, b, c};
  face.normal = narrow_cross(point(b) - point(a), point(c) - point(a));
  face.distance = plane_distance(face.normal, wide_dot(face.normal, point(a)));
}

/// An edge that comes both ways is inside the patch.
void ExpandingPolytope::Rim::add(Edge edge) {
  for (std::size_t i = 0; i < count; ++i) {
    if (edges[i].from != edge.to || edges[i].to != edge.from) continue;
    edges[i] = edges[--count];
    return;
  }
  edges[count++] = edge;
}

void ExpandingPolytope::remove_visible(const RawVec& vertex, Rim& rim) {
  int kept = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(face_count_); ++i) {
    const ExpandingFace& face = faces_[i];
    if (!sees(vertex, face)) {
      faces_[static_cast<std::size_t>(kept++)] = face;
      continue;
    }
    const auto& [a, b, c] = face.vertices;
    rim.add({a, b});
    rim.add({b, c});
    rim.add({c, a});
  }
  face_count_ = kept;
}

void ExpandingPolytope::expand(const DifferenceVertex& vertex) {
  LKS_ASSERT(!is_full());
  Rim rim;
  remove_visible(vertex.point, rim);
  LKS_ASSERT(rim.count >= 3);
  const auto added = static_cast<std::uint8_t>(vertex_count_);
  vertices_[static_cast<std::size_t>(vertex_count_++)] = vertex;
  for (std::size_t i = 0; i < rim.count; ++i)
    add_face(rim.edges[i].from, rim.edges[i].to, added);
}

bool ExpandingPolytope::is_valley(const ExpandingFace& face) const {
  for (std::size_t i = 0; i < static_cast<std::size_t>(face_count_); ++i) {
    const ExpandingFace& other = faces_[i];
    if (other.distance > face.distance || &other == &face) continue;
    if (other.distance == face.distance && &other > &face) continue;
    if (are_neighbours(face, other)) return false;
  }
  return true;
}

int ExpandingPolytope::find_valleys(std::span<const ExpandingFace*> valleys) const {
  std::size_t count = 0;
  for (std::size_t i = 0; i < static_cast<std::size_t>(face_count_); ++i) {
    const ExpandingFace& face = faces_[i];
    if (count == valleys.size() && face.distance >= valleys.back()->distance) continue;
    if (!is_valley(face)) continue;
    count = std::min(count + 1, valleys.size());
    std::size_t place = count - 1;
    for (; place > 0 && valleys[place - 1]->distance > face.distance; --place)
      valleys[place] = valleys[place - 1];
    valleys[place] = &face;
  }
  return static_cast<int>(count);
}

Simplex ExpandingPolytope::simplex_of(const ExpandingFace& face) const {
  const auto& [a, b, c] = face.vertices;
  return {3, {vertices_[a], vertices_[b], vertices_[c]}, face.normal};
}

bool ExpandingPolytope::holds_foot(const ExpandingFace& face) const {
  const auto& [a, b, c] = face.vertices;
  const TriangleWeights weights = weights_of(point(a), point(b), point(c));
  return std::ranges::none_of(weights.numerators, [](Int128 w) { return w.negative(); });
}

const ExpandingFace& ExpandingPolytope::foot_face(const ExpandingFace& face) const {
  if (holds_foot(face)) return face;
  for (std::size_t i = 0; i < static_cast<std::size_t>(face_count_); ++i) {
    if (faces_[i].distance > face.distance + k_same_distance) continue;
    if (holds_foot(faces_[i])) return faces_[i];
  }
  return face;
}

}  // namespace lockstone::geometry
