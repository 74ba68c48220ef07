// Spheres: size.x is the radius.
#include "core/geometry/contact/half_space/plane_meeting.h"
#include "core/geometry/convex/mass_arithmetic.h"
#include "core/geometry/distance/cores/convex_core.h"
#include "core/geometry/shapes/ball_swept.h"
#include "core/geometry/shapes/shape_table.h"

namespace lockstone::geometry {
namespace {

Length sphere_radius(const Sizes& size) {
  return size.x;
}

Sizes sphere_extents(const Sizes& size, const Mat3& /*rotation*/) {
  return {size.x, size.x, size.x};
}

/// 2/5 r².
Vec3<Unit> sphere_inertia(const ScaledSizes& size) {
  const Unit moment = moment_share(2 * square(size[0]), 5);
  return {moment, moment, moment};
}

Fine sphere_reach(const Sizes& size, const Vec3<Unit>& /*n*/) {
  return fine(size.x);
}

bool sphere_holds(const Sizes& size, const Vec3<Length>& point, Length slack) {
  return is_in_ball(point, size.x + slack);
}

std::optional<std::uint32_t> sphere_vertex_at(const Sizes& /*size*/, const RawVec& /*point*/) {
  return 0;
}

int sphere_vertices(const Sizes& /*size*/, std::array<RawVec, 8>& out) {
  out[0] = {};
  return 1;
}

Sizes sphere_shortened(const Sizes& size, Unit /*share*/) {
  return size;
}

void sphere_core(const PosedShape& shape, ConvexCore& core) {
  core.radius = shape.shape.size.x;
}

}  // namespace

const ShapeTraits k_sphere{
    .size_names = {"radius", "", ""},
    .size_count = 1,
    .has_core_radius = true,
    .bounding_radius = sphere_radius,
    .inner_radius = sphere_radius,
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
