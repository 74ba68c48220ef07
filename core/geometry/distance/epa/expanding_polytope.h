// A polytope inside B − A that grows towards its boundary where that is nearest to the origin.
//
// Van den Bergen, Proximity queries and penetration depth computation on 3D game objects (2001),
// with exact orientation on the lattice in place of his guards against rounding: signs decide which
// faces a vertex sees, so the visible faces are one patch, its rim is one loop, and no new face is
// degenerate (a face in line with the rim's edge would not have been visible).
#pragma once

#include <array>
#include <cstdint>
#include <span>

#include "core/base/unset_array.h"
#include "core/geometry/distance/gjk/simplex.h"

namespace lockstone::geometry {

inline constexpr int k_max_expanding_vertices = 128;
inline constexpr int k_max_expanding_faces = 2 * k_max_expanding_vertices - 4;

/// A triangle, counter-clockwise seen from outside.
struct ExpandingFace {
  std::array<std::uint8_t, 3> vertices{};
  RawVec normal{};             ///< outward, exact
  std::uint64_t distance = 0;  ///< of its plane from the origin, lattice steps, 30 fraction bits
};

class ExpandingPolytope {
 public:
  /// Four vertices that are not in one plane, the origin within or on their tetrahedron.
  explicit ExpandingPolytope(const std::array<DifferenceVertex, 4>& tetrahedron);

  /// The face nearest to the origin, the first of equals.
  [[nodiscard]] const ExpandingFace& nearest() const;

  /// Whether `point` is strictly outside the plane of `face`, exact.
  [[nodiscard]] bool sees(const RawVec& point, const ExpandingFace& face) const;

  /// Whether it is farther outside than `steps` of the lattice.
  [[nodiscard]] bool sees_from_afar(const RawVec& point, const ExpandingFace& face,
                                    std::int64_t steps) const;

  [[nodiscard]] bool is_full() const { return vertex_count_ == k_max_expanding_vertices; }
  [[nodiscard]] int vertex_count() const { return vertex_count_; }

  /// Faces none of whose neighbours is nearer to the origin, nearest first; returns their number,
  /// at most that of `valleys`. Of equal neighbours the first.
  int find_valleys(std::span<const ExpandingFace*> valleys) const;

  /// Adds a vertex that sees a face. Not when full.
  void expand(const DifferenceVertex& vertex);

  /// Whether the foot of the origin on its plane is in the face.
  [[nodiscard]] bool holds_foot(const ExpandingFace& face) const;

  /// `face` if it holds the foot of the origin; else the first face that does and is as near, by
  /// rounded distances: it may be in another plane, which nothing says supports the difference.
  /// `face` when there is none.
  [[nodiscard]] const ExpandingFace& foot_face(const ExpandingFace& face) const;

  [[nodiscard]] Simplex simplex_of(const ExpandingFace& face) const;

 private:
  struct Edge {
    std::uint8_t from = 0;
    std::uint8_t to = 0;
  };
  struct Rim {
    UnsetArray<Edge, static_cast<std::size_t>(3 * k_max_expanding_faces)> edges;
    std::size_t count = 0;
    void add(Edge edge);
  };

  [[nodiscard]] const RawVec& point(std::uint8_t vertex) const { return vertices_[vertex].point; }
  void add_face(std::uint8_t a, std::uint8_t b, std::uint8_t c);
  /// Removes the faces that `vertex` sees; their rim.
  void remove_visible(const RawVec& vertex, Rim& rim);
  [[nodiscard]] bool is_valley(const ExpandingFace& face) const;

  int vertex_count_ = 0;
  int face_count_ = 0;
  UnsetArray<DifferenceVertex, k_max_expanding_vertices> vertices_;
  UnsetArray<ExpandingFace, k_max_expanding_faces> faces_;
};

}  // namespace lockstone::geometry
