#include <map>
#include <set>

#include <lockstone/hull.h>

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/convex/parts.h"
#include "core/geometry/convex/solid.h"
#include "core/geometry/numeric/exact_plane.h"
#include "core/math/predicates.h"
#include "tests/geometry/assets/hull_clouds.h"
#include "tests/support/workload.h"

namespace lockstone::test {
namespace {

using geometry::Fine;
using geometry::fine;
using geometry::HalfEdge;
using geometry::Polytope;
using geometry::PolytopeFace;
using geometry::RawVec;
using test::real;

constexpr int k_cloud_rounds = 12;

template <class Check>
void for_random_clouds(Check check) {
  Dice dice;
  for (int i = 0; i < k_cloud_rounds; ++i) {
    for (const NamedCloud& cloud : clouds(dice)) {
      SCOPED_TRACE(cloud.name);
      check(dice, cloud);
      if (::testing::Test::HasFatalFailure() || ::testing::Test::HasNonfatalFailure()) return;
    }
  }
}

LatticePoint raw(const Vec3<Length>& v) {
  return {v.x.raw, v.y.raw, v.z.raw};
}

RealVec real(const RawVec& v) {
  return {static_cast<Real>(v.x), static_cast<Real>(v.y), static_cast<Real>(v.z)};
}

std::vector<Vec3<Length>> loop_of(const Polytope& p, const PolytopeFace& face) {
  std::vector<Vec3<Length>> loop;
  for (int i = 0; i < face.edge_count; ++i)
    loop.push_back(p.vertices[p.edges[static_cast<std::size_t>(face.first_edge + i)].origin]);
  return loop;
}

void expect_closed_surface(const Polytope& p) {
  EXPECT_EQ(
      static_cast<int>(p.vertices.size() + p.faces.size()) - static_cast<int>(p.edges.size() / 2),
      2);
  std::size_t first = 0;
  for (std::size_t f = 0; f < p.faces.size(); ++f) {
    EXPECT_EQ(p.faces[f].first_edge, first);
    EXPECT_GE(p.faces[f].edge_count, 3);
    first += p.faces[f].edge_count;
    for (std::size_t e = p.faces[f].first_edge; e < first; ++e)
      EXPECT_EQ(p.edges[e].face, f);
  }
  ASSERT_EQ(first, p.edges.size());
  std::map<int, int> degree;
  for (std::size_t e = 0; e < p.edges.size(); ++e) {
    const HalfEdge& twin = p.edges[p.edges[e].twin];
    EXPECT_EQ(twin.twin, e);
    EXPECT_NE(twin.face, p.edges[e].face);
    EXPECT_EQ(twin.origin, p.edges[next_edge(p, static_cast<std::uint16_t>(e))].origin);
    ++degree[p.edges[e].origin];
  }
  EXPECT_EQ(degree.size(), p.vertices.size());
  for (const auto& [vertex, count] : degree)
    EXPECT_GE(count, 3);
}

void expect_supporting_planes(const Polytope& p, Fine tolerance) {
  for (const PolytopeFace& face : p.faces) {
    Fine most = std::numeric_limits<Fine>::min();
    for (const Vec3<Length>& v : p.vertices)
      most = std::max(most, dot(v, face.normal).raw);
    EXPECT_EQ(most, face.offset);
    EXPECT_NEAR(static_cast<double>(norm(real(face.normal))), 1, std::ldexp(1.0, -29));
    const auto loop = loop_of(p, face);
    for (std::size_t i = 0; i < loop.size(); ++i) {
      EXPECT_GE(dot(loop[i], face.normal).raw, face.offset - tolerance);
      const RealVec ab = real(loop[(i + 1) % loop.size()] - loop[i]);
      const RealVec bc = real(loop[(i + 2) % loop.size()] - loop[(i + 1) % loop.size()]);
      EXPECT_GT(dot(cross(ab, bc), real(face.normal)), 0);
    }
  }
}

/// How many faces are exact: none of the points above, decided exactly.
int count_exact_faces(const Polytope& p, const Cloud& points) {
  int exact = 0;
  for (const PolytopeFace& face : p.faces) {
    const auto loop = loop_of(p, face);
    const auto is_below = [&](const Vec3<Length>& q) {
      return orient3d(raw(loop[0]), raw(loop[1]), raw(loop[2]), raw(q)) <= 0;
    };
    if (std::ranges::all_of(points, is_below)) ++exact;
  }
  return exact;
}

Fine default_tolerance(const geometry::LocalBounds& bounds) {
  std::int64_t extent = 0;
  for (int axis = 0; axis < 3; ++axis)
    extent = std::max(extent, std::int64_t{bounds.upper[axis].raw} - bounds.lower[axis].raw);
  return std::max(Fine{2}, extent >> 12) << geometry::k_fine_per_length;
}

TEST(ExactPlane, HasTheSidesOfThePredicate) {
  Dice dice;
  int on = 0;
  for (int i = 0; i < test::share_of(50000); ++i) {
    const std::int64_t range = std::int64_t{1} << dice.between(1, 29);
    std::array<Vec3<Length>, 4> p;
    for (Vec3<Length>& v : p)
      for (int axis = 0; axis < 3; ++axis)
        v[axis].raw = static_cast<std::int32_t>(dice.between(-range, range));
    if (dice.chance(2)) {  // close to the plane, or in it
      p[3] = {(p[0].x + p[1].x) / 2, (p[0].y + p[1].y) / 2, (p[0].z + p[1].z) / 2};
      p[3].x.raw += static_cast<std::int32_t>(dice.between(-1, 1));
    }
    const auto plane = geometry::plane_through(p[0], p[1], p[2]);
    const int expected = orient3d(raw(p[0]), raw(p[1]), raw(p[2]), raw(p[3]));
    ASSERT_EQ(geometry::side(plane, p[3]), expected);
    on += expected == 0 ? 1 : 0;
    const RawVec d = geometry::difference(p[3], p[0]);
    const RealVec n = real(plane.normal), arm = real(d);
    if (norm(n) == 0) continue;
    const Real height = std::ldexp(static_cast<Real>(geometry::height(plane, p[3])), -30);
    ASSERT_NEAR(static_cast<double>(height - dot(arm, n) / norm(n)), 0,
                static_cast<double>(std::ldexp(norm(arm), -30)));
  }
  EXPECT_GT(on, 0);
}

TEST(Hull, IsAClosedConvexSurfaceThatHoldsItsPoints) {
  for_random_clouds([](Dice&, const NamedCloud& cloud) {
    const HullResult result = Hull::build(cloud.points, {.max_vertices = k_max_hull_vertices});
    ASSERT_TRUE(result.ok()) << to_string(result.fault);
    const Polytope& p = *result.hull->geometry().polytope();
    expect_closed_surface(p);
    const Fine tolerance = default_tolerance(result.hull->geometry().bounds());
    expect_supporting_planes(p, tolerance);
    for (const Vec3<Length>& point : cloud.points) {
      for (const PolytopeFace& face : p.faces)
        EXPECT_LE(dot(point, face.normal).raw, face.offset + fine(result.deviation));
    }
    EXPECT_LE(fine(result.deviation), 2 * tolerance);
    for (const PolytopeFace& face : p.faces)
      EXPECT_LT(dot(p.interior, face.normal).raw, face.offset);
  });
}

/// Points of which the least tolerance, two steps, drops and merges none. A point is dropped only
/// within two steps of a plane through three others, four with the error of the height. Triangles
/// abc and abd are merged only when their corners are within two steps of each other along a normal
/// and the segments ab and cd cross, seen along it. Where they cross, cd is within two steps of the
/// plane abc. Let c be the end farther from there: d is at most twice as far from c, and thus
/// within four steps of that plane.
Cloud in_general_position(Dice& dice, int count, double half) {
  Cloud cloud;
  do {
    cloud = in_cube(dice, count, half);
  } while (!is_in_general_position(cloud, 5));
  return cloud;
}

TEST(Hull, HasExactFacesWhereThePointsAreInGeneralPosition) {
  Dice dice;
  for (int i = 0; i < 30; ++i) {
    const bool small = i % 2 == 0;
    const Cloud cloud = in_general_position(dice, small ? 24 : 40, small ? 1 : 512);
    const HullOptions options{.tolerance = Length::from_raw(1), .max_vertices = 128};
    const HullResult result = Hull::build(cloud, options);
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(count_exact_faces(*result.hull->geometry().polytope(), cloud),
              result.hull->face_count());
    Cloud more = cloud;  // and the count can tell
    more.push_back(metres(result.hull->vertices()[0].x < Length{} ? -512 : 512, 0, 0));
    EXPECT_LT(count_exact_faces(*result.hull->geometry().polytope(), more),
              result.hull->face_count());
  }
}

TEST(Hull, OfABoxHasSixFaces) {
  const Cloud corners = box(1, 0.5, 0.25);
  Dice dice;
  for (int i = 0; i < 100; ++i) {
    const Mat3 rotation = i == 0 ? Mat3{} : to_matrix(dice.orientation());
    Cloud cloud = turned(corners, rotation);
    for (int k = 0; k < 100; ++k) {  // and points in its edges and faces, nearly
      const Vec3<Length> a = cloud[static_cast<std::size_t>(dice.between(0, 7))];
      const Vec3<Length> b = cloud[static_cast<std::size_t>(dice.between(0, 7))];
      cloud.push_back({(a.x + b.x) / 2, (a.y + b.y) / 2, (a.z + b.z) / 2});
    }
    const HullResult result = Hull::build(cloud);
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(result.hull->vertices().size(), 8U);
    EXPECT_EQ(result.hull->face_count(), 6);
    EXPECT_EQ(result.hull->id(), Hull::build(turned(corners, rotation)).hull->id());
  }
}

TEST(Hull, OfAPrismHasItsSidesAndEnds) {
  Dice dice;
  for (const int sides : {3, 4, 5, 8, 16, 31, 32}) {
    const Cloud cloud = turned(prism(sides, 0.5, 1), to_matrix(dice.orientation()));
    const HullResult result = Hull::build(cloud);
    ASSERT_TRUE(result.ok());
    EXPECT_EQ(result.hull->vertices().size(), 2 * static_cast<std::size_t>(sides));
    EXPECT_EQ(result.hull->face_count(), sides + 2);
  }
}

TEST(Hull, DoesNotDependOnTheOrderOfThePoints) {
  for_random_clouds([](Dice& dice, const NamedCloud& cloud) {
    const HullResult first = Hull::build(cloud.points);
    Cloud other = shuffled(dice, cloud.points);
    other.push_back(other.front());
    const HullResult second = Hull::build(other);
    ASSERT_TRUE(first.ok() && second.ok());
    EXPECT_EQ(first.hull->id(), second.hull->id());
    EXPECT_EQ(first.hull->canonical_bytes(), second.hull->canonical_bytes());
    EXPECT_EQ(first.deviation, second.deviation);
  });
}

TEST(Hull, OfItsVerticesIsItself) {
  for_random_clouds([](Dice& dice, const NamedCloud& cloud) {
    const HullOptions options{.tolerance = dice.chance(2) ? Length{} : metres(0.01),
                              .max_vertices = static_cast<int>(dice.between(8, 128))};
    const HullResult first = Hull::build(cloud.points, options);
    if (first.fault == HullFault::flat) return;  // a plate from too few of its corners
    ASSERT_TRUE(first.ok()) << to_string(first.fault);
    const HullResult second = Hull::build(first.hull->vertices(), options);
    ASSERT_TRUE(second.ok()) << to_string(second.fault);
    EXPECT_EQ(first.hull->id(), second.hull->id());
    EXPECT_EQ(second.deviation, Length{});
  });
}

/// Faces as sets of vertices.
std::set<std::set<std::array<int, 3>>> faces_of(const Hull& hull, int mirrored_axis) {
  std::set<std::set<std::array<int, 3>>> faces;
  for (int face = 0; face < hull.face_count(); ++face) {
    std::set<std::array<int, 3>> corners;
    for (const int index : hull.face_vertices(face)) {
      Vec3<Length> v = hull.vertices()[static_cast<std::size_t>(index)];
      if (mirrored_axis >= 0) v[mirrored_axis] = -v[mirrored_axis];
      corners.insert({v.x.raw, v.y.raw, v.z.raw});
    }
    faces.insert(corners);
  }
  return faces;
}

TEST(Hull, OfMirroredPointsIsTheMirroredHull) {
  Dice dice;
  for (int i = 0; i < 40; ++i) {
    const int axis = i % 3;
    const Cloud cloud = i % 2 == 0 ? in_cube(dice, 100, 1) : on_sphere(dice, 50, 0.5);
    const HullResult one = Hull::build(cloud);
    const HullResult other = Hull::build(mirrored(cloud, axis));
    ASSERT_TRUE(one.ok() && other.ok());
    EXPECT_EQ(faces_of(*one.hull, axis), faces_of(*other.hull, -1));
    EXPECT_NE(one.hull->id(), other.hull->id());  // the comparison can tell them apart
    EXPECT_EQ(one.hull->geometry().solid()->volume, other.hull->geometry().solid()->volume);
    EXPECT_EQ(one.hull->geometry().solid()->radius, other.hull->geometry().solid()->radius);
  }
}

TEST(Hull, KeepsTheMostExtremePointsWithinItsLimit) {
  Dice dice;
  const Cloud cloud = on_sphere(dice, 4000, 1);
  Length before = Length::max();
  for (const int limit : {8, 16, 32, 64, 128}) {
    const HullResult result = Hull::build(cloud, {.max_vertices = limit});
    ASSERT_TRUE(result.ok());
    EXPECT_LE(result.hull->vertices().size(), static_cast<std::size_t>(limit));
    EXPECT_GE(result.hull->vertices().size(), static_cast<std::size_t>(limit) - 2);
    EXPECT_LT(result.deviation, before);
    before = result.deviation;
  }
  EXPECT_LT(before, metres(0.05));
}

TEST(Hull, DropsPointsThatNearlyCoincide) {
  Dice dice;
  Cloud cloud = box(1, 1, 1);
  for (int i = 0; i < 200; ++i) {
    const Vec3<Length> near = cloud[static_cast<std::size_t>(i % 8)];
    const auto jitter = [&] { return Length::from_raw(static_cast<int>(dice.between(-50, 50))); };
    const Length x = jitter(), y = jitter();
    cloud.push_back(near + Vec3<Length>{x, y, jitter()});
  }
  const HullResult result = Hull::build(cloud);
  ASSERT_TRUE(result.ok());
  EXPECT_EQ(result.hull->vertices().size(), 8U);
  EXPECT_EQ(result.hull->face_count(), 6);
  EXPECT_LE(result.deviation, Length::from_raw(512));
}

HullFault hull_fault_of(const Cloud& cloud, const HullOptions& options = {}) {
  const HullResult result = Hull::build(cloud, options);
  EXPECT_EQ(result.ok(), result.fault == HullFault::none);
  return result.fault;
}

TEST(Hull, RefusesWithAReason) {
  Dice dice;
  Cloud line, plane;
  for (int i = 0; i < 20; ++i) {
    line.push_back(metres(0.1 * i, 0.2 * i, -0.3 * i));
    plane.push_back(metres(dice.uniform(-1, 1), dice.uniform(-1, 1), 0.25));
  }
  EXPECT_EQ(hull_fault_of({}), HullFault::too_few_points);
  EXPECT_EQ(hull_fault_of({{}, metres(1, 0, 0), metres(0, 1, 0)}), HullFault::too_few_points);
  EXPECT_EQ(hull_fault_of(Cloud(k_max_hull_points + 1)), HullFault::too_many_points);
  EXPECT_EQ(hull_fault_of(Cloud(50, metres(1, 2, 3))), HullFault::coincident);
  EXPECT_EQ(hull_fault_of(in_cube(dice, 50, 0.0004)), HullFault::coincident);
  EXPECT_EQ(hull_fault_of(line), HullFault::collinear);
  EXPECT_EQ(hull_fault_of(plane), HullFault::flat);
  EXPECT_EQ(hull_fault_of(turned(plane, to_matrix(dice.orientation()))), HullFault::flat);
  EXPECT_EQ(hull_fault_of(box(1, 1, 0.0004)), HullFault::flat);
  EXPECT_EQ(hull_fault_of(box(1, 1, 0.0005)), HullFault::none);
  EXPECT_EQ(hull_fault_of(box(512, 512, 512)), HullFault::none);
  Cloud spike = moved(box(1, 1, 1), metres(-511, -511, -511));
  spike.push_back(metres(512, 512, 512));
  EXPECT_EQ(hull_fault_of(spike), HullFault::too_large);
  Cloud outside = box(1, 1, 1);
  outside[3].y = k_max_asset_coordinate + Length::from_raw(1);
  EXPECT_EQ(hull_fault_of(outside), HullFault::coordinate_out_of_range);
  outside[3].y = Length::min();
  EXPECT_EQ(hull_fault_of(outside), HullFault::coordinate_out_of_range);
  EXPECT_EQ(hull_fault_of(box(1, 1, 1), {.max_vertices = 3}), HullFault::invalid_options);
  EXPECT_EQ(hull_fault_of(box(1, 1, 1), {.max_vertices = 129}), HullFault::invalid_options);
  EXPECT_EQ(hull_fault_of(box(1, 1, 1), {.tolerance = metres(-1)}), HullFault::invalid_options);
  for (int fault = 0; fault <= static_cast<int>(HullFault::too_large); ++fault)
    EXPECT_NE(to_string(static_cast<HullFault>(fault)), "unknown hull fault");
}

TEST(Hull, StandsAnyTolerance) {
  Dice dice;
  for (int i = 0; i < 200; ++i) {
    const Cloud cloud = in_cube(dice, 60, 1);
    const HullOptions options{.tolerance = dice.size(0.001, 500)};
    const HullResult result = Hull::build(cloud, options);
    ASSERT_TRUE(result.ok());
    expect_closed_surface(*result.hull->geometry().polytope());
  }
}

TEST(HullBytes, GiveTheSameHull) {
  for_random_clouds([](Dice& dice, const NamedCloud& cloud) {
    const HullOptions options{.tolerance = dice.chance(2) ? Length{} : metres(0.002)};
    const HullResult built = Hull::build(cloud.points, options);
    ASSERT_TRUE(built.ok());
    const std::vector<std::byte> bytes = built.hull->canonical_bytes();
    const auto loaded = Hull::from_bytes(bytes);
    ASSERT_TRUE(loaded.ok()) << to_string(loaded.status());
    const Hull& hull = *loaded.value();
    EXPECT_EQ(hull.id(), built.hull->id());
    EXPECT_FALSE(hull.id().is_null());
    EXPECT_EQ(hull.canonical_bytes(), bytes);
    EXPECT_TRUE(std::ranges::equal(hull.geometry().polytope()->edges,
                                   built.hull->geometry().polytope()->edges));
    EXPECT_EQ(hull.geometry().solid()->inertia, built.hull->geometry().solid()->inertia);
  });
}

TEST(HullBytes, AreNeverTrusted) {
  Dice dice;
  const std::vector<std::byte> good = Hull::build(prism(12, 1, 1)).hull->canonical_bytes();
  for (std::size_t size = 0; size < good.size(); ++size)
    EXPECT_EQ(Hull::from_bytes(ByteView(good).first(size)).status(), Status::truncated);
  std::vector<std::byte> longer = good;
  longer.push_back({});
  EXPECT_EQ(Hull::from_bytes(longer).status(), Status::malformed);
  int accepted = 0;
  for (int i = 0; i < test::share_of(3000); ++i) {
    std::vector<std::byte> bytes = good;
    for (int flips = static_cast<int>(dice.between(1, 3)); flips > 0; --flips)
      bytes[dice.next() % bytes.size()] ^= std::byte{1} << dice.between(0, 7);
    const auto result = Hull::from_bytes(bytes);
    if (!result.ok()) continue;
    ++accepted;
    EXPECT_EQ(result.value()->canonical_bytes(), bytes);
  }
  EXPECT_GT(accepted, 0);
  EXPECT_LT(accepted, 3000);
}

TEST(HullBytes, OfRandomVerticesNeverCrash) {
  Dice dice;
  for (int i = 0; i < test::share_of(2000); ++i) {
    const auto count = static_cast<std::size_t>(dice.between(0, 20));
    std::vector<std::byte> bytes(14 + 12 * count);
    ByteWriter writer(bytes);
    writer.put(std::uint32_t{0x41534b4c});
    writer.put(std::uint16_t{1});
    writer.put(std::uint8_t{3});
    writer.put(std::uint8_t{0});
    writer.put(dice.chance(2) ? 0 : static_cast<std::int32_t>(dice.next()));
    writer.put(static_cast<std::uint16_t>(count));
    const std::int64_t range = std::int64_t{1} << dice.between(0, 31);
    for (std::size_t k = 0; k < 3 * count; ++k)
      writer.put(static_cast<std::int32_t>(dice.between(-range, range - 1)));
    const auto result = Hull::from_bytes(bytes);
    if (!result.ok()) continue;
    EXPECT_EQ(result.value()->canonical_bytes(), bytes);
  }
}

struct CountInRegion final : geometry::PartVisitor {
  int count = 0;
  void visit(const geometry::Part& part) override {
    ++count;
    EXPECT_EQ(part.index, 0U);
    EXPECT_EQ(part.shape.kind, ShapeKind::hull);
    EXPECT_NE(part.polytope, nullptr);
    EXPECT_EQ(part.rotation, Mat3{});
  }
};

struct CountOnRay final : geometry::WayPartVisitor {
  int count = 0;
  Unit visit(const geometry::Part& part) override {
    ++count;
    EXPECT_NE(part.polytope, nullptr);
    return Unit::from_integer(1);
  }
};

TEST(Hull, IsOnePartWhereItsBoundsAreMet) {
  const HullResult result = Hull::build(moved(box(1, 2, 3), metres(10, 0, 0)));
  ASSERT_TRUE(result.ok());
  const Hull& hull = *result.hull;
  EXPECT_EQ(hull.geometry().bounds(), (geometry::LocalBounds{metres(9, -2, -3), metres(11, 2, 3)}));
  EXPECT_EQ(validate(hull.shape()), Status::ok);
  CountInRegion in_region;
  hull.geometry().visit_parts({metres(11, 2, 3), metres(12, 3, 4)}, in_region);
  EXPECT_EQ(in_region.count, 1);
  hull.geometry().visit_parts({metres(11, 2, 3.1), metres(12, 3, 4)}, in_region);
  EXPECT_EQ(in_region.count, 1);
  CountOnRay on_ray;
  hull.geometry().visit_parts_on_way({}, metres(8, 0, 0), {}, on_ray);
  EXPECT_EQ(on_ray.count, 0);
  hull.geometry().visit_parts_on_way({}, metres(9, 0, 0), {}, on_ray);
  EXPECT_EQ(on_ray.count, 1);
}

}  // namespace
}  // namespace lockstone::test
