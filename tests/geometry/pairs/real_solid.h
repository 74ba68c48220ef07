// Convex solids in long double: distance by features, overlap by all separating axes.
#pragma once

#include "core/geometry/convex/polytope.h"
#include "tests/geometry/pairs/test_polytope.h"
#include "tests/geometry/scene.h"

namespace lockstone::test {

/// A convex core by its features, and a radius about it.
struct RealSolid {
  std::vector<RealVec> vertices;
  std::vector<std::vector<RealVec>> faces;
  std::vector<RealVec> normals;
  std::vector<RealSegment> edges;
  Real radius = 0;

  [[nodiscard]] Real reach(const RealVec& n) const {
    Real most = -1e30L;
    for (const RealVec& v : vertices)
      most = std::max(most, dot(v, n));
    return most + radius;
  }
};

inline RealSolid real_polytope(const geometry::Polytope& p, const Mat3& rotation,
                               const RealVec& at) {
  RealSolid result;
  const std::array<RealVec, 3> axes{real(rotation.x), real(rotation.y), real(rotation.z)};
  const auto turned_by = [&axes](const RealVec& v) {
    return axes[0] * v.x + axes[1] * v.y + axes[2] * v.z;
  };
  for (const auto& v : p.vertices)
    result.vertices.push_back(at + turned_by(real(v)));
  for (const auto& face : p.faces) {
    std::vector<RealVec> loop;
    for (int i = 0; i < face.edge_count; ++i) {
      const auto& half = p.edges[static_cast<std::size_t>(face.first_edge + i)];
      loop.push_back(result.vertices[half.origin]);
      const auto& end = p.edges[half.twin];
      if (half.origin < end.origin)
        result.edges.push_back({result.vertices[half.origin], result.vertices[end.origin]});
    }
    RealVec normal;
    for (std::size_t i = 1; i + 1 < loop.size(); ++i)
      normal = normal + cross(loop[i] - loop[0], loop[i + 1] - loop[0]);
    result.normals.push_back(normal * (1 / norm(normal)));
    result.faces.push_back(loop);
  }
  return result;
}

inline RealSolid real_solid(const PosedShape& posed, const RealVec& at) {
  if (posed.polytope != nullptr) return real_polytope(*posed.polytope, posed.rotation, at);
  const Placed placed(posed, at);
  RealSolid result;
  result.radius = placed.radius();
  if (posed.shape.kind == ShapeKind::sphere) {
    result.vertices = {at};
  } else if (posed.shape.kind == ShapeKind::capsule) {
    result.vertices = {placed.end(-1), placed.end(1)};
    result.edges = {{placed.end(-1), placed.end(1)}};
  } else {
    const TestPolytope box(box_points(static_cast<double>(placed.size.x),
                                      static_cast<double>(placed.size.y),
                                      static_cast<double>(placed.size.z)));
    return real_polytope(box.view(), posed.rotation, at);
  }
  return result;
}

inline Real point_to_polygon(const RealVec& p, const std::vector<RealVec>& loop,
                             const RealVec& normal) {
  for (std::size_t i = 0; i < loop.size(); ++i) {
    const RealVec side = cross(loop[(i + 1) % loop.size()] - loop[i], normal);
    if (dot(side, p - loop[i]) > 0) return 1e30L;
  }
  return std::fabs(dot(p - loop[0], normal));
}

inline Real distance_by_features(const RealSolid& a, const RealSolid& b) {
  Real best = 1e30L;
  for (const RealVec& v : a.vertices) {
    for (std::size_t i = 0; i < b.faces.size(); ++i)
      best = std::min(best, point_to_polygon(v, b.faces[i], b.normals[i]));
    for (const RealSegment& e : b.edges)
      best = std::min(best, point_to_segment(v, e.from, e.to));
  }
  for (const RealVec& v : b.vertices) {
    for (std::size_t i = 0; i < a.faces.size(); ++i)
      best = std::min(best, point_to_polygon(v, a.faces[i], a.normals[i]));
    for (const RealSegment& e : a.edges)
      best = std::min(best, point_to_segment(v, e.from, e.to));
  }
  for (const RealSegment& e : a.edges)
    for (const RealSegment& f : b.edges)
      best = std::min(best, segment_to_segment(e.from, e.to, f.from, f.to));
  return best;
}

/// Of the cores: the greatest over the normals of both and all products of edges.
inline Real separation_by_axes(const RealSolid& a, const RealSolid& b) {
  Real best = -1e30L;
  const auto look_at = [&](const RealVec& n) {
    best = std::max(best, -b.reach(n * -1) + b.radius - a.reach(n) + a.radius);
  };
  for (const RealVec& n : a.normals)
    look_at(n);
  for (const RealVec& n : b.normals)
    look_at(n * -1);
  for (const RealSegment& e : a.edges)
    for (const RealSegment& f : b.edges) {
      const RealVec k = cross(e.to - e.from, f.to - f.from);
      const Real length = norm(k);
      if (length < 1e-9L * norm(e.to - e.from) * norm(f.to - f.from)) continue;
      look_at(k * (1 / length));
      look_at(k * (-1 / length));
    }
  return best;
}

/// Distance when apart; minus the least overlap of cores and the radii otherwise.
inline Real signed_distance(const RealSolid& a, const RealSolid& b) {
  const Real axes = separation_by_axes(a, b);
  return (axes > 0 ? distance_by_features(a, b) : axes) - a.radius - b.radius;
}

/// How far a point is from the surface, outside or inside.
inline Real surface_distance(const RealSolid& solid, const RealVec& p) {
  RealSolid point;
  point.vertices = {p};
  Real inside = -1e30L;
  for (std::size_t i = 0; i < solid.normals.size(); ++i)
    inside = std::max(inside, dot(p - solid.faces[i][0], solid.normals[i]));
  if (solid.faces.size() > 2 && inside <= 0) return std::fabs(inside);
  if (solid.vertices.size() == 1) return std::fabs(norm(p - solid.vertices[0]) - solid.radius);
  return std::fabs(distance_by_features(solid, point) - solid.radius);
}

/// How far the point of a ball around an end of a capsule's core may be within its side.
inline Real lean_slack(const RealSolid& solid, const RealVec& normal) {
  if (solid.vertices.size() != 2) return 0;
  const RealVec core = solid.vertices[1] - solid.vertices[0];
  return end_within_side(solid.radius, dot(core, normal) / norm(core));
}

}  // namespace lockstone::test
