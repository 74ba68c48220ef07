// Spheres: size.x is the radius.
#include "core/geometry/contact/half_space/plane_meeting.h"
#include "core/geometry/convex/mass_arithmetic.h"
#include "core/geometry/distance/cores/convex_core.h"
#include "core/geometry/shapes/ball_swept.h"
#include "core/geometry/shapes/shape_table.h"

namespace lockstone::geometry {
namespace {

Sizes sphere_extents(const Shape& shape, const Mat3& /*rotation*/) {
  return {shape.size.x, shape.size.x, shape.size.x};
}

/// 2/5 r².
Vec3<Unit> sphere_inertia(const ScaledSizes& size) {
  const Unit moment = moment_share(2 * square(size[0]), 5);
  return {moment, moment, moment};
}

Fine sphere_reach(const Shape& shape, const Vec3<Unit>& /*n*/) {
  return fine(shape.size.x);
}

bool sphere_holds(const Shape& shape, const Vec3<Length>& point, Length slack) {
  return is_in_ball(point, shape.size.x + slack);
}

std::optional<std::uint32_t> sphere_vertex_at(const Shape& /*shape*/, const RawVec& /*point*/) {
  return 0;
}

int sphere_vertices(const Shape& /*shape*/, std::array<RawVec, 8>& out) {
  out[0] = {};
  return 1;
}

Shape sphere_shortened(const Shape& shape, Unit /*share*/) {
  return shape;
}

void sphere_core(const PosedShape& shape, ConvexCore& core) {
  core.radius = shape.shape.size.x;
}

}  // namespace

const ShapeTraits k_sphere{
    .size_names = {"radius", "", ""},
    .size_count = 1,
    .core_radius = ball_swept_radius,
    .bounding_radius = ball_swept_radius,
    .inner_radius = ball_swept_radius,
    .half_extents = sphere_extents,
    .mass = ball_swept_mass,
    .volume = ball_swept_volume,
    .inertia = sphere_inertia,
    .reach = sphere_reach,
    .holds = sphere_holds,
    .face_along = round_face_along,
    .vertex_at = sphere_vertex_at,
    .vertices = sphere_vertices,
    .shrunk = ball_swept_shrunk,
    .shortened = sphere_shortened,
    .make_core = sphere_core,
    .below_plane = below_sphere,
};

}  // namespace lockstone::geometry
