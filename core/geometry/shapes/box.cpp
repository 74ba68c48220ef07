// Boxes: the sizes are half extents.
#include "core/geometry/contact/half_space/plane_meeting.h"
#include "core/geometry/convex/mass_arithmetic.h"
#include "core/geometry/distance/cores/convex_core.h"
#include "core/geometry/shapes/box_core.h"
#include "core/geometry/shapes/shape_table.h"
#include "core/math/roots.h"

namespace lockstone::geometry {
namespace {

Length box_bounding_radius(const Shape& shape) {
  return root_up(norm_squared(shape.size));
}

Length box_inner_radius(const Shape& shape) {
  return min(min(shape.size.x, shape.size.y), shape.size.z);
}

Sizes box_extents(const Shape& shape, const Mat3& rotation) {
  const auto& [x, y, z] = shape.size;
  Sizes result;
  for (int axis = 0; axis < 3; ++axis) {
    const std::int64_t extent = (abs(rotation.y[axis]) * y).raw +
                                (abs(rotation.x[axis]) * x + abs(rotation.z[axis]) * z).raw;
    result[axis] = rounded_up(extent);
  }
  return result;
}

/// 2hx · 2hy · 2hz, 60 fraction bits.
UInt128 box_product(const Sizes& size) {
  return multiply_wide(raw_of(size.x) * raw_of(size.y), 8 * raw_of(size.z));
}

/// 60 + 8 fraction bits with the density, below 2^122.
Mass box_mass(const Shape& shape, Density density) {
  const UInt128 mass = multiply(box_product(shape.size), static_cast<std::uint32_t>(density.raw));
  return saturated_mass(round_shift(mass, 60 + Density::frac_bits - Mass::frac_bits));
}

BlockFloat box_volume(const Shape& shape) {
  return from_wide(box_product(shape.size), -3 * Length::frac_bits);
}

Vec3<Unit> box_inertia(const ScaledSizes& size) {
  const std::uint64_t x = square(size[0]), y = square(size[1]), z = square(size[2]);
  return {moment_share(y + z, 3), moment_share(z + x, 3), moment_share(x + y, 3)};
}

bool box_holds(const Shape& shape, const Vec3<Length>& point, Length slack) {
  for (int i = 0; i < 3; ++i)
    if (abs(point[i]) > shape.size[i] + slack) return false;
  return true;
}

Shape box_shrunk(const Shape& shape, Length depth) {
  return resized(shape, {shape.size.x - depth, shape.size.y - depth, shape.size.z - depth});
}

Shape box_shortened(const Shape& shape, Unit share) {
  return resized(shape, scaled_sizes(shape.size, share));
}

}  // namespace

Fine box_reach(const Shape& shape, const Vec3<Unit>& n) {
  return (shape.size.x * abs(n.x) + shape.size.y * abs(n.y) + shape.size.z * abs(n.z)).raw;
}

Vec3<Unit> box_face_along(const Shape& /*shape*/, const Vec3<Unit>& axis) {
  int longest = 0;
  for (int i = 1; i < 3; ++i)
    if (abs(axis[i]) > abs(axis[longest])) longest = i;
  return signed_axis(Mat3{}.column(longest), sign_of(axis[longest].raw));
}

std::optional<std::uint32_t> box_vertex_at(const Shape& shape, const RawVec& point) {
  const RawVec half = fine(shape.size);
  std::uint32_t vertex = 0;
  for (int axis = 0; axis < 3; ++axis) {
    if (!is_at(magnitude_of(point[axis]), half[axis])) return std::nullopt;
    vertex |= point[axis] > 0 ? 1U << axis : 0U;
  }
  return vertex;
}

int box_vertices(const Shape& shape, std::array<RawVec, 8>& out) {
  const RawVec h = fine(shape.size);
  for (unsigned i = 0; i < 8; ++i)
    out[i] = {(i & 1) != 0 ? h.x : -h.x, (i & 2) != 0 ? h.y : -h.y, (i & 4) != 0 ? h.z : -h.z};
  return 8;
}

void box_core(const PosedShape& shape, ConvexCore& core) {
  for (int i = 0; i < 3; ++i)
    add_generator(core, along(shape.rotation.column(i), shape.shape.size[i]));
}

const ShapeTraits k_box{
    .size_names = {"half_x", "half_y", "half_z"},
    .size_count = 3,
    .bounding_radius = box_bounding_radius,
    .inner_radius = box_inner_radius,
    .half_extents = box_extents,
    .mass = box_mass,
    .volume = box_volume,
    .inertia = box_inertia,
    .reach = box_reach,
    .holds = box_holds,
    .face_along = box_face_along,
    .vertex_at = box_vertex_at,
    .vertices = box_vertices,
    .shrunk = box_shrunk,
    .shortened = box_shortened,
    .make_core = box_core,
    .below_plane = below_box,
};

}  // namespace lockstone::geometry
