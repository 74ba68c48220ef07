// Half-space against every bounded solid.
#include <algorithm>
#include <array>

#include <lockstone/assert.h>

#include "core/base/unset_array.h"
#include "core/geometry/contact/collide_pairs.h"
#include "core/geometry/contact/feature/contact_feature.h"
#include "core/geometry/contact/half_space/plane_meeting.h"
#include "core/geometry/contact/manifold/manifold_reduction.h"
#include "core/geometry/convex/polytope.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/distance/contact_point.h"
#include "core/geometry/distance/manifold_checks.h"
#include "core/geometry/numeric/normals.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

/// `point` relative to A's centre, `height` above the plane.
void add_below(Manifold& manifold, const PlaneMeeting& plane, const RawVec& point, Fine height,
               std::uint32_t feature) {
  add_point_on(plane.b.shape, manifold, {point - along(plane.normal, height), point}, plane.offset,
               height, plane.margin, feature);
}

/// Vertices of one face, in a frame on the plane.
struct LowPolygon {
  std::array<FaceVertex, k_max_polytope_face_edges> vertices;
  UnsetArray<RawVec, k_max_polytope_face_edges> points;  ///< relative to B's centre, world axes
  int count = 0;
  int shift = k_fine_per_length + 3;  ///< coordinates within ±4096 m differ by less than 2^30 so

  void add(const PlaneMeeting& plane, const Vec3<Unit>& u, const Vec3<Unit>& v, const RawVec& point,
           std::uint32_t feature) {
    const auto i = static_cast<std::size_t>(count++);
    points[i] = point;
    vertices[i] = {dot(point, u), dot(point, v), plane.centre_height + dot(point, plane.normal),
                   feature};
  }
};

Manifold manifold_of(const PlaneMeeting& plane, LowPolygon& polygon) {
  const std::span all = std::span(polygon.vertices).first(static_cast<std::size_t>(polygon.count));
  std::array<FaceVertex, k_max_polytope_face_edges> before;
  std::copy(all.begin(), all.end(), before.begin());
  const int near = drop_far_vertices(all, plane.margin);
  const int kept = reduce_to_four(all.first(static_cast<std::size_t>(near)), polygon.shift);
  LKS_ASSERT(kept <= near && near <= polygon.count);
  Manifold manifold;
  manifold.normal = plane.normal;
  for (int k = 0; k < kept; ++k) {
    const FaceVertex& v = all[static_cast<std::size_t>(k)];
    std::size_t i = 0;
    while (before[i].feature != v.feature)
      ++i;
    add_below(manifold, plane, fine(plane.offset) + polygon.points[i], v.z, v.feature);
  }
  LKS_ASSERT(is_manifold(manifold));
  return manifold;
}

/// The face turned most towards the plane, of the three at a box's deepest vertex.
void box_face(const PlaneMeeting& plane, const Vec3<Unit>& u, const Vec3<Unit>& v,
              LowPolygon& polygon) {
  const Mat3& rotation = plane.b.rotation;
  std::array<std::int64_t, 3> leans{};
  int axis = 0;
  for (int k = 0; k < 3; ++k) {
    leans[static_cast<std::size_t>(k)] = lockstone::dot(rotation.column(k), plane.normal).raw;
    if (magnitude_of(leans[static_cast<std::size_t>(k)]) >
        magnitude_of(leans[static_cast<std::size_t>(axis)]))
      axis = k;
  }
  const bool negative = leans[static_cast<std::size_t>(axis)] > 0;
  for (std::uint32_t i = 0; i < 8; ++i) {
    if (((i >> axis & 1) != 0) != negative) continue;
    RawVec point;
    for (int k = 0; k < 3; ++k) {
      const RawVec step = along(rotation.column(k), plane.b.shape.size[k]);
      point = (i >> k & 1) != 0 ? point - step : point + step;
    }
    polygon.add(plane, u, v, point, i);
  }
  LKS_ASSERT(polygon.count == 4);
}

/// Likewise of a polytope.
void polytope_face(const PlaneMeeting& plane, const Vec3<Unit>& u, const Vec3<Unit>& v,
                   LowPolygon& polygon) {
  const Polytope& p = *plane.b.polytope;
  const Vec3<Unit> n = rotate_inverse(plane.b.rotation, plane.normal);
  const int face = most_opposed_face(p, support_of(p, -n).vertex, n);
  const PolytopeFace& f = p.faces[static_cast<std::size_t>(face)];
  LKS_ASSERT(f.edge_count >= 3);
  for (int i = 0; i < f.edge_count; ++i) {
    const int edge = f.first_edge + i;
    polygon.add(plane, u, v, rotate(plane.b.rotation, fine(start_of(p, edge))),
                p.edges[static_cast<std::size_t>(edge)].origin);
  }
}

template <class AddFace>
Manifold below_face(const PlaneMeeting& plane, AddFace&& add_face) {
  LowPolygon polygon;
  const Vec3<Unit> u = perpendicular_to(plane.normal);
  const Vec3<Unit> v = rounded<Unit>(cross(plane.normal, u));
  add_face(plane, u, v, polygon);
  return manifold_of(plane, polygon);
}

}  // namespace

Manifold below_sphere(const PlaneMeeting& plane) {
  const Length radius = plane.b.shape.size.x;
  Manifold manifold;
  manifold.normal = plane.normal;
  add_below(manifold, plane, fine(plane.offset) - along(plane.normal, radius),
            plane.centre_height - fine(radius), 0);
  return manifold;
}

Manifold below_capsule(const PlaneMeeting& plane) {
  const Length radius = plane.b.shape.size.x;
  const Length half = plane.b.shape.size.y;
  const Vec3<Unit>& axis = plane.b.rotation.y;
  Manifold manifold;
  manifold.normal = plane.normal;
  for (const int sign : {-1, 1}) {
    const RawVec end = along(axis, half * sign);
    const RawVec pole = fine(plane.offset) + end - along(plane.normal, radius);
    add_below(manifold, plane, pole, plane.centre_height + dot(end, plane.normal) - fine(radius),
              sign < 0 ? 0 : 1);
  }
  LKS_ASSERT(is_manifold(manifold));
  return manifold;
}

Manifold below_box(const PlaneMeeting& plane) {
  return below_face(plane, box_face);
}

Manifold below_points(const PlaneMeeting& plane, const ContactFeature& feature) {
  LKS_ASSERT(feature.count > 0);
  const auto add_points = [&feature](const PlaneMeeting& at, const Vec3<Unit>& u,
                                     const Vec3<Unit>& v, LowPolygon& polygon) {
    for (int i = 0; i < feature.count; ++i) {
      const FeaturePoint& point = feature.points[static_cast<std::size_t>(i)];
      polygon.add(at, u, v, point.at - along(at.normal, feature.radius), point.id);
    }
  };
  return below_face(plane, add_points);
}

Manifold collide_half_space(const PosedShape& half_space, const PosedShape& b,
                            const Vec3<Length>& offset, Length margin) {
  const Vec3<Unit> normal = unit_axis(half_space.rotation.y);
  const PlaneMeeting plane{normal, b, offset, margin, lockstone::dot(normal, offset).raw};
  LKS_ASSERT(b.polytope == nullptr || b.polytope->radius == Length{});
  const Manifold manifold = b.polytope != nullptr ? below_face(plane, polytope_face)
                                                  : traits_of(b.shape).below_plane(plane);
  return manifold.count > 0 ? manifold : Manifold{};
}

}  // namespace lockstone::geometry
