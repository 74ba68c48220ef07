// The convex parts that assets consist of, as visitors see them.
#pragma once

#include <cstdint>

#include <lockstone/asset.h>
#include <lockstone/quat.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/convex/polytope.h"

namespace lockstone::geometry {

/// A closed box in an asset's frame.
struct LocalBounds {
  Vec3<Length> lower{};
  Vec3<Length> upper{};

  friend constexpr bool operator==(const LocalBounds&, const LocalBounds&) = default;
};

[[nodiscard]] constexpr bool overlap(const LocalBounds& a, const LocalBounds& b) {
  return a.lower.x <= b.upper.x && b.lower.x <= a.upper.x && a.lower.y <= b.upper.y &&
         b.lower.y <= a.upper.y && a.lower.z <= b.upper.z && b.lower.z <= a.upper.z;
}

/// The bounds of a polytope's vertices and its radius.
[[nodiscard]] constexpr LocalBounds bounds_of(const Polytope& polytope) {
  LocalBounds bounds{polytope.vertices.front(), polytope.vertices.front()};
  for (const Vec3<Length>& v : polytope.vertices) {
    for (int i = 0; i < 3; ++i) {
      bounds.lower[i] = min(bounds.lower[i], v[i]);
      bounds.upper[i] = max(bounds.upper[i], v[i]);
    }
  }
  for (int i = 0; i < 3; ++i) {
    bounds.lower[i] -= polytope.radius;
    bounds.upper[i] += polytope.radius;
  }
  return bounds;
}

/// How a triangle's edges and vertices may be met. An edge is inactive where its neighbour
/// continues it flat or concave: there only the faces push. Bit i: edge from vertex i to i + 1.
struct TriangleTopology {
  bool is_triangle = false;
  std::uint8_t active_edges = 0;     ///< bits 0 … 2; of height fields if `wants_edges`
  std::uint8_t active_vertices = 0;  ///< bits 0 … 2: vertices with at least one active edge
};

/// The number of the first triangle of an asset that has convex parts too: those have lower ones.
/// Keys of groups of triangles (MeshManifold::key) are above it, in every asset.
inline constexpr std::uint32_t k_first_triangle_part = 256;

/// A convex piece. Valid only during the visit.
struct Part {
  std::uint32_t index = 0;             ///< triangle, cell half or child: stable, ascending
  Shape shape{};                       ///< sphere, capsule, box or hull
  const Polytope* polytope = nullptr;  ///< of a hull or a triangle
  Vec3<Length> position{};             ///< of its origin in the asset's frame
  Mat3 rotation{};                     ///< its axes in the asset's frame
  const Surface* surface = nullptr;    ///< null: the body's own
  TriangleTopology triangle{};
};

class PartVisitor {
 public:
  virtual void visit(const Part& part) = 0;

  /// Whether it asks for active edges, which height fields compute for each visit.
  [[nodiscard]] bool wants_edges() const { return wants_edges_; }

 protected:
  explicit PartVisitor(bool wants_edges = false) : wants_edges_(wants_edges) {}
  ~PartVisitor() = default;

 private:
  bool wants_edges_;
};

class WayPartVisitor {
 public:
  /// Returns the fraction of the path beyond which no more parts are wanted, which never grows.
  virtual Unit visit(const Part& part) = 0;

 protected:
  ~WayPartVisitor() = default;
};

class NearPartVisitor {
 public:
  /// Returns the distance beyond which no more parts are wanted, which never grows.
  virtual Length visit(const Part& part) = 0;

 protected:
  ~NearPartVisitor() = default;
};

}  // namespace lockstone::geometry
