// Hulls with a radius: mass against fine facets in long double, and boxes as hulls against rounded
// boxes.
#include <memory>
#include <vector>

#include <lockstone/compound.h>
#include <lockstone/hull.h>

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/convex/compound_solid.h"
#include "core/geometry/convex/parts.h"
#include "core/geometry/convex/shape_traits.h"
#include "core/geometry/dispatch/raycast.h"
#include "core/geometry/distance/epa/epa.h"
#include "core/geometry/distance/gjk/gjk.h"
#include "core/geometry/submerged/submerged.h"
#include "tests/geometry/scene.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

using HullPtr = std::shared_ptr<const Hull>;

RealVec unit_real(const RealVec& v) {
  return v * (1 / norm(v));
}

/// Volume, first and second moments of a solid by the triangles of its surface.
struct RealIntegrals {
  Real volume = 0;
  RealVec first{};
  std::array<std::array<Real, 3>, 3> second{};

  void add(const RealVec& a, const RealVec& b, const RealVec& c) {
    const Real v = dot(a, cross(b, c)) / 6;
    volume += v;
    const RealVec s = a + b + c;
    for (int i = 0; i < 3; ++i) {
      first[i] += v * s[i] / 4;
      for (int j = 0; j < 3; ++j)
        second[static_cast<std::size_t>(i)][static_cast<std::size_t>(j)] +=
            v / 20 * (a[i] * a[j] + b[i] * b[j] + c[i] * c[j] + s[i] * s[j]);
    }
  }
  void add_less(const RealIntegrals& fine, const RealIntegrals& coarse) {
    // The error falls with the square of the steps.
    const auto value = [](Real f, Real c) { return f + (f - c) / 3; };
    volume = value(fine.volume, coarse.volume);
    for (int i = 0; i < 3; ++i) {
      first[i] = value(fine.first[i], coarse.first[i]);
      for (std::size_t j = 0; j < 3; ++j)
        second[static_cast<std::size_t>(i)][j] =
            value(fine.second[static_cast<std::size_t>(i)][j],
                  coarse.second[static_cast<std::size_t>(i)][j]);
    }
  }
};

/// With `steps` facets along each arc.
RealIntegrals faceted(const geometry::Polytope& p, int steps) {
  RealIntegrals sum;
  const Real r = real(p.radius);
  const auto normal = [&](int edge) {
    return unit_real(real(p.faces[p.edges[static_cast<std::size_t>(edge)].face].normal));
  };
  for (const geometry::PolytopeFace& face : p.faces) {
    const RealVec up = unit_real(real(face.normal)) * r;
    const auto corner = [&](int i) {
      return real(geometry::start_of(p, face.first_edge + i)) + up;
    };
    for (int i = 1; i + 1 < face.edge_count; ++i)
      sum.add(corner(0), corner(i), corner(i + 1));
  }
  for (int edge = 0; edge < static_cast<int>(p.edges.size()); ++edge) {
    const int twin = p.edges[static_cast<std::size_t>(edge)].twin;
    const RealVec from = real(geometry::start_of(p, edge)), to = real(geometry::end_of(p, edge));
    if (geometry::is_first_half(p, edge)) {
      for (int i = 0; i < steps; ++i) {
        const auto at = [&](int k) {
          return unit_real(normal(edge) * static_cast<Real>(steps - k) +
                           normal(twin) * static_cast<Real>(k)) *
                 r;
        };
        sum.add(to + at(i), from + at(i), from + at(i + 1));
        sum.add(to + at(i), from + at(i + 1), to + at(i + 1));
      }
    }
  }
  for (std::size_t v = 0; v < p.vertices.size(); ++v) {
    int first = 0;
    while (p.edges[static_cast<std::size_t>(first)].origin != v)
      ++first;
    const RealVec place = real(p.vertices[v]);
    const auto next = [&](int edge) {
      return static_cast<int>(geometry::next_edge(p, p.edges[static_cast<std::size_t>(edge)].twin));
    };
    // Around the vertex the faces come clockwise.
    for (int edge = next(first); next(edge) != first; edge = next(edge)) {
      const RealVec a = normal(first), b = normal(next(edge)), c = normal(edge);
      const auto at = [&](int i, int j) {
        return place + unit_real(a * static_cast<Real>(steps - i - j) + b * static_cast<Real>(i) +
                                 c * static_cast<Real>(j)) *
                           r;
      };
      for (int i = 0; i < steps; ++i) {
        for (int j = 0; i + j < steps; ++j) {
          sum.add(at(i, j), at(i + 1, j), at(i, j + 1));
          if (i + j + 1 < steps) sum.add(at(i + 1, j), at(i + 1, j + 1), at(i, j + 1));
        }
      }
    }
  }
  return sum;
}

HullPtr random_rounded_hull(Dice& dice, int points, double size, double radius) {
  std::vector<Vec3<Length>> cloud;
  const RealVec stretch{dice.uniform(0.6, 1), dice.uniform(0.6, 1), dice.uniform(0.6, 1)};
  for (int i = 0; i < points; ++i) {
    const RealVec d = dice.direction() * static_cast<Real>(size);
    cloud.push_back(metres(RealVec{d.x * stretch.x, d.y * stretch.y, d.z * stretch.z}));
  }
  return Hull::build(cloud, {.tolerance = Length::from_raw(2), .radius = metres(radius)}).hull;
}

HullPtr box_as_hull(const Shape& box, const Mat3& rotation, const Vec3<Length>& at, Length radius) {
  std::vector<Vec3<Length>> corners;
  for (int i = 0; i < 8; ++i) {
    const Vec3<Length> corner{(i & 1) != 0 ? box.size.x : -box.size.x,
                              (i & 2) != 0 ? box.size.y : -box.size.y,
                              (i & 4) != 0 ? box.size.z : -box.size.z};
    corners.push_back(rounded<Length>(rotate(rotation, corner)) + at);
  }
  return Hull::build(corners, HullOptions::rounded(radius)).hull;
}

PosedShape posed_hull(const HullPtr& hull, const Shape& shape, const Mat3& rotation) {
  return {shape, rotation, hull->geometry().polytope()};
}

TEST(RoundedHulls, HaveTheMassOfTheirFinestFacets) {
  Dice dice;
  for (int run = 0; run < test::share_of(12); ++run) {
    const HullPtr hull = random_rounded_hull(dice, static_cast<int>(dice.between(7, 16)), 1,
                                             dice.uniform(0.05, 1.5));
    if (hull == nullptr) continue;
    const geometry::Polytope& p = *hull->geometry().polytope();
    const geometry::Solid& solid = *hull->geometry().solid();
    RealIntegrals truth;
    truth.add_less(faceted(p, 96), faceted(p, 48));
    const Real volume = std::ldexp(static_cast<Real>(solid.volume.mantissa), solid.volume.exponent);
    ASSERT_NEAR(static_cast<double>(volume / truth.volume), 1, 1e-5);
    const RealVec centre = truth.first * (1 / truth.volume);
    ASSERT_LT(norm(real(solid.centre) - centre), 10 * k_micrometre);
    // The tensor of the principal moments in the hull's frame, against that of the facets.
    const Mat3 axes = to_matrix(solid.axes);
    const Real scale = std::ldexp(Real{1}, 2 * solid.scale_exponent);
    for (int i = 0; i < 3; ++i) {
      for (int j = 0; j < 3; ++j) {
        Real found = 0;
        for (int k = 0; k < 3; ++k)
          found += real(axes.column(k))[i] * real(axes.column(k))[j] *
                   std::ldexp(static_cast<Real>(solid.inertia[k].raw), -60) * scale;
        const auto covariance = [&](int a, int b) {
          return truth.second[static_cast<std::size_t>(a)][static_cast<std::size_t>(b)] /
                     truth.volume -
                 centre[a] * centre[b];
        };
        const Real trace = covariance(0, 0) + covariance(1, 1) + covariance(2, 2);
        const Real wanted = (i == j ? trace : 0) - covariance(i, j);
        ASSERT_NEAR(static_cast<double>(found), static_cast<double>(wanted),
                    static_cast<double>(scale) * 1e-5)
            << run << " " << i << j;
      }
    }
  }
}

TEST(RoundedHulls, OfBoxesHaveTheMassOfRoundedBoxes) {
  Dice dice;
  for (int run = 0; run < 200; ++run) {
    const Shape box = dice.shape(ShapeKind::box, 0.05, 5);
    const Length radius = dice.size(0.01, 5);
    const Shape rounded = Shape::rounded_box(box.size.x, box.size.y, box.size.z, radius);
    const auto hull = box_as_hull(box, Mat3{}, metres(1, -2, 3), radius);
    ASSERT_NE(hull, nullptr);
    const geometry::Solid &found = *hull->geometry().solid(), wanted = geometry::solid_of(rounded);
    const auto volume = [](const geometry::Solid& s) {
      return std::ldexp(static_cast<double>(s.volume.mantissa), s.volume.exponent);
    };
    ASSERT_NEAR(volume(found) / volume(wanted), 1, 1e-8);
    ASSERT_EQ(found.centre, metres(1, -2, 3));
    ASSERT_EQ(found.scale_exponent, wanted.scale_exponent);
    for (int k = 0; k < 3; ++k)
      ASSERT_NEAR(std::ldexp(static_cast<double>(found.inertia[k].raw), -60),
                  std::ldexp(static_cast<double>(wanted.inertia[k].raw), -60), 1e-8);
    ASSERT_NEAR(static_cast<double>(real(found.inner_radius)),
                static_cast<double>(real(wanted.inner_radius)), 3e-6);
  }
}

TEST(RoundedHulls, OfBoxesMeetOthersAsRoundedBoxesDo) {
  Dice dice;
  int contacts = 0, hits = 0;
  for (int run = 0; run < 3000; ++run) {
    const Shape box = dice.shape(ShapeKind::box, 0.1, 2);
    const Length radius = dice.size(0.05, 1);
    const Shape rounded = Shape::rounded_box(box.size.x, box.size.y, box.size.z, radius);
    const auto hull = box_as_hull(box, Mat3{}, {}, radius);
    const Shape of_hull = hull->shape();
    const Shape other = dice.shape(static_cast<ShapeKind>(dice.between(0, 2)), 0.1, 2);
    const Mat3 rotation = to_matrix(dice.orientation()),
               other_rotation = to_matrix(dice.orientation());
    const PosedShape a{rounded, rotation}, h = posed_hull(hull, of_hull, rotation),
                                           b{other, other_rotation};
    const Vec3<Length> offset = metres(
        dice.direction() * (static_cast<Real>(dice.uniform(0.5, 1.2)) *
                            (real(bounding_radius(rounded)) + real(bounding_radius(other)))));
    const ClosestPoints near_a = distance(a, b, offset), near_h = distance(h, b, offset);
    ASSERT_EQ(near_a.overlapping, near_h.overlapping);
    ASSERT_NEAR(static_cast<double>(real(near_a.distance)),
                static_cast<double>(real(near_h.distance)), 4e-6);
    const Manifold m = collide(a, b, offset, metres(0.01)), n = collide(h, b, offset, metres(0.01));
    ASSERT_EQ(m.count > 0, n.count > 0);
    if (m.count > 0) {
      ++contacts;
      ASSERT_NEAR(static_cast<double>(deepest(m)), static_cast<double>(deepest(n)), 1e-3);
    }
    const Vec3<Length> way = metres(real(offset) * -2);
    const ShapeRayHit ray_a = cast_ray(a, offset, way), ray_h = cast_ray(h, offset, way);
    ASSERT_EQ(ray_a.hit, ray_h.hit);
    hits += ray_a.hit ? 1 : 0;
    ASSERT_NEAR(static_cast<double>(real(ray_a.fraction)),
                static_cast<double>(real(ray_h.fraction)), 1e-5);
  }
  EXPECT_GT(contacts, 300);
  EXPECT_GT(hits, 2000);
}

TEST(RoundedHulls, OfBoxesHaveTheSameShareUnderWater) {
  Dice dice;
  for (int run = 0; run < 300; ++run) {
    const Shape box = dice.shape(ShapeKind::box, 0.1, 2);
    const Length radius = dice.size(0.05, 1);
    const Shape rounded = Shape::rounded_box(box.size.x, box.size.y, box.size.z, radius);
    const auto hull = box_as_hull(box, Mat3{}, {}, radius);
    const Shape of_hull = hull->shape();
    const RealVec d = dice.direction();
    const geometry::BelowPlane plane{
        {unit(static_cast<double>(d.x)), unit(static_cast<double>(d.y)),
         unit(static_cast<double>(d.z))},
        Position::from_raw(std::llround(std::ldexp(dice.uniform(-2, 2), Position::frac_bits)))};
    const auto value = [](const geometry::SubmergedPart& part) {
      return std::ldexp(static_cast<double>(part.volume),
                        3 * part.scale - geometry::k_submerged_bits);
    };
    const double wanted = value(geometry::part_below({rounded, nullptr}, plane));
    const double found = value(geometry::part_below({of_hull, hull->geometry().polytope()}, plane));
    const double whole = value(geometry::whole({rounded, nullptr}));
    ASSERT_NEAR(found / whole, wanted / whole, 1e-6);
    const geometry::SubmergedPart all = geometry::whole({of_hull, hull->geometry().polytope()});
    ASSERT_NEAR(value(all) / whole, 1, 1e-8);
  }
}

TEST(RoundedHulls, KeepTheirRadiusInTheirBytes) {
  Dice dice;
  const HullPtr hull = random_rounded_hull(dice, 12, 1, 0.2);
  ASSERT_NE(hull, nullptr);
  const std::vector<std::byte> bytes = hull->canonical_bytes();
  const auto again = Hull::from_bytes(bytes);
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(again.value()->id(), hull->id());
  EXPECT_EQ(again.value()->radius(), metres(0.2));
  EXPECT_EQ(again.value()->geometry().solid()->inertia, hull->geometry().solid()->inertia);
  const auto sharp = Hull::build(hull->vertices(), {.tolerance = Length::from_raw(2)}).hull;
  EXPECT_NE(sharp->id(), hull->id());
  EXPECT_EQ(sharp->canonical_bytes().size() + 4, bytes.size());
  std::vector<std::byte> spoilt = bytes;
  for (std::size_t i = bytes.size() - 4; i < bytes.size(); ++i)
    spoilt[i] = std::byte{};
  EXPECT_EQ(Hull::from_bytes(spoilt).status(), Status::malformed);
  spoilt.resize(bytes.size() - 1);
  EXPECT_EQ(Hull::from_bytes(spoilt).status(), Status::truncated);
}

TEST(RoundedHulls, AreRefusedWithAWrongRadiusOrBeyondTheCoordinates) {
  const std::vector<Vec3<Length>> corners{
      {}, metres(500, 0, 0), metres(0, 500, 0), metres(0, 0, 500)};
  EXPECT_EQ(Hull::build(corners, {.radius = Length::from_raw(1)}).fault,
            HullFault::invalid_options);
  EXPECT_EQ(Hull::build(corners, {.radius = -metres(1)}).fault, HullFault::invalid_options);
  EXPECT_EQ(Hull::build(corners, {.radius = metres(13)}).fault, HullFault::coordinate_out_of_range);
  EXPECT_TRUE(Hull::build(corners, {.radius = metres(12)}).ok());
}

}  // namespace
}  // namespace lockstone::test
