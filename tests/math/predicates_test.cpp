#include "core/math/predicates.h"

#include <array>

#include <gmpxx.h>
#include <gtest/gtest.h>

#include "core/math/int128.h"
#include "tests/math/reference.h"
#include "tests/support/workload.h"

namespace lockstone {
namespace {

using test::Raws;
using Exact3 = std::array<mpz_class, 3>;

constexpr std::int32_t k_min32 = std::numeric_limits<std::int32_t>::min();
constexpr std::int32_t k_max32 = std::numeric_limits<std::int32_t>::max();

LatticePoint random_point(Raws& raws, int bits) {
  const auto c = [&] { return static_cast<std::int32_t>(raws.signed_below_bits(bits)); };
  return {c(), c(), c()};
}

Exact3 minus(const LatticePoint& a, const LatticePoint& b) {
  return {mpz_class(a.x) - b.x, mpz_class(a.y) - b.y, mpz_class(a.z) - b.z};
}

mpz_class determinant(const Exact3& u, const Exact3& v, const Exact3& w) {
  return u[0] * (v[1] * w[2] - v[2] * w[1]) - u[1] * (v[0] * w[2] - v[2] * w[0]) +
         u[2] * (v[0] * w[1] - v[1] * w[0]);
}

mpz_class square(const Exact3& v) {
  return v[0] * v[0] + v[1] * v[1] + v[2] * v[2];
}

int exact_orient3d(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                   const LatticePoint& d) {
  return sgn(determinant(minus(b, a), minus(c, a), minus(d, a)));
}

/// The centre of the sphere by Cramer's rule, then distances: another way than the 4×4 determinant.
int exact_circumsphere(const std::array<LatticePoint, 5>& p) {
  const Exact3 u = minus(p[1], p[0]), v = minus(p[2], p[0]), w = minus(p[3], p[0]);
  const Exact3 e = minus(p[4], p[0]);
  const mpz_class det = determinant(u, v, w);
  if (det == 0) return 0;
  const Exact3 squares = {square(u), square(v), square(w)};
  Exact3 centre;  // times 2·det, relative to p[0]
  for (std::size_t axis = 0; axis < 3; ++axis) {
    std::array<Exact3, 3> rows = {u, v, w};
    for (std::size_t i = 0; i < 3; ++i)
      rows[i][axis] = squares[i];
    centre[axis] = determinant(rows[0], rows[1], rows[2]);
  }
  // |e − c|² < |c|²  ⇔  |e|² < 2 e·c
  const mpz_class twice = e[0] * centre[0] + e[1] * centre[1] + e[2] * centre[2];
  return sgn(det) * sgn(twice - det * square(e));
}

TEST(Orient3d, EqualsTheExactDeterminantAtEveryScale) {
  Raws raws;
  for (int i = 0; i < test::share_of(200000); ++i) {
    const int bits = 1 + static_cast<int>(raws.bits64() % 31);
    const auto a = random_point(raws, bits), b = random_point(raws, bits),
               c = random_point(raws, bits), d = random_point(raws, bits);
    const int side = orient3d(a, b, c, d);
    ASSERT_EQ(side, exact_orient3d(a, b, c, d));
    ASSERT_EQ(orient3d(b, a, c, d), -side);
    ASSERT_EQ(orient3d(b, c, a, d), side);
    ASSERT_EQ(orient3d(d, a, b, c), -side);
  }
}

TEST(Orient3d, IsExactNextToDegenerateCases) {
  Raws raws;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const int bits = 3 + static_cast<int>(raws.bits64() % 27);
    const auto a = random_point(raws, bits), u = random_point(raws, bits - 2),
               v = random_point(raws, bits - 2);
    const LatticePoint b{a.x + u.x, a.y + u.y, a.z + u.z}, c{a.x + v.x, a.y + v.y, a.z + v.z};
    LatticePoint d{a.x + u.x - v.x, a.y + u.y - v.y, a.z + u.z - v.z};
    ASSERT_EQ(orient3d(a, b, c, d), 0);
    ASSERT_EQ(orient3d(a, b, b, d), 0);
    ASSERT_EQ(orient3d(a, a, a, a), 0);
    d.z += 1;  // off the plane by one unit of one coordinate
    ASSERT_EQ(orient3d(a, b, c, d), exact_orient3d(a, b, c, d));
  }
  for (int corner = 0; corner < 4096; ++corner) {  // every choice of extreme coordinates
    std::array<LatticePoint, 4> p;
    for (int i = 0; i < 12; ++i)
      p[static_cast<std::size_t>(i / 3)][i % 3] = (corner >> i & 1) != 0 ? k_max32 : k_min32;
    ASSERT_EQ(orient3d(p[0], p[1], p[2], p[3]), exact_orient3d(p[0], p[1], p[2], p[3]));
  }
}

TEST(SideOfPlane, EqualsTheExactSum) {
  Raws raws;
  for (int i = 0; i < test::share_of(200000); ++i) {
    const auto n = random_point(raws, 31), p = random_point(raws, 31);
    const mpz_class sum = mpz_class(n.x) * p.x + mpz_class(n.y) * p.y + mpz_class(n.z) * p.z;
    const std::int64_t offset = raws.signed_below_bits(63);
    ASSERT_EQ(side_of_plane(n, offset, p), sgn(sum - mpz_class(offset)));
    if (!sum.fits_slong_p()) continue;
    for (const int near : {-1, 0, 1})
      ASSERT_EQ(side_of_plane(n, sum.get_si() - near, p), near);
  }
  EXPECT_EQ(side_of_plane({k_min32, k_min32, k_min32}, 0, {k_min32, k_min32, k_min32}), 1);
  EXPECT_EQ(side_of_plane({k_min32, k_min32, k_min32}, 0, {k_max32, k_max32, k_max32}), -1);
}

TEST(SideOfSphere, EqualsTheExactDistance) {
  Raws raws;
  for (int i = 0; i < test::share_of(200000); ++i) {
    const auto c = random_point(raws, 31), p = random_point(raws, 31);
    const auto radius = static_cast<std::int64_t>(raws.below_bits(34));
    const mpz_class distance = square(minus(p, c));
    ASSERT_EQ(side_of_sphere(c, radius, p), sgn(mpz_class(radius) * radius - distance));
  }
  EXPECT_EQ(side_of_sphere({0, 0, 0}, 3, {1, 2, 2}), 0);
  EXPECT_EQ(side_of_sphere({}, 0, {}), 0);
}

TEST(SideOfCircumsphere, EqualsTheCentreByCramersRule) {
  Raws raws;
  for (int i = 0; i < test::share_of(60000); ++i) {
    const int bits = 1 + static_cast<int>(raws.bits64() % 23);
    std::array<LatticePoint, 5> p;
    for (LatticePoint& point : p)
      point = random_point(raws, bits);
    const int side = side_of_circumsphere(p[0], p[1], p[2], p[3], p[4]);
    ASSERT_EQ(side, exact_circumsphere(p));
    ASSERT_EQ(side_of_circumsphere(p[1], p[0], p[2], p[3], p[4]), side);
  }
}

TEST(SideOfCircumsphere, KnowsPointsOfOneSphere) {
  const LatticePoint a{3, 0, 0}, b{0, 3, 0}, c{0, 0, 3}, d{-3, 0, 0};
  EXPECT_EQ(side_of_circumsphere(a, b, c, d, {1, 2, 2}), 0);
  EXPECT_EQ(side_of_circumsphere(a, b, c, d, {2, -2, 1}), 0);
  EXPECT_EQ(side_of_circumsphere(a, b, c, d, {0, 0, 0}), 1);
  EXPECT_EQ(side_of_circumsphere(a, b, c, d, {2, 2, 2}), -1);
  EXPECT_EQ(side_of_circumsphere(a, b, c, a, {0, 0, 0}), 0);
  constexpr std::int32_t far = 1 << 23;  // the greatest differences
  for (int corner = 0; corner < 32768; ++corner) {
    std::array<LatticePoint, 5> p;
    for (int i = 0; i < 15; ++i)
      p[static_cast<std::size_t>(i / 3)][i % 3] = (corner >> i & 1) != 0 ? far : -far;
    ASSERT_EQ(side_of_circumsphere(p[0], p[1], p[2], p[3], p[4]), exact_circumsphere(p));
  }
}

TEST(Lattice, BringsDifferencesIntoItsBits) {
  EXPECT_EQ(lattice_shift(0), 0);
  EXPECT_EQ(lattice_shift(1 << 19), 0);
  EXPECT_EQ(lattice_shift((1 << 19) + 1), 1);
  EXPECT_EQ(lattice_shift(~std::uint64_t{0}), 45);
  EXPECT_EQ(to_lattice({7, -7, 6}, {1, -1, 1}, 2), (LatticePoint{2, -2, 1}));
  Raws raws;
  for (int i = 0; i < test::share_of(100000); ++i) {
    const std::int64_t x = raws.signed_below_bits(62);
    const LatticePoint p = to_lattice({x, -x, 0}, {}, lattice_shift(magnitude(x)));
    ASSERT_LE(std::abs(p.x), 1 << k_lattice_bits);
    ASSERT_EQ(p.y, -p.x);
  }
}

/// The interval of s in [0, 1] for which p + s·(q − p) satisfies normal·x ≥ offset, intersected.
struct Interval {
  mpq_class low = 0, high = 1;

  void keep_at_least(const mpq_class& at_start, const mpq_class& slope) {  // at_start + s·slope ≥ 0
    if (slope == 0 && at_start < 0) high = low - 1;
    if (slope == 0) return;
    const mpq_class root = -at_start / slope;
    if (slope > 0 && root > low) low = root;
    if (slope < 0 && root < high) high = root;
  }
  void keep_zero(const mpq_class& at_start, const mpq_class& slope) {
    keep_at_least(at_start, slope);
    keep_at_least(-at_start, -slope);
  }
  [[nodiscard]] bool empty() const { return low > high; }
};

using Linear = std::array<mpq_class, 2>;  // value at p, and slope to q

mpz_class dot(const Exact3& a, const Exact3& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}

Exact3 cross(const Exact3& a, const Exact3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// s ↦ n · (p + s·(q − p) − o)
Linear along(const Exact3& n, const LatticePoint& p, const LatticePoint& q, const LatticePoint& o) {
  return {mpq_class(dot(n, minus(p, o))), mpq_class(dot(n, minus(q, p)))};
}

/// Clips the segment to the triangle: an independent way, by half spaces.
Contact clipped(const LatticePoint& p, const LatticePoint& q,
                const std::array<LatticePoint, 3>& t) {
  const Exact3 n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
  Interval inside;
  const Linear height = along(n, p, q, t[0]);
  inside.keep_zero(height[0], height[1]);
  for (std::size_t i = 0; i < 3; ++i) {
    const Linear edge = along(cross(n, minus(t[(i + 1) % 3], t[i])), p, q, t[i]);
    inside.keep_at_least(edge[0], edge[1]);
  }
  if (inside.empty()) return Contact::none;
  if (p == q || inside.low == inside.high) {
    if (p == q || inside.low == 0 || inside.high == 1 || height[1] == 0) return Contact::touch;
    for (std::size_t i = 0; i < 3; ++i) {
      const Linear edge = along(cross(n, minus(t[(i + 1) % 3], t[i])), p, q, t[i]);
      if (edge[0] + inside.low * edge[1] == 0) return Contact::touch;
    }
    return Contact::cross;
  }
  return Contact::overlap;
}

/// Clips ab to the segment cd: to its line, then between its ends.
Contact clipped(const LatticePoint& a, const LatticePoint& b, const LatticePoint& c,
                const LatticePoint& d) {
  if (c == d && a != b) return clipped(c, d, a, b);
  const Exact3 v = minus(d, c);
  Interval inside;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const Exact3 start = c == d ? minus(a, c) : cross(minus(a, c), v);
    const Exact3 slope = cross(minus(b, a), v);
    inside.keep_zero(start[axis], slope[axis]);
  }
  const Linear from_c = along(v, a, b, c), from_d = along(v, a, b, d);
  inside.keep_at_least(from_c[0], from_c[1]);
  inside.keep_at_least(-from_d[0], -from_d[1]);
  if (inside.empty()) return Contact::none;
  if (a == b) return Contact::touch;
  if (inside.low < inside.high) return Contact::overlap;
  const mpq_class at_c = from_c[0] + inside.low * from_c[1];
  const mpq_class at_d = from_d[0] + inside.low * from_d[1];
  const bool at_end = inside.low == 0 || inside.high == 1 || at_c == 0 || at_d == 0;
  return at_end ? Contact::touch : Contact::cross;
}

/// Coordinates so few that degenerate cases are the rule; scaled up for the wide paths.
LatticePoint small_point(Raws& raws, std::int32_t scale) {
  const auto c = [&] { return (static_cast<std::int32_t>(raws.bits64() % 5) - 2) * scale; };
  return {c(), c(), c()};
}

TEST(SegmentSegment, EqualsClippingInRationals) {
  Raws raws;
  std::array<int, 4> seen{};
  for (int i = 0; i < test::share_of(300000); ++i) {
    const std::int32_t scale = i % 3 == 0 ? 1 : i % 3 == 1 ? 1 << 18 : 1 << 29;
    const auto a = small_point(raws, scale), b = small_point(raws, scale),
               c = small_point(raws, scale), d = small_point(raws, scale);
    const Contact contact = segment_segment(a, b, c, d);
    ++seen[static_cast<std::size_t>(contact)];
    ASSERT_EQ(contact, clipped(a, b, c, d));
    ASSERT_EQ(segment_segment(c, d, b, a), contact);
  }
  for (const int count : seen)
    EXPECT_GT(count, test::share_of(20));
}

TEST(SegmentTriangle, EqualsClippingInRationals) {
  Raws raws;
  std::array<int, 4> seen{};
  for (int i = 0; i < test::share_of(300000); ++i) {
    const std::int32_t scale = i % 3 == 0 ? 1 : i % 3 == 1 ? 1 << 18 : 1 << 29;
    std::array<LatticePoint, 3> t;
    for (LatticePoint& corner : t)
      corner = small_point(raws, scale);
    const auto p = small_point(raws, scale), q = small_point(raws, scale);
    const Contact contact = segment_triangle(p, q, t[0], t[1], t[2]);
    ASSERT_EQ(segment_triangle(q, p, t[1], t[0], t[2]), contact);
    const Exact3 n = cross(minus(t[1], t[0]), minus(t[2], t[0]));
    if (n[0] == 0 && n[1] == 0 && n[2] == 0) continue;
    ++seen[static_cast<std::size_t>(contact)];
    ASSERT_EQ(contact, clipped(p, q, t));
    const int point = point_in_triangle(t[0], t[1], t[2], p);
    ASSERT_EQ(point >= 0, clipped(p, p, t) != Contact::none);
  }
  for (const int count : seen)
    EXPECT_GT(count, test::share_of(20));
}

TEST(SegmentTriangle, TakesFlatTrianglesForTheirEdges) {
  const LatticePoint a{0, 0, 0}, b{4, 0, 0}, c{2, 0, 0};
  EXPECT_EQ(segment_triangle({1, -1, 0}, {1, 1, 0}, a, b, c), Contact::touch);
  EXPECT_EQ(segment_triangle({3, 0, 0}, {9, 0, 0}, a, b, c), Contact::overlap);
  EXPECT_EQ(segment_triangle({4, 0, 0}, {9, 0, 0}, a, b, c), Contact::touch);
  EXPECT_EQ(segment_triangle({5, 0, 0}, {9, 0, 0}, a, b, c), Contact::none);
  EXPECT_EQ(segment_triangle(a, a, a, a, a), Contact::touch);
}

TEST(PointInTriangle, TellsInsideBoundaryAndOutside) {
  const LatticePoint a{0, 0, 0}, b{4, 0, 4}, c{0, 4, 4};
  EXPECT_EQ(point_in_triangle(a, b, c, {1, 1, 2}), 1);
  EXPECT_EQ(point_in_triangle(a, c, b, {1, 1, 2}), 1);
  EXPECT_EQ(point_in_triangle(a, b, c, {2, 2, 4}), 0);
  EXPECT_EQ(point_in_triangle(a, b, c, a), 0);
  EXPECT_EQ(point_in_triangle(a, b, c, {8, 0, 8}), -1);
  EXPECT_EQ(point_in_triangle(a, b, c, {1, 1, 3}), -1);
  EXPECT_EQ(point_in_triangle(a, a, b, {2, 0, 2}), 0);
  EXPECT_EQ(point_in_triangle(a, a, b, {2, 1, 2}), -1);
}

}  // namespace
}  // namespace lockstone
