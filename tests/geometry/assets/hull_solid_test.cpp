#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/convex/polytope.h"
#include "core/geometry/convex/solid_integrals.h"
#include "core/geometry/numeric/exact_plane.h"
#include "tests/geometry/assets/hull_clouds.h"

namespace lockstone::test {
namespace {

using geometry::Polytope;
using geometry::Solid;
using geometry::Triangle;

std::shared_ptr<const Hull> hull_of(const Cloud& cloud, const HullOptions& options = {}) {
  const HullResult result = Hull::build(cloud, options);
  EXPECT_TRUE(result.ok()) << to_string(result.fault);
  return result.hull;
}

/// Volume, centre and covariance by the same theorem, in long double, about a vertex.
struct Reference {
  Real volume = 0;
  RealVec centre;
  std::array<RealVec, 3> second{};  // ∫xy / V about the centre
};

Reference reference_of(std::span<const Vec3<Length>> vertices,
                       std::span<const Triangle> triangles) {
  Reference r;
  RealVec first;
  std::array<RealVec, 3> products{};
  const RealVec apex = real(vertices[0]);
  for (const Triangle& t : triangles) {
    const std::array<RealVec, 3> c{real(vertices[t[0]]) - apex, real(vertices[t[1]]) - apex,
                                   real(vertices[t[2]]) - apex};
    const Real volume = dot(cross(c[0], c[1]), c[2]) / 6;
    const RealVec total = c[0] + c[1] + c[2];
    r.volume += volume;
    first = first + total * (volume / 4);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        products[static_cast<std::size_t>(i)][j] +=
            volume / 20 *
            (total[i] * total[j] + c[0][i] * c[0][j] + c[1][i] * c[1][j] + c[2][i] * c[2][j]);
  }
  const RealVec arm = first * (1 / r.volume);
  r.centre = arm + apex;
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      r.second[static_cast<std::size_t>(i)][j] =
          products[static_cast<std::size_t>(i)][j] / r.volume - arm[i] * arm[j];
  return r;
}

Real volume_of(const Solid& solid) {
  return std::ldexp(static_cast<Real>(solid.volume.mantissa), solid.volume.exponent);
}

/// Covariance from the principal moments and axes, m².
std::array<RealVec, 3> covariance_of(const Solid& solid) {
  const RealVec moment = real(solid.inertia);
  const Real s = std::ldexp(Real{1}, solid.scale_exponent);
  const Mat3 axes = to_matrix(solid.axes);
  std::array<RealVec, 3> c{};
  for (int k = 0; k < 3; ++k) {
    const Real along = (moment.x + moment.y + moment.z) / 2 - moment[k];
    const RealVec axis = real(axes.column(k));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        c[static_cast<std::size_t>(i)][j] += along * s * s * axis[i] * axis[j];
  }
  return c;
}

std::vector<Triangle> fan_of(const Polytope& p) {
  std::vector<Triangle> triangles;
  for (const auto& face : p.faces) {
    const auto corner = [&](int i) {
      return p.edges[static_cast<std::size_t>(face.first_edge + i)].origin;
    };
    for (int i = 2; i < face.edge_count; ++i)
      triangles.push_back({corner(0), corner(i - 1), corner(i)});
  }
  return triangles;
}

bool has_only_triangles(const Polytope& p) {
  return std::ranges::all_of(p.faces, [](const auto& face) { return face.edge_count == 3; });
}

constexpr Real k_step = 1 / Real{1 << 30};

/// Covariance errors over their bound.
Real worst_error(const Solid& solid, const Reference& truth) {
  const Real s = std::ldexp(Real{1}, solid.scale_exponent);
  const auto found = covariance_of(solid);
  Real greatest = 0, worst = 0;
  for (int k = 0; k < 3; ++k)
    greatest = std::max(greatest, truth.second[static_cast<std::size_t>(k)][k]);
  for (std::size_t i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j)
      worst = std::max(worst, std::fabs(found[i][j] - truth.second[i][j]));
  return worst / (1e-6L * greatest + 3 * k_step * s * s);
}

void expect_solid(const Solid& solid, const Reference& truth) {
  EXPECT_NEAR(static_cast<double>(volume_of(solid) / truth.volume), 1, std::ldexp(1.0, -30));
  for (int k = 0; k < 3; ++k)
    EXPECT_LE(std::fabs(real(solid.centre)[k] - truth.centre[k]), std::ldexp(0.5001L, -20));
  EXPECT_LE(worst_error(solid, truth), 1);
}

TEST(HullSolid, MatchesTheIntegrals) {
  Dice dice;
  for (int round = 0; round < 20; ++round) {
    for (const NamedCloud& cloud : clouds(dice)) {
      SCOPED_TRACE(cloud.name);
      Cloud points = cloud.points;
      std::ranges::sort(points, {}, [](const auto& v) { return std::tie(v.x, v.y, v.z); });
      points.erase(std::unique(points.begin(), points.end()), points.end());
      const auto hull = geometry::hull_triangles(points, {});
      ASSERT_EQ(hull.fault, HullFault::none);
      const auto solid = geometry::solid_of(points, hull.triangles);
      ASSERT_TRUE(solid.has_value());
      expect_solid(*solid, reference_of(points, hull.triangles));
      if (::testing::Test::HasNonfatalFailure()) return;
    }
  }
}

TEST(HullSolid, OfExactFacesIsThatOfTheFaces) {
  Dice dice;
  for (const Real far : {Real{0}, Real{500}}) {
    std::shared_ptr<const Hull> hull;
    // A face merged from triangles is uneven by up to the tolerance, so that its fan of triangles
    // may bound another volume than those that it was merged from.
    do {
      const Cloud cloud = moved(in_cube(dice, 100, 1), metres(RealVec{far, -far, far}));
      hull = hull_of(cloud, {.tolerance = Length::from_raw(1), .max_vertices = 128});
    } while (!has_only_triangles(*hull->geometry().polytope()));
    expect_solid(*hull->geometry().solid(),
                 reference_of(hull->vertices(), fan_of(*hull->geometry().polytope())));
  }
}

TEST(HullSolid, IsFoundWrongWhenAVertexMoves) {
  const Cloud corners = box(1, 1, 1);
  const auto hull = hull_of(corners);
  const auto triangles = fan_of(*hull->geometry().polytope());
  Cloud other(hull->vertices().begin(), hull->vertices().end());
  EXPECT_LE(worst_error(*hull->geometry().solid(), reference_of(other, triangles)), 1);
  other[0].x -= Length::from_raw(20);  // 19 µm
  EXPECT_GT(worst_error(*hull->geometry().solid(), reference_of(other, triangles)), 1);
}

TEST(HullSolid, OfABoxIsThatOfTheShape) {
  Dice dice;
  for (int i = 0; i < 300; ++i) {
    const Shape shape = dice.shape(ShapeKind::box, 0.001, 512);
    const auto& [x, y, z] = shape.size;
    Cloud corners;
    for (int k = 0; k < 8; ++k)
      corners.push_back({(k & 1) != 0 ? x : -x, (k & 2) != 0 ? y : -y, (k & 4) != 0 ? z : -z});
    const auto hull = hull_of(corners);
    ASSERT_NE(hull, nullptr);
    const Solid& solid = *hull->geometry().solid();
    EXPECT_EQ(hull->face_count(), 6);
    EXPECT_EQ(solid.centre, Vec3<Length>{});
    EXPECT_EQ(solid.axes, Quat{});
    EXPECT_EQ(solid.radius, bounding_radius(shape));
    EXPECT_LE(solid.inner_radius, inner_radius(shape));
    EXPECT_GE(solid.inner_radius, inner_radius(shape) - Length::from_raw(3));
    EXPECT_EQ(solid.scale_exponent, scale_exponent(shape));
    const Vec3<Unit> moments = normalized_inertia(shape);
    for (int k = 0; k < 3; ++k)
      EXPECT_NEAR(geometry::to_unit(solid.inertia[k]).raw, moments[k].raw, 1);
    EXPECT_NEAR(static_cast<double>(volume_of(solid) / (8 * real(x) * real(y) * real(z))), 1,
                std::ldexp(1.0, -30));
  }
}

TEST(HullSolid, OfATurnedBoxHasTheTurnedAxes) {
  Dice dice;
  for (int i = 0; i < 100; ++i) {
    const Mat3 tilt = to_matrix(dice.orientation());
    const auto hull = hull_of(moved(turned(box(1.5, 1, 0.5), tilt), metres(300, 20, -100)));
    ASSERT_NE(hull, nullptr);
    const Solid& solid = *hull->geometry().solid();
    const Mat3 axes = to_matrix(solid.axes);
    const Vec3<Unit> moments = normalized_inertia(Shape::box(metres(1.5), metres(1), metres(0.5)));
    for (int k = 0; k < 3; ++k) {  // each axis of the solid is one of the box, up to its sign
      int matches = 0;
      for (int j = 0; j < 3; ++j) {
        if (norm(cross(real(axes.column(k)), real(tilt.column(j)))) > 5e-6L) continue;
        ++matches;
        EXPECT_NEAR(geometry::to_unit(solid.inertia[k]).raw, moments[j].raw, 4000);
      }
      EXPECT_EQ(matches, 1);
    }
    EXPECT_GE(solid.axes.w, Unit{});
  }
}

TEST(HullSolid, OfEqualMomentsKeepsTheAxes) {
  Dice dice;
  EXPECT_EQ(hull_of(box(1, 1, 1))->geometry().solid()->axes, Quat{});
  EXPECT_EQ(hull_of(moved(box(3, 3, 3), metres(100, 7, 1)))->geometry().solid()->axes, Quat{});
  EXPECT_EQ(hull_of({metres(1, 0, 0), metres(-1, 0, 0), metres(0, 1, 0), metres(0, -1, 0),
                     metres(0, 0, 1), metres(0, 0, -1)})
                ->geometry()
                .solid()
                ->axes,
            Quat{});
  EXPECT_EQ(hull_of({metres(1, 1, 1), metres(-1, -1, 1), metres(-1, 1, -1), metres(1, -1, -1)})
                ->geometry()
                .solid()
                ->axes,
            Quat{});
  // A tumbled cube, its corners rounded: every axis is principal, so its own are kept.
  const auto cube = hull_of(turned(box(8, 8, 8), to_matrix(dice.orientation())));
  EXPECT_EQ(cube->geometry().solid()->axes, Quat{});
}

TEST(HullSolid, RadiiHoldTheHullAndAreHeldByIt) {
  Dice dice;
  for (const NamedCloud& cloud : clouds(dice)) {
    SCOPED_TRACE(cloud.name);
    const auto hull = hull_of(cloud.points);
    const Solid& solid = *hull->geometry().solid();
    const RealVec centre = real(solid.centre);
    Real outer = 0;
    for (const Vec3<Length>& v : hull->vertices())
      outer = std::max(outer, norm(real(v) - centre));
    EXPECT_GE(real(solid.radius), outer);
    EXPECT_LE(real(solid.radius), outer + std::ldexp(1.0L, -20));
    Real inner = 1e9L;
    for (const auto& face : hull->geometry().polytope()->faces) {
      const RealVec n = real(face.normal);
      const Real height = std::ldexp(static_cast<Real>(face.offset), -geometry::k_fine_bits);
      inner = std::min(inner, (height - dot(centre, n)) / norm(n));
    }
    EXPECT_LE(real(solid.inner_radius), inner);
    EXPECT_GT(real(solid.inner_radius), inner * 0.75L - std::ldexp(1.0L, -18));
    EXPECT_GE(std::ldexp(1.0L, solid.scale_exponent), real(solid.radius));
    EXPECT_LT(std::ldexp(0.5L, solid.scale_exponent), real(solid.radius));
  }
}

}  // namespace
}  // namespace lockstone::test
