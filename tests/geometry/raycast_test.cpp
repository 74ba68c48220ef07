#include "core/geometry/dispatch/raycast.h"

#include <optional>

#include "tests/geometry/scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

struct RealHit {
  Real fraction = 0;
  RealVec normal;
};

/// The first meeting from outside with a ball of radius r about the origin, or with a cylinder when
/// the vectors are flattened.
std::optional<Real> meet_round(const RealVec& o, const RealVec& t, Real r) {
  const Real a = dot(t, t);
  const Real b = dot(o, t);
  const Real c = dot(o, o) - r * r;
  const Real discriminant = b * b - a * c;
  if (discriminant < 0 || b >= 0 || c < 0) return std::nullopt;
  const Real f = c / (-b + std::sqrt(discriminant));
  return f <= 1 ? std::optional(f) : std::nullopt;
}

std::optional<RealHit> reference_capsule(const Placed& shape, const RealVec& o, const RealVec& t) {
  std::optional<RealHit> best;
  const auto offer = [&](std::optional<Real> f, const RealVec& core) {
    if (!f || (best && best->fraction <= *f)) return;
    const RealVec out = o + t * *f - core;
    best = RealHit{*f, out * (1 / norm(out))};
  };
  for (const int sign : {-1, 1}) {
    offer(meet_round(o - shape.end(sign), t, shape.size.x), shape.end(sign));
  }
  const RealVec& axis = shape.axes[1];
  const Real square = dot(axis, axis);
  const RealVec flat_o = o - axis * (dot(o, axis) / square);
  const RealVec flat_t = t - axis * (dot(t, axis) / square);
  const auto f = meet_round(flat_o, flat_t, shape.size.x);
  if (f) {
    const Real y = dot(o + t * *f, axis) / square;
    if (std::fabs(y) <= shape.size.y) offer(f, axis * y);
  }
  return best;
}

std::optional<RealHit> reference_box(const Placed& shape, const RealVec& o, const RealVec& t) {
  const RealVec start = shape.to_local(o);
  const RealVec way = shape.to_local(t);
  Real enter = -1e30L;
  Real leave = 1;
  RealVec normal;
  for (int k = 0; k < 3; ++k) {
    if (way[k] == 0) {
      if (std::fabs(start[k]) > shape.size[k]) return std::nullopt;
      continue;
    }
    const Real sign = way[k] > 0 ? 1 : -1;
    const Real in = (-sign * shape.size[k] - start[k]) / way[k];
    leave = std::min(leave, (sign * shape.size[k] - start[k]) / way[k]);
    if (in <= enter) continue;
    enter = in;
    normal = shape.axes[static_cast<std::size_t>(k)] * -sign;
  }
  if (enter < 0 || enter > leave) return std::nullopt;
  return RealHit{enter, normal};
}

std::optional<RealHit> reference(const Placed& shape, const RealVec& o, const RealVec& t) {
  if (surface_distance(shape, o) <= 0) return RealHit{};
  if (shape.kind == ShapeKind::box) return reference_box(shape, o, t);
  if (shape.kind == ShapeKind::capsule) return reference_capsule(shape, o, t);
  const auto f = meet_round(o, t, shape.size.x);
  if (!f) return std::nullopt;
  const RealVec out = o + t * *f;
  return RealHit{*f, out * (1 / norm(out))};
}

struct Ray {
  Vec3<Length> origin;
  Vec3<Length> translation;
};

/// Aimed at a random point near the shape, so that about half the rays graze or miss.
Ray random_ray(Dice& dice, const Placed& shape, double reach) {
  const auto to_length = [](const RealVec& v) {
    return metres(static_cast<double>(v.x), static_cast<double>(v.y), static_cast<double>(v.z));
  };
  const Real size = shape.reach(dice.direction());
  const RealVec from = dice.direction() * std::min<Real>(dice.uniform(0, reach), 1400);
  const RealVec target = dice.direction() * (size * dice.uniform(0, 1.1));
  RealVec way = (target - from) * dice.uniform(0.5, 3);
  if (norm(way) > 1400) way = way * (1400 / norm(way));
  Ray ray{to_length(from), to_length(way)};
  if (dice.chance(6)) ray.translation.x = {};
  if (dice.chance(6)) ray.translation.y = {};
  return ray;
}

template <class Check>
void for_random_rays(Check check) {
  Dice dice;
  for (int i = 0; i < test::share_of(60000); ++i) {
    const ShapeKind kind = k_all_kinds[static_cast<std::size_t>(i % 3)];
    const bool small = dice.chance(2);
    const Shape shape = dice.shape(kind, small ? 0.1 : 0.001, small ? 2 : 512);
    const Mat3 rotation = to_matrix(dice.orientation());
    const Placed placed({shape, rotation}, {});
    const Real reach = 4 * real(bounding_radius(shape));
    const Ray ray = random_ray(dice, placed, std::max(1.0, static_cast<double>(reach)));
    check(shape, rotation, placed, ray);
    if (::testing::Test::HasFailure()) {
      ADD_FAILURE() << describe(shape) << " R " << describe(rotation) << " o " << ray.origin.x.raw
                    << "," << ray.origin.y.raw << "," << ray.origin.z.raw << " t "
                    << ray.translation.x.raw << "," << ray.translation.y.raw << ","
                    << ray.translation.z.raw;
      return;
    }
  }
}

Placed grown(Placed shape, Real by) {
  shape.size.x += by;
  if (shape.kind == ShapeKind::box) {
    shape.size.y += by;
    shape.size.z += by;
  }
  return shape;
}

TEST(CastRay, AgreesWithTheReferenceOutsideTwoMicrometres) {
  for_random_rays(
      [](const Shape& shape, const Mat3& rotation, const Placed& placed, const Ray& ray) {
        const bool hit = cast_ray(shape, rotation, ray.origin, ray.translation).hit;
        const RealVec o = real(ray.origin);
        const RealVec t = real(ray.translation);
        if (hit) {
          EXPECT_TRUE(reference(grown(placed, 2e-6L), o, t).has_value());
        } else {
          EXPECT_FALSE(reference(grown(placed, -2e-6L), o, t).has_value());
        }
      });
}

TEST(CastRay, FractionPutsThePointOnTheSurface) {
  for_random_rays(
      [](const Shape& shape, const Mat3& rotation, const Placed& placed, const Ray& ray) {
        const ShapeRayHit hit = cast_ray(shape, rotation, ray.origin, ray.translation);
        const auto truth = reference(placed, real(ray.origin), real(ray.translation));
        if (!hit.hit || !truth) return;
        EXPECT_GE(hit.fraction.raw, 0);
        EXPECT_LE(hit.fraction, Unit::from_integer(1));
        if (hit.fraction.raw == 0 && hit.normal == Vec3<Unit>{}) return;
        const Real way = norm(real(ray.translation));
        const RealVec p = real(ray.origin) + real(ray.translation) * real(hit.fraction);
        EXPECT_NEAR(static_cast<double>(surface_distance(placed, p)), 0,
                    static_cast<double>(2e-6L + way * 1e-9L));
      });
}

TEST(CastRay, FractionAndNormalMatchTheReferenceAwayFromGrazing) {
  for_random_rays(
      [](const Shape& shape, const Mat3& rotation, const Placed& placed, const Ray& ray) {
        const ShapeRayHit hit = cast_ray(shape, rotation, ray.origin, ray.translation);
        const auto truth = reference(placed, real(ray.origin), real(ray.translation));
        if (!hit.hit || !truth || truth->fraction == 0) return;
        const RealVec t = real(ray.translation);
        const Real steepness = -dot(truth->normal, t) / norm(t);
        const Real reach = norm(real(ray.origin)) + norm(t);
        const Real bump = steepness * std::min(placed.size.x, norm(t));
        if (steepness < 0.1L || bump < 1e-3L) return;
        EXPECT_NEAR(static_cast<double>(real(hit.fraction)), static_cast<double>(truth->fraction),
                    static_cast<double>(2e-9L + (3e-6L + 4e-9L * reach) / (steepness * norm(t))));
        if (shape.kind == ShapeKind::box) return;
        EXPECT_NEAR(static_cast<double>(dot(real(hit.normal), truth->normal)), 1, 1e-4);
      });
}

TEST(CastRay, NormalsAreUnitAndFaceTheRay) {
  for_random_rays([](const Shape& shape, const Mat3& rotation, const Placed&, const Ray& ray) {
    const ShapeRayHit hit = cast_ray(shape, rotation, ray.origin, ray.translation);
    if (!hit.hit || hit.normal == Vec3<Unit>{}) return;
    EXPECT_NEAR(static_cast<double>(norm(real(hit.normal))), 1, std::ldexp(2.0, -30));
    EXPECT_LE(static_cast<double>(dot(real(hit.normal), real(ray.translation))),
              1e-7 * static_cast<double>(norm(real(ray.translation))));
  });
}

TEST(CastRay, StartingInsideOrOnTheSurfaceHitsAtZeroWithoutANormal) {
  const Shape box = Shape::box(metres(1), metres(2), metres(3));
  const Shape rod = Shape::capsule(metres(1), metres(0.5));
  const ShapeRayHit expected{true, {}, {}};
  const auto check = [&expected](const Shape& s, const Vec3<Length>& from,
                                 const Vec3<Length>& way) {
    const ShapeRayHit hit = cast_ray(s, k_identity, from, way);
    EXPECT_TRUE(hit.hit);
    EXPECT_EQ(hit.fraction, expected.fraction);
    EXPECT_EQ(hit.normal, expected.normal);
  };
  check(box, metres(0.5, 1, -2), metres(9, 0, 0));
  check(box, metres(1, 2, 3), metres(9, 0, 0));
  check(rod, metres(0.5, 0.5, 0), metres(9, 0, 0));
  check(rod, metres(0, 1.5, 0), metres(0, 9, 0));
  check(Shape::sphere(metres(5)), metres(3, 4, 0), metres(1, 0, 0));
}

TEST(CastRay, AZeroLengthRayHitsOnlyFromInside) {
  for (const Shape& s : {Shape::sphere(metres(1)), Shape::capsule(metres(1), metres(1)),
                         Shape::box(metres(1), metres(1), metres(1))}) {
    EXPECT_TRUE(cast_ray(s, k_identity, metres(0.5, 0, 0), {}).hit);
    EXPECT_FALSE(cast_ray(s, k_identity, metres(1.5, 0, 0), {}).hit);
  }
}

TEST(CastRay, GrazingRaysAreDecidedExactly) {
  const Length step = Length::from_raw(1);
  const Shape ball = Shape::sphere(metres(1));
  const Shape box = Shape::box(metres(1), metres(1), metres(1));
  const Shape rod = Shape::capsule(metres(1), metres(1));
  const Vec3<Length> way = metres(0, 0, 200);
  for (const Shape& s : {ball, box, rod}) {
    EXPECT_TRUE(cast_ray(s, k_identity, metres(1, 0, -100), way).hit);
    EXPECT_FALSE(cast_ray(s, k_identity, {metres(1) + step, {}, metres(-100)}, way).hit);
  }
}

TEST(CastRay, EndsExactlyAtTheSurfaceOrOneStepShort) {
  const Length step = Length::from_raw(1);
  for (const Shape& s : {Shape::sphere(metres(1)), Shape::capsule(metres(1), metres(1)),
                         Shape::box(metres(1), metres(1), metres(1))}) {
    const ShapeRayHit hit = cast_ray(s, k_identity, metres(-3, 0, 0), metres(2, 0, 0));
    EXPECT_TRUE(hit.hit);
    EXPECT_EQ(hit.fraction, Unit::from_integer(1));
    EXPECT_EQ(hit.normal.x, Unit::from_integer(-1));
    EXPECT_FALSE(cast_ray(s, k_identity, metres(-3, 0, 0), {metres(2) - step, {}, {}}).hit);
  }
}

TEST(CastRay, AlongACapsulesAxisMeetsTheCap) {
  const Shape rod = Shape::capsule(metres(1), metres(0.5));
  const ShapeRayHit hit = cast_ray(rod, k_identity, metres(0, 3, 0), metres(0, -3, 0));
  ASSERT_TRUE(hit.hit);
  EXPECT_EQ(hit.fraction, Unit::from_ratio(1, 2));
  EXPECT_EQ(hit.normal.y, Unit::from_integer(1));
}

TEST(CastRay, LanesOfFullRangeDoNotOverflow) {
  Dice dice;
  for (int i = 0; i < test::share_of(20000); ++i) {
    const auto extreme = [&dice] {
      return metres(static_cast<double>(dice.between(-1, 1)) * 1448);
    };
    const ShapeKind kind = k_all_kinds[static_cast<std::size_t>(i % 3)];
    const Shape shape = dice.shape(kind, 0.001, 512);
    const ShapeRayHit hit =
        cast_ray(shape, to_matrix(dice.orientation()), {extreme(), extreme(), extreme()},
                 {extreme(), extreme(), extreme()});
    EXPECT_LE(hit.fraction, Unit::from_integer(1));
  }
}

}  // namespace
}  // namespace lockstone::test
