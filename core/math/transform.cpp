#include <lockstone/transform.h>

#include "core/math/int128.h"

namespace lockstone {
namespace {

using Row = Vec3<Unit>;
using Wide = Vec3<std::int64_t>;

/// row · v, exact, then rounded once by 30 + `extra` bits. Rows stay together: with the entries
/// passed one by one, g++ 12 at -O1 and -O2 (ipa-modref) drops the stores of a temporary matrix.
Position rounded_dot(const Row& row, const Wide& v, int extra) {
  const Int128 sum = multiply_wide(std::int64_t{row.x.raw}, v.x) +
                     multiply_wide(std::int64_t{row.y.raw}, v.y) +
                     multiply_wide(std::int64_t{row.z.raw}, v.z);
  const Int128 rounded = round_shift(sum, 30 + extra);
  LKS_ASSERT(rounded == Int128::from(saturate_to_int64(rounded)));
  return Position::from_raw(static_cast<std::int64_t>(rounded.low));
}

/// m·v with `extra` more fraction bits in v than in the result.
Vec3<Position> rotate_raw(const Mat3& m, const Wide& v, int extra) {
  return {rounded_dot({m.x.x, m.y.x, m.z.x}, v, extra),
          rounded_dot({m.x.y, m.y.y, m.z.y}, v, extra),
          rounded_dot({m.x.z, m.y.z, m.z.z}, v, extra)};
}

}  // namespace

Vec3<Position> rotate(const Mat3& m, const Vec3<Position>& v) {
  return rotate_raw(m, {v.x.raw, v.y.raw, v.z.raw}, 0);
}

Vec3<Position> rotate_inverse(const Mat3& m, const Vec3<Position>& v) {
  const Wide wide{v.x.raw, v.y.raw, v.z.raw};
  return {rounded_dot(m.x, wide, 0), rounded_dot(m.y, wide, 0), rounded_dot(m.z, wide, 0)};
}

Vec3<Position> apply(const Transform& t, const Vec3<Position>& point) {
  return t.position + rotate(to_matrix(t.orientation), point);
}

Vec3<Position> apply(const Transform& t, const Vec3<Length>& point) {
  constexpr int extra = Length::frac_bits - Position::frac_bits;
  const Wide wide{point.x.raw, point.y.raw, point.z.raw};
  return t.position + rotate_raw(to_matrix(t.orientation), wide, extra);
}

Vec3<Position> apply_inverse(const Transform& t, const Vec3<Position>& point) {
  return rotate_inverse(to_matrix(t.orientation), point - t.position);
}

Transform compose(const Transform& a, const Transform& b) {
  return {apply(a, b.position), normalized(multiply(a.orientation, b.orientation))};
}

Transform inverse(const Transform& t) {
  return {-rotate_inverse(to_matrix(t.orientation), t.position), conjugate(t.orientation)};
}

}  // namespace lockstone
