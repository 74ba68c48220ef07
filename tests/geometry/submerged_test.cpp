// Volumes, moments, sections and shadows of solids below planes, against long double.
#include "core/geometry/submerged/submerged.h"

#include <algorithm>
#include <cmath>
#include <functional>
#include <vector>

#include <gtest/gtest.h>

#include <lockstone/hull.h>
#include <lockstone/literals.h>

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/numeric/q50.h"
#include "core/geometry/shapes/tapered_ends.h"
#include "core/math/roots.h"
#include "tests/support/random.h"
#include "tests/support/workload.h"

namespace lockstone::geometry {
namespace {

using namespace literals;
using test::Random;

constexpr long double k_pi = 3.14159265358979323846264338327950288L;

struct Values {
  long double volume = 0;
  std::array<long double, 3> moment{};  // about the origin of the shape
  long double plane_area = 0;
};

long double value(std::int64_t raw, int bits) {
  return std::ldexp(static_cast<long double>(raw), -bits);
}
long double value(Length x) {
  return value(x.raw, Length::frac_bits);
}
long double value(Unit x) {
  return value(x.raw, Unit::frac_bits);
}

// In metres.
Values values_of(const SubmergedPart& part) {
  Values result;
  result.volume = std::ldexp(value(part.volume, k_submerged_bits), 3 * part.scale);
  result.plane_area = std::ldexp(value(part.plane_area, k_submerged_bits), 2 * part.scale);
  for (int i = 0; i < 3; ++i) {
    const auto axis = static_cast<std::size_t>(i);
    result.moment[axis] = std::ldexp(value(part.moment[axis], k_submerged_bits), 4 * part.scale) +
                          result.volume * value(part.reference[i]);
  }
  return result;
}

Vec3<Unit> random_direction(Random& random) {
  for (;;) {
    const std::int64_t x = random.between(-1000, 1000), y = random.between(-1000, 1000),
                       z = random.between(-1000, 1000);
    if (x * x + y * y + z * z > 1000) return direction_of(x, y, z);
  }
}

// Of a box cut by a plane in general position: the sum over its corners of ±(d − n·c)³ / (6 n₁n₂n₃)
// where the corner is below the plane, and the like for moments and the section.
Values box_below(const Shape& box, const Vec3<Unit>& normal, long double d) {
  const long double n[] = {value(normal.x), value(normal.y), value(normal.z)};
  const long double h[] = {value(box.size.x), value(box.size.y), value(box.size.z)};
  const long double product = n[0] * n[1] * n[2];
  Values sum;
  for (int corner = 0; corner < 8; ++corner) {
    long double at[3], depth = d;
    int sign = 1;
    for (int i = 0; i < 3; ++i) {
      const bool upper = (corner >> i & 1) != 0;
      // The corner's simplex opens along the axis as the normal points.
      at[i] = upper ? h[i] : -h[i];
      depth -= n[i] * at[i];
      if (upper) sign = -sign;
    }
    // ∫ over x > corner of the half-space, signed by the octant, is a polynomial where n > 0.
    if (depth <= 0) continue;
    const long double volume = sign * depth * depth * depth / (6 * product);
    sum.volume += volume;
    sum.plane_area += sign * depth * depth / (2 * product);
    for (std::size_t i = 0; i < 3; ++i)
      sum.moment[i] += volume * (at[i] + depth / (4 * n[i]));
  }
  return sum;
}

// Slices across y: the part of each disc where x·sin ≤ d − y·cos, along the direction of the
// normal's part across y.
Values slices_below(long double y0, long double y1,
                    const std::function<long double(long double)>& radius, const Vec3<Unit>& normal,
                    long double d) {
  constexpr int k_slices = 100'000;
  const long double sine = std::hypot(value(normal.x), value(normal.z)), cosine = value(normal.y);
  Values sum;
  const long double step = (y1 - y0) / k_slices;
  for (int i = 0; i < k_slices; ++i) {
    const long double y = y0 + (i + 0.5L) * step, r = radius(y);
    const long double q = std::clamp((d - cosine * y) / (sine * r), -1.0L, 1.0L);
    const long double s = std::sqrt(1 - q * q);
    const long double area = r * r * (k_pi - std::acos(q) + q * s) * step;
    const long double across = -2 * r * r * r * s * s * s / 3 * step;
    sum.volume += area;
    sum.moment[1] += area * y;
    sum.moment[0] += across * value(normal.x) / sine;
    sum.moment[2] += across * value(normal.z) / sine;
    sum.plane_area += 2 * r * s * step / sine;
  }
  return sum;
}

void expect_near(const Values& got, const Values& wanted, int scale, long double tolerance,
                 const char* what) {
  const auto unit = [&](int power) { return std::ldexp(1.0L, power * scale); };
  EXPECT_NEAR(static_cast<double>(got.volume / unit(3)),
              static_cast<double>(wanted.volume / unit(3)), static_cast<double>(tolerance))
      << what;
  for (std::size_t i = 0; i < 3; ++i)
    EXPECT_NEAR(static_cast<double>(got.moment[i] / unit(4)),
                static_cast<double>(wanted.moment[i] / unit(4)), static_cast<double>(tolerance))
        << what << ' ' << i;
  EXPECT_NEAR(static_cast<double>(got.plane_area / unit(2)),
              static_cast<double>(wanted.plane_area / unit(2)), 0.005)
      << what;
}

Length random_size(Random& random) {
  return Length::from_ratio(random.between(50, 2000), 1000);
}

TEST(PartBelow, OfABoxIsExact) {
  Random random(1);
  for (int i = 0; i < test::share_of(2000); ++i) {
    const Shape box = Shape::box(random_size(random), random_size(random), random_size(random));
    Vec3<Unit> normal = random_direction(random);
    for (int axis = 0; axis < 3; ++axis)
      normal[axis] = max(abs(normal[axis]), Unit::from_ratio(1, 50));
    normal = direction_of(normal.x.raw, normal.y.raw, normal.z.raw);
    const Position offset = Position::from_ratio(random.between(-2000, 2000), 1000);
    const SubmergedPart part = part_below({box, nullptr}, {normal, offset});
    const Values wanted = box_below(box, normal, value(offset.raw, 32));
    expect_near(values_of(part), wanted, part.scale, 3e-8L, "box");
  }
}

TEST(PartBelow, OfABallIsTheCap) {
  Random random(2);
  for (int i = 0; i < test::share_of(2000); ++i) {
    const Shape ball = Shape::sphere(random_size(random));
    const Vec3<Unit> normal = random_direction(random);
    const Position offset = Position::from_ratio(random.between(-2100, 2100), 1000);
    const SubmergedPart part = part_below({ball, nullptr}, {normal, offset});
    const long double r = value(ball.size.x),
                      h = std::clamp(r + value(offset.raw, 32), 0.0L, 2 * r);
    Values wanted;
    wanted.volume = k_pi * h * h * (3 * r - h) / 3;
    const long double moment = -k_pi * h * h * (2 * r - h) * (2 * r - h) / 4;
    wanted.moment = {moment * value(normal.x), moment * value(normal.y), moment * value(normal.z)};
    wanted.plane_area = k_pi * h * (2 * r - h);
    expect_near(values_of(part), wanted, part.scale, 1e-8L, "ball");
  }
}

TEST(PartBelow, OfRoundSolidsIsThatOfTheirSlices) {
  Random random(3);
  for (int i = 0; i < 15; ++i) {
    const Length radius = random_size(random), height = random_size(random);
    const long double r = value(radius), h = value(height);
    Vec3<Unit> normal = random_direction(random);
    if (i % 3 == 0) {
      normal.x.raw >>= 9;
      normal.z.raw >>= 9;
      normal = direction_of(normal.x.raw, normal.y.raw | 1, normal.z.raw);
    }
    const Position offset = Position::from_ratio(random.between(-900, 900), 1000);
    const long double d = value(offset.raw, 32);
    const auto check = [&](const Shape& shape, const Values& wanted, const char* what) {
      const SubmergedPart part = part_below({shape, nullptr}, {normal, offset});
      expect_near(values_of(part), wanted, part.scale, 3e-8L, what);
    };
    check(Shape::cylinder(height, radius),
          slices_below(
              -h, h, [&](long double) { return r; }, normal, d),
          "cylinder");
    check(Shape::cone(height, radius),
          slices_below(
              -h / 4, 3 * h / 4, [&](long double y) { return r * (0.75L - y / h); }, normal, d),
          "cone");
    check(Shape::capsule(height, radius),
          slices_below(
              -h - r, h + r,
              [&](long double y) {
                const long double up = std::max(std::abs(y) - h, 0.0L);
                return std::sqrt(std::max(r * r - up * up, 1e-30L));
              },
              normal, d),
          "capsule");
    const Shape taper = Shape::tapered_capsule(height, radius, random_size(random));
    const TaperedEnds ends = tapered_ends(taper.size);
    const auto height_of = [](Fine y) {
      return std::ldexp(static_cast<long double>(y), -k_fine_bits);
    };
    const long double low = height_of(ends.low), high = height_of(ends.high),
                      a = value(ends.low_radius), b = value(ends.high_radius);
    const auto outline = [&](long double y) {
      const long double s = high > low ? (a - b) / (high - low) : 0, c = std::sqrt(1 - s * s);
      const auto ball = [&](long double centre, long double size) {
        return std::sqrt(std::max(size * size - (y - centre) * (y - centre), 1e-30L));
      };
      if (y < low + a * s || high == low) return ball(low, a);
      return y > high + b * s ? ball(high, b) : (a - (y - low) * s) / c;
    };
    check(taper, slices_below(low - a, high + b, outline, normal, d), "tapered capsule");
  }
}

// The part of a rounded box below a plane in a grid of its points.
Values rounded_below(const Shape& shape, const Vec3<Unit>& normal, long double d) {
  constexpr int k_cells = 60;
  const long double r = value(shape.fourth_size());
  std::array<long double, 3> half{}, step{};
  for (int i = 0; i < 3; ++i) {
    half[static_cast<std::size_t>(i)] = value(shape.size[i]);
    step[static_cast<std::size_t>(i)] = 2 * (value(shape.size[i]) + r) / k_cells;
  }
  Values sum;
  const long double cell = step[0] * step[1] * step[2];
  for (int index = 0; index < k_cells * k_cells * k_cells; ++index) {
    const std::array<int, 3> at{index % k_cells, index / k_cells % k_cells,
                                index / k_cells / k_cells};
    std::array<long double, 3> point{};
    long double beyond = 0, height = 0;
    for (std::size_t i = 0; i < 3; ++i) {
      point[i] = (at[i] + 0.5L - k_cells / 2) * step[i];
      const long double over = std::max(std::fabs(point[i]) - half[i], 0.0L);
      beyond += over * over;
      height += point[i] * value(normal[static_cast<int>(i)]);
    }
    if (beyond > r * r || height > d) continue;
    sum.volume += cell;
    for (std::size_t i = 0; i < 3; ++i)
      sum.moment[i] += cell * point[i];
  }
  return sum;
}

// Shares of the whole within a hundredth, and centres within a hundredth of the size.
TEST(PartBelow, OfARoundedBoxIsNearlyThatOfItsPoints) {
  Random random(9);
  for (int i = 0; i < test::share_of(20); ++i) {
    const Length x = random_size(random), y = random_size(random), z = random_size(random);
    const Shape shape = Shape::rounded_box(x, y, z, random_size(random));
    const Vec3<Unit> normal = random_direction(random);
    const Position offset = Position::from_ratio(random.between(-2000, 2000), 1000);
    const Values whole_solid = values_of(whole({shape, nullptr}));
    const long double volume = rounded_below(shape, normal, 1e6L).volume;
    const BlockFloat exact = traits_of(shape).volume(shape);
    EXPECT_NEAR(static_cast<double>(whole_solid.volume) /
                    std::ldexp(static_cast<double>(exact.mantissa), exact.exponent),
                1, 1e-8);
    EXPECT_NEAR(static_cast<double>(whole_solid.volume / volume), 1, 0.01);
    const Values got = values_of(part_below({shape, nullptr}, {normal, offset}));
    const Values wanted = rounded_below(shape, normal, value(offset.raw, 32));
    EXPECT_NEAR(static_cast<double>(got.volume / whole_solid.volume),
                static_cast<double>(wanted.volume / volume), 0.01);
    const long double size = value(bounding_radius(shape));
    for (std::size_t k = 0; k < 3; ++k)
      EXPECT_NEAR(static_cast<double>(got.moment[k] / whole_solid.volume / size),
                  static_cast<double>(wanted.moment[k] / volume / size), 0.01);
  }
}

// A shadow grows by its circumference times the radius, and by a disc.
TEST(Shadows, OfRoundedBoxesAreThoseOfTheirPlanAndRim) {
  Random random(10);
  for (int i = 0; i < test::share_of(1000); ++i) {
    const Length x = random_size(random), y = random_size(random), z = random_size(random);
    const Shape shape = Shape::rounded_box(x, y, z, random_size(random));
    const Vec3<Unit> n = random_direction(random);
    const long double r = value(shape.fourth_size());
    long double area = k_pi * r * r;
    for (int k = 0; k < 3; ++k) {
      const long double a = value(shape.size[(k + 1) % 3]), b = value(shape.size[(k + 2) % 3]);
      const long double along = std::fabs(value(n[k]));
      area += 4 * a * b * along + 4 * r * value(shape.size[k]) * std::sqrt(1 - along * along);
    }
    const Shadow shadow = shadow_of({shape, nullptr}, n);
    EXPECT_NEAR(std::ldexp(static_cast<double>(shadow.area), 2 * shadow.scale - 48) /
                    static_cast<double>(area),
                1, 1e-6);
  }
}

TEST(PartBelow, OfAnUprightCylinderHasADiscAsSection) {
  const Shape cylinder = Shape::cylinder(1_m, 0.5_m);
  const SubmergedPart part =
      part_below({cylinder, nullptr}, {{{}, Unit::from_integer(1), {}}, 0.25_m});
  const Values got = values_of(part);
  EXPECT_NEAR(static_cast<double>(got.volume), static_cast<double>(k_pi) * 0.25 * 1.25, 1e-8);
  EXPECT_NEAR(static_cast<double>(got.moment[1]), static_cast<double>(k_pi) * 0.25 * 1.25 * -0.375,
              1e-8);
  EXPECT_NEAR(static_cast<double>(got.plane_area), static_cast<double>(k_pi) * 0.25, 1e-8);
}

std::shared_ptr<const Hull> box_hull(const Shape& box, const Vec3<Length>& at) {
  std::vector<Vec3<Length>> corners;
  for (int corner = 0; corner < 8; ++corner) {
    Vec3<Length> point = at;
    for (int i = 0; i < 3; ++i)
      point[i] += (corner >> i & 1) != 0 ? box.size[i] : -box.size[i];
    corners.push_back(point);
  }
  return Hull::build(corners).hull;
}

TEST(PartBelow, OfAHullIsThatOfTheBoxItEquals) {
  Random random(4);
  for (int i = 0; i < 300; ++i) {
    const Shape box = Shape::box(random_size(random), random_size(random), random_size(random));
    const Vec3<Length> at{random_size(random) * 9, -random_size(random), random_size(random)};
    const auto hull = box_hull(box, at);
    ASSERT_NE(hull, nullptr);
    const Vec3<Unit> normal = random_direction(random);
    const Position offset = Position::from_ratio(random.between(-1000, 1000), 1000);
    Position moved = offset;
    for (int axis = 0; axis < 3; ++axis)
      moved += rounded<Position>(normal[axis] * at[axis]);
    const Values wanted = values_of(part_below({box, nullptr}, {normal, offset}));
    const SubmergedPart part =
        part_below({hull->shape(), hull->geometry().polytope()}, {normal, moved});
    Values got = values_of(part);
    for (int axis = 0; axis < 3; ++axis)
      got.moment[static_cast<std::size_t>(axis)] -= got.volume * value(at[axis]);
    expect_near(got, wanted, part.scale, 3e-8L, "hull");
    EXPECT_NEAR(
        static_cast<double>(values_of(whole({hull->shape(), hull->geometry().polytope()})).volume),
        static_cast<double>(8 * value(box.size.x) * value(box.size.y) * value(box.size.z)),
        std::ldexp(3e-8, 3 * part.scale));
    const Shadow of_hull = shadow_of({hull->shape(), hull->geometry().polytope()}, normal);
    const Shadow of_box = shadow_of({box, nullptr}, normal);
    EXPECT_NEAR(std::ldexp(static_cast<double>(of_hull.area), 2 * of_hull.scale - 48),
                std::ldexp(static_cast<double>(of_box.area), 2 * of_box.scale - 48),
                std::ldexp(1e-7, 2 * part.scale));
  }
}

// The shadow of a convex solid from its reach in many directions around: ½ ∫ (ρ² − ρ'²) dθ.
TEST(Shadow, OfRoundSolidsIsTheAreaThatTheirReachEncloses) {
  Random random(5);
  for (int i = 0; i < 60; ++i) {
    const Length radius = random_size(random), height = random_size(random);
    const long double r = value(radius), h = value(height);
    const Vec3<Unit> u = random_direction(random);
    const long double c = std::abs(value(u.y)), s = std::sqrt(1 - c * c);
    const auto enclosed = [&](const std::function<long double(long double, long double)>& reach) {
      constexpr int k_steps = 20'000;
      long double sum = 0;
      std::vector<long double> rho;
      for (int step = 0; step < k_steps; ++step) {
        const long double theta = 2 * k_pi * step / k_steps;
        rho.push_back(reach(std::cos(theta), std::sin(theta)));
      }
      for (std::size_t step = 0; step < rho.size(); ++step) {
        const long double slope = (rho[(step + 1) % rho.size()] - rho[step]) * k_steps / (2 * k_pi);
        const long double mean = (rho[(step + 1) % rho.size()] + rho[step]) / 2;
        sum += (mean * mean - slope * slope) * k_pi / k_steps;
      }
      return sum;
    };
    // The picture's axes: x across, y along the axis's shadow, of length s a metre.
    const auto rim = [&](long double x, long double y) { return r * std::hypot(x, c * y); };
    const auto check = [&](const Shape& shape, long double wanted, const char* what) {
      const Shadow shadow = shadow_of({shape, nullptr}, u);
      const long double got = std::ldexp(value(shadow.area, k_submerged_bits), 2 * shadow.scale);
      EXPECT_NEAR(static_cast<double>(got / wanted), 1, 1e-3) << what;
    };
    check(Shape::sphere(radius), k_pi * r * r, "sphere");
    check(Shape::capsule(height, radius),
          enclosed([&](long double, long double y) { return r + h * s * std::abs(y); }), "capsule");
    check(Shape::cylinder(height, radius),
          enclosed([&](long double x, long double y) { return rim(x, y) + h * s * std::abs(y); }),
          "cylinder");
    check(Shape::cone(height, radius), enclosed([&](long double x, long double y) {
            return std::max(rim(x, y) - h * s * y / 4, 3 * h * s * y / 4);
          }),
          "cone");
    const Length top = random_size(random);
    const Shape taper = Shape::tapered_capsule(height, radius, top);
    check(taper,
          enclosed([&](long double, long double y) { return std::max(r, value(top) + h * s * y); }),
          "tapered capsule");
  }
}

}  // namespace
}  // namespace lockstone::geometry
