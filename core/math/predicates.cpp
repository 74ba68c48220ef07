#include "core/math/predicates.h"

#include <algorithm>
#include <array>
#include <bit>

#include <lockstone/fixed.h>

#include "core/math/int128.h"

namespace lockstone {
namespace {

using Wide3 = Vec3<std::int64_t>;

Wide3 difference(const LatticePoint& a, const LatticePoint& b) {
  return {std::int64_t{a.x} - b.x, std::int64_t{a.y} - b.y, std::int64_t{a.z} - b.z};
}

/// Whether |components| ≤ 2^bits.
bool within(const Wide3& v, int bits) {
  const std::int64_t bound = std::int64_t{1} << bits;
  const auto inside = [bound](std::int64_t c) { return c >= -bound && c <= bound; };
  return inside(v.x) && inside(v.y) && inside(v.z);
}

int sign_of(std::int64_t x) {
  return x > 0 ? 1 : x < 0 ? -1 : 0;
}

int sign_of(const Int128& x) {
  return x.negative() ? -1 : x == Int128{} ? 0 : 1;
}

/// a·d − b·c for 33-bit differences.
Int128 minor_of(std::int64_t a, std::int64_t b, std::int64_t c, std::int64_t d) {
  return multiply_wide(a, d) - multiply_wide(b, c);
}

/// x · y, which must be below 2^127 in size.
Int128 multiply_mixed(const Int128& x, std::int64_t y) {
  const UInt128 size = magnitude(x);
  const std::uint64_t factor = magnitude(y);
  const UInt128 product = multiply_wide(size.low, factor) + UInt128{size.high * factor, 0};
  return Int128::from_bits(x.negative() != (y < 0) ? UInt128{} - product : product);
}

std::int64_t determinant_64(const Wide3& u, const Wide3& v, const Wide3& w) {
  return (u.y * v.z - u.z * v.y) * w.x + (u.z * v.x - u.x * v.z) * w.y +
         (u.x * v.y - u.y * v.x) * w.z;
}

/// u × v · w for differences of any 32-bit coordinates: below 2^102.
Int128 determinant_128(const Wide3& u, const Wide3& v, const Wide3& w) {
  return multiply_mixed(minor_of(u.y, u.z, v.y, v.z), w.x) +
         multiply_mixed(minor_of(u.z, u.x, v.z, v.x), w.y) +
         multiply_mixed(minor_of(u.x, u.y, v.x, v.y), w.z);
}

/// The sum of squares of 33-bit differences.
Int128 square_of(const Wide3& v) {
  return multiply_wide(v.x, v.x) + multiply_wide(v.y, v.y) + multiply_wide(v.z, v.z);
}

/// u × v up to positive factors: its components' signs, which is all that projections need.
std::array<int, 3> normal_signs(const Wide3& u, const Wide3& v) {
  return {sign_of(minor_of(u.y, u.z, v.y, v.z)), sign_of(minor_of(u.z, u.x, v.z, v.x)),
          sign_of(minor_of(u.x, u.y, v.x, v.y))};
}

constexpr int k_no_axis = -1;

/// An axis along which the plane of u and v can be projected without collapsing.
int projection_axis(const Wide3& u, const Wide3& v) {
  const std::array<int, 3> signs = normal_signs(u, v);
  for (int axis = 2; axis >= 0; --axis)
    if (signs[static_cast<std::size_t>(axis)] != 0) return axis;
  return k_no_axis;
}

/// The sign of the area of abc after dropping the axis: +1 for counter-clockwise.
int orient2d(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c, int axis) {
  const Wide3 u = difference(b, a), v = difference(c, a);
  return normal_signs(u, v)[static_cast<std::size_t>(axis)];
}

/// Whether p, known to be on the line ab, is between a and b or one of them.
bool between(const LatticePoint& a, const LatticePoint& b, const LatticePoint& p) {
  const auto inside = [](std::int32_t low, std::int32_t high, std::int32_t x) {
    return std::min(low, high) <= x && x <= std::max(low, high);
  };
  return inside(a.x, b.x, p.x) && inside(a.y, b.y, p.y) && inside(a.z, b.z, p.z);
}

bool is_on_segment(const LatticePoint& a, const LatticePoint& b, const LatticePoint& p) {
  const bool collinear = projection_axis(difference(b, a), difference(p, a)) == k_no_axis;
  return collinear && between(a, b, p);
}

/// Segments of one line: their intervals on each axis tell.
Contact collinear_contact(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                          const LatticePoint& d) {
  for (int axis = 0; axis < 3; ++axis) {
    const std::int32_t low = std::max(std::min(a[axis], b[axis]), std::min(c[axis], d[axis]));
    const std::int32_t high = std::min(std::max(a[axis], b[axis]), std::max(c[axis], d[axis]));
    if (low > high) return Contact::none;
    if (low < high) return Contact::overlap;
  }
  return Contact::touch;  // one common point on every axis
}

/// Segments of one plane, not of one line, seen along the axis.
Contact planar_contact(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                       const LatticePoint& d, int axis) {
  const int ab_c = orient2d(a, b, c, axis), ab_d = orient2d(a, b, d, axis);
  const int cd_a = orient2d(c, d, a, axis), cd_b = orient2d(c, d, b, axis);
  if (ab_c * ab_d < 0 && cd_a * cd_b < 0) return Contact::cross;
  const bool touches = (ab_c == 0 && between(a, b, c)) || (ab_d == 0 && between(a, b, d)) ||
                       (cd_a == 0 && between(c, d, a)) || (cd_b == 0 && between(c, d, b));
  return touches ? Contact::touch : Contact::none;
}

using Corners = std::array<LatticePoint, 3>;

/// How many of the segment's ends lie in the triangle and of its corners on the segment, counted as
/// different points: none, one, or two for more. Both sets are convex: two points share a stretch.
int common_points(const LatticePoint& p, const LatticePoint& q, const Corners& t) {
  std::array<LatticePoint, 5> found;
  std::size_t count = 0;
  for (const LatticePoint& end : {p, q})
    if (point_in_triangle(t[0], t[1], t[2], end) >= 0) found[count++] = end;
  for (const LatticePoint& corner : t)
    if (is_on_segment(p, q, corner)) found[count++] = corner;
  for (std::size_t i = 1; i < count; ++i)
    if (found[i] != found[0]) return 2;
  return count == 0 ? 0 : 1;
}

/// A segment in the plane of the triangle, or a flat triangle.
Contact coplanar_contact(const LatticePoint& p, const LatticePoint& q, const Corners& t,
                         bool is_flat) {
  const int points = common_points(p, q, t);
  if (points > 1) return Contact::overlap;
  for (std::size_t i = 0; i < 3; ++i) {
    const bool crosses = segment_segment(p, q, t[i], t[(i + 1) % 3]) == Contact::cross;
    if (crosses) return is_flat ? Contact::touch : Contact::overlap;
  }
  return points == 0 ? Contact::none : Contact::touch;
}

}  // namespace

int lattice_shift(std::uint64_t extent) {
  return extent == 0 ? 0
                     : std::max(0, static_cast<int>(std::bit_width(extent - 1)) - k_lattice_bits);
}

LatticePoint to_lattice(const Vec3<std::int64_t>& point, const Vec3<std::int64_t>& origin,
                        int shift) {
  const auto component = [shift](std::int64_t p, std::int64_t o) {
    const std::int64_t scaled = raw::round_shift_any(raw::subtract(p, o), shift);
    LKS_ASSERT(scaled == raw::saturate<std::int32_t>(scaled));
    return static_cast<std::int32_t>(scaled);
  };
  return {component(point.x, origin.x), component(point.y, origin.y), component(point.z, origin.z)};
}

int orient3d(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
             const LatticePoint& d) {
  const Wide3 u = difference(b, a), v = difference(c, a), w = difference(d, a);
  // Six products of three differences, each at most 2^60: below 2^63 in every partial sum.
  if (within(u, 20) && within(v, 20) && within(w, 20)) return sign_of(determinant_64(u, v, w));
  return sign_of(determinant_128(u, v, w));
}

int side_of_plane(const LatticePoint& normal, std::int64_t offset, const LatticePoint& p) {
  const auto product = [](std::int32_t a, std::int32_t b) {
    return Int128::from(std::int64_t{a} * b);
  };
  return sign_of(product(normal.x, p.x) + product(normal.y, p.y) + product(normal.z, p.z) -
                 Int128::from(offset));
}

int side_of_sphere(const LatticePoint& centre, std::int64_t radius, const LatticePoint& p) {
  LKS_ASSERT(radius >= 0);
  return sign_of(multiply_wide(radius, radius) - square_of(difference(p, centre)));
}

int side_of_circumsphere(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                         const LatticePoint& d, const LatticePoint& e) {
  const Wide3 p = difference(a, e), q = difference(b, e), r = difference(c, e),
              s = difference(d, e);
  LKS_ASSERT(within(p, 24) && within(q, 24) && within(r, 24) && within(s, 24));
  // The rows (difference, square), expanded by the squares. By Hadamard a minor is at most
  // (√3 · 2^24)³ and a square 3 · 2^48, so that the sum of four products is below 2^126.
  const auto term = [](const Wide3& square, const Wide3& u, const Wide3& v, const Wide3& w) {
    return multiply_mixed(determinant_128(u, v, w),
                          static_cast<std::int64_t>(square_of(square).low));
  };
  const Int128 sum = term(p, q, r, s) - term(q, p, r, s) + term(r, p, q, s) - term(s, p, q, r);
  return sign_of(sum) * orient3d(a, b, c, d);
}

int point_in_triangle(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                      const LatticePoint& p) {
  const int axis = projection_axis(difference(b, a), difference(c, a));
  if (axis == k_no_axis) {
    const bool on = is_on_segment(a, b, p) || is_on_segment(b, c, p) || is_on_segment(c, a, p);
    return on ? 0 : -1;
  }
  if (orient3d(a, b, c, p) != 0) return -1;
  const int turn = orient2d(a, b, c, axis);
  return std::min({turn * orient2d(a, b, p, axis), turn * orient2d(b, c, p, axis),
                   turn * orient2d(c, a, p, axis)});
}

Contact segment_segment(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                        const LatticePoint& d) {
  if (orient3d(a, b, c, d) != 0) return Contact::none;
  const Wide3 u = difference(b, a), v = difference(d, c), w = difference(c, a);
  for (const auto& [first, second] : {std::array{u, v}, std::array{u, w}, std::array{v, w}}) {
    const int axis = projection_axis(first, second);
    if (axis != k_no_axis) return planar_contact(a, b, c, d, axis);
  }
  return collinear_contact(a, b, c, d);
}

Contact segment_triangle(const LatticePoint& p, const LatticePoint& q, const LatticePoint& a,
                         const LatticePoint& b, const LatticePoint& c) {
  const bool is_flat = projection_axis(difference(b, a), difference(c, a)) == k_no_axis;
  const int p_side = orient3d(a, b, c, p), q_side = orient3d(a, b, c, q);
  if (is_flat || (p_side == 0 && q_side == 0)) return coplanar_contact(p, q, {a, b, c}, is_flat);
  if (p_side * q_side > 0) return Contact::none;
  // The line pq meets the plane in one point: inside when it passes all edges on the same side.
  const std::array<int, 3> sides = {orient3d(p, q, a, b), orient3d(p, q, b, c),
                                    orient3d(p, q, c, a)};
  const auto [least, greatest] = std::minmax_element(sides.begin(), sides.end());
  if (*least < 0 && *greatest > 0) return Contact::none;
  const bool on_boundary = p_side * q_side == 0 || sides[0] * sides[1] * sides[2] == 0;
  return on_boundary ? Contact::touch : Contact::cross;
}

}  // namespace lockstone
