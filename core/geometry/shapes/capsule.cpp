// Capsules: size.x is the radius, size.y half the length of the core, along y.
#include "core/geometry/contact/half_space/plane_meeting.h"
#include "core/geometry/convex/mass_arithmetic.h"
#include "core/geometry/distance/cores/convex_core.h"
#include "core/geometry/shapes/ball_swept.h"
#include "core/geometry/shapes/shape_table.h"

namespace lockstone::geometry {
namespace {

constexpr std::uint64_t k_two_thirds_pi = 4829346305384748562U;  // 61 fraction bits

/// r²(3h + 2r), 60 fraction bits.
UInt128 capsule_product(const Sizes& size) {
  const std::uint64_t heights = 3 * raw_of(size.y) + 2 * raw_of(size.x);
  return multiply_wide(square(raw_of(size.x)), heights);
}

Length capsule_reach_radius(const Sizes& size) {
  return size.x + size.y;
}

Length capsule_inner_radius(const Sizes& size) {
  return size.x;
}

Sizes capsule_extents(const Sizes& size, const Mat3& rotation) {
  Sizes result;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t core = (abs(rotation.y[axis]) * size.y).raw;
    result[axis] = rounded_up(core + (Unit::from_integer(1) * size.x).raw);
  }
  return result;
}

/// r and h are fractions of the scale, 30 bits. With cylinder and ball weighed 3h : 2r,
///   about the axis   r²(15h + 8r) / (10(3h + 2r))
///   across it        (20h³ + 40h²r + 45hr² + 16r³) / (20(3h + 2r)).
Vec3<Unit> capsule_inertia(const ScaledSizes& size) {
  const std::uint64_t r = size[0], h = size[1];
  const UInt128 axial = multiply_wide(square(r), 2 * (15 * h + 8 * r));
  const UInt128 across =
      multiply_wide(square(h), 20 * h + 40 * r) + multiply_wide(square(r), 45 * h + 16 * r);
  const std::uint64_t divisor = 20 * (3 * h + 2 * r);
  const auto moment = [divisor](UInt128 numerator) {
    return moment_of(round_shift(UInt128{0, round_divide(numerator, divisor)}, 30).low);
  };
  return {moment(across), moment(axial), moment(across)};
}

Fine capsule_reach(const Sizes& size, const Vec3<Unit>& n) {
  return fine(size.x) + (abs(n.y) * size.y).raw;
}

/// The nearest point of the core is the ball's centre.
bool capsule_holds(const Sizes& size, const Vec3<Length>& point, Length slack) {
  const Vec3<Length> from_core{point.x, point.y - clamp(point.y, -size.y, size.y), point.z};
  return is_in_ball(from_core, size.x + slack);
}

std::optional<std::uint32_t> capsule_vertex_at(const Sizes& size, const RawVec& point) {
  if (!is_at(magnitude_of(point.y), fine(size.y))) return std::nullopt;
  return point.y > 0 ? 1U : 0U;
}

int capsule_vertices(const Sizes& size, std::array<RawVec, 8>& out) {
  out[0] = {0, -fine(size.y), 0};
  out[1] = {0, fine(size.y), 0};
  return 2;
}

Sizes capsule_shortened(const Sizes& size, Unit share) {
  return {size.x, rounded<Length>(size.y * share), {}};
}

void capsule_core(const PosedShape& shape, ConvexCore& core) {
  core.radius = shape.shape.size.x;
  add_generator(core, along(shape.rotation.y, shape.shape.size.y));
}

}  // namespace

Mass ball_swept_mass(const Sizes& size, Density density) {
  return mass_with_factor(capsule_product(size), density, k_two_thirds_pi, 61);
}

BlockFloat ball_swept_volume(const Sizes& size) {
  return volume_with_factor(capsule_product(size), k_two_thirds_pi, 61);
}

Sizes ball_swept_shrunk(const Sizes& size, Length depth) {
  return {size.x - depth, size.y, {}};
}

Vec3<Unit> round_face_along(const Sizes& /*size*/, const Vec3<Unit>& axis) {
  return axis;
}

bool is_in_ball(const Vec3<Length>& from_centre, Length radius) {
  std::uint64_t squares = 0;
  for (int i = 0; i < 3; ++i) {
    if (abs(from_centre[i]) > radius) return false;
    squares += static_cast<std::uint64_t>((from_centre[i] * from_centre[i]).raw);  // below 2^61
  }
  return squares <= static_cast<std::uint64_t>((radius * radius).raw);
}

const ShapeTraits k_capsule{
    .size_names = {"radius", "half_height", ""},
    .size_count = 2,
    .has_core_radius = true,
    .bounding_radius = capsule_reach_radius,
    .inner_radius = capsule_inner_radius,
    .half_extents = capsule_extents,
    .mass = ball_swept_mass,
    .volume = ball_swept_volume,
    .inertia = capsule_inertia,
    .reach = capsule_reach,
    .holds = capsule_holds,
    .face_along = round_face_along,
    .vertex_at = capsule_vertex_at,
    .vertices = capsule_vertices,
    .shrunk = ball_swept_shrunk,
    .shortened = capsule_shortened,
    .make_core = capsule_core,
    .below_plane = below_capsule,
};

}  // namespace lockstone::geometry
