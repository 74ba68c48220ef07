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

Length capsule_reach_radius(const Shape& shape) {
  return shape.size.x + shape.size.y;
}

Sizes capsule_extents(const Shape& shape, const Mat3& rotation) {
  Sizes result;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t core = (abs(rotation.y[axis]) * shape.size.y).raw;
    result[axis] = rounded_up(core + (Unit::from_integer(1) * shape.size.x).raw);
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

Fine capsule_reach(const Shape& shape, const Vec3<Unit>& n) {
  return fine(shape.size.x) + (abs(n.y) * shape.size.y).raw;
}

/// The nearest point of the core is the ball's centre.
bool capsule_holds(const Shape& shape, const Vec3<Length>& point, Length slack) {
  const Vec3<Length> from_core{point.x, point.y - clamp(point.y, -shape.size.y, shape.size.y),
                               point.z};
  return is_in_ball(from_core, shape.size.x + slack);
}

std::optional<std::uint32_t> capsule_vertex_at(const Shape& shape, const RawVec& point) {
  if (!is_at(magnitude_of(point.y), fine(shape.size.y))) return std::nullopt;
  return point.y > 0 ? 1U : 0U;
}

int capsule_vertices(const Shape& shape, std::array<RawVec, 8>& out) {
  out[0] = {0, -fine(shape.size.y), 0};
  out[1] = {0, fine(shape.size.y), 0};
  return 2;
}

Shape capsule_shortened(const Shape& shape, Unit share) {
  return resized(shape, {shape.size.x, rounded<Length>(shape.size.y * share), {}});
}

void capsule_core(const PosedShape& shape, ConvexCore& core) {
  core.radius = shape.shape.size.x;
  add_generator(core, along(shape.rotation.y, shape.shape.size.y));
}

}  // namespace

Length ball_swept_radius(const Shape& shape) {
  return shape.size.x;
}

Mass ball_swept_mass(const Shape& shape, Density density) {
  return mass_with_factor(capsule_product(shape.size), density, k_two_thirds_pi, 61);
}

BlockFloat ball_swept_volume(const Shape& shape) {
  return volume_with_factor(capsule_product(shape.size), k_two_thirds_pi, 61);
}

Shape ball_swept_shrunk(const Shape& shape, Length depth) {
  return resized(shape, {shape.size.x - depth, shape.size.y, {}});
}

Vec3<Unit> round_face_along(const Shape& /*shape*/, const Vec3<Unit>& axis) {
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
    .core_radius = ball_swept_radius,
    .bounding_radius = capsule_reach_radius,
    .inner_radius = ball_swept_radius,
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
