// Compounds: refusals, canonical bytes, mass distribution.
#include <cmath>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/literals.h>
#include <lockstone/testing/floating.h>

#include "core/geometry/convex/asset_geometry.h"
#include "core/geometry/convex/parts.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/geometry/convex/solid.h"
#include "tests/support/random.h"

namespace lockstone {
namespace {

using namespace literals;
using testing::to_double;

double value(BlockFloat x) {
  return std::ldexp(static_cast<double>(x.mantissa), x.exponent);
}

CompoundChild child(const Shape& shape, const Vec3<Length>& position) {
  CompoundChild result;
  result.shape = shape;
  result.position = position;
  return result;
}

const geometry::Solid& solid_of(const CompoundResult& built) {
  EXPECT_TRUE(built.ok()) << to_string(built.fault);
  return *built.compound->geometry().solid();
}

TEST(Compound, OfOneShapeHasItsMassDistribution) {
  for (const Shape& shape :
       {Shape::sphere(0.7_m), Shape::capsule(1.5_m, 0.25_m), Shape::box(0.5_m, 1.25_m, 2_m)}) {
    const CompoundChild children[] = {child(shape, {})};
    const CompoundResult built = Compound::build(children);
    const geometry::Solid& solid = solid_of(built);
    const Vec3<Unit> inertia = normalized_inertia(shape);
    const double mass = to_double(mass_of(shape, Density::from_integer(1)));
    EXPECT_NEAR(value(solid.volume) / mass, 1, 1e-8);
    EXPECT_EQ(solid.centre, Vec3<Length>{});
    EXPECT_EQ(solid.axes, Quat{});
    EXPECT_EQ(solid.inner_radius, inner_radius(shape));
    const double scale = std::ldexp(1, 2 * (solid.scale_exponent - scale_exponent(shape)));
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(to_double(solid.inertia[i]) * scale, to_double(inertia[i]), 1e-8);
  }
}

// A box cut in two weighs and turns like the whole.
TEST(Compound, OfTwoHalvesIsTheWhole) {
  const CompoundChild halves[] = {child(Shape::box(1_m, 0.5_m, 0.25_m), {-1_m, {}, {}}),
                                  child(Shape::box(1_m, 0.5_m, 0.25_m), {1_m, {}, {}})};
  const CompoundResult built = Compound::build(halves);
  const geometry::Solid& solid = solid_of(built);
  const Shape whole = Shape::box(2_m, 0.5_m, 0.25_m);
  const Vec3<Unit> inertia = normalized_inertia(whole);
  const double scale = std::ldexp(1, 2 * (solid.scale_exponent - scale_exponent(whole)));
  EXPECT_NEAR(value(solid.volume), 8 * 2 * 0.5 * 0.25, 1e-8);
  for (int i = 0; i < 3; ++i)
    EXPECT_NEAR(to_double(solid.inertia[i]) * scale, to_double(inertia[i]), 1e-8);
}

TEST(Compound, CentreLiesWhereTheWeightIs) {
  CompoundChild children[] = {child(Shape::sphere(0.5_m), {}),
                              child(Shape::sphere(0.5_m), {4_m, {}, {}})};
  children[1].density = Number::from_integer(3);
  const CompoundResult built = Compound::build(children);
  EXPECT_EQ(solid_of(built).centre, (Vec3<Length>{3_m, {}, {}}));
}

std::vector<CompoundChild> random_boxes(test::Random& random) {
  const auto between = [&](std::int64_t least, std::int64_t most) {
    return Length::from_raw(static_cast<std::int32_t>(random.between(least, most)));
  };
  const auto size = [&] { return between(1 << 15, 1 << 20); };
  const auto place = [&] { return between(-(1 << 21), 1 << 21); };
  std::vector<CompoundChild> children(static_cast<std::size_t>(random.between(2, 6)));
  for (CompoundChild& box : children) {
    const Length sx = size(), sy = size(), sz = size();
    const Length px = place(), py = place(), pz = place();
    box = child(Shape::box(sx, sy, sz), {px, py, pz});
  }
  return children;
}

// In double, at density 1.
struct RealSums {
  double mass = 0;
  double centre[3] = {};
  double trace = 0;  ///< of the inertia by unit of mass, which does not turn

  explicit RealSums(const std::vector<CompoundChild>& boxes) {
    for (const CompoundChild& box : boxes)
      mass += volume(box);
    for (const CompoundChild& box : boxes)
      for (int i = 0; i < 3; ++i)
        centre[i] += volume(box) / mass * to_double(box.position[i]);
    for (const CompoundChild& box : boxes) {
      for (int i = 0; i < 3; ++i) {
        const double d = to_double(box.position[i]) - centre[i];
        const double h = to_double(box.shape.size[i]);
        trace += 2 * volume(box) / mass * (d * d + h * h / 3);
      }
    }
  }

 private:
  static double volume(const CompoundChild& box) {
    const Vec3<Length>& half = box.shape.size;
    return 8 * to_double(half.x) * to_double(half.y) * to_double(half.z);
  }
};

// Σ over the children of I + m·d².
TEST(Compound, MomentsFollowTheParallelAxes) {
  test::Random random(test::run_seed());
  for (int run = 0; run < 200; ++run) {
    SCOPED_TRACE(run);
    const std::vector<CompoundChild> children = random_boxes(random);
    const RealSums sums(children);
    const CompoundResult built = Compound::build(children);
    const geometry::Solid& solid = solid_of(built);
    const double scale = std::ldexp(1, 2 * solid.scale_exponent);
    const double trace =
        to_double(solid.inertia.x) + to_double(solid.inertia.y) + to_double(solid.inertia.z);
    EXPECT_NEAR(value(solid.volume) / sums.mass, 1, 1e-8);
    EXPECT_NEAR(trace * scale / sums.trace, 1, 1e-6);
    for (int i = 0; i < 3; ++i)
      EXPECT_NEAR(to_double(solid.centre[i]), sums.centre[i], 1e-6);
  }
}

TEST(Compound, RefusesWithTheChildAndTheReason) {
  const auto fault = [](const CompoundChild& bad) {
    const CompoundChild children[] = {child(Shape::sphere(1_m), {}), bad};
    const CompoundResult built = Compound::build(children);
    EXPECT_EQ(built.child, built.ok() ? 0U : 1U);
    return built.fault;
  };
  EXPECT_EQ(Compound::build({}).fault, CompoundFault::no_children);
  EXPECT_EQ(fault(child(Shape::half_space(), {})), CompoundFault::invalid_shape);
  EXPECT_EQ(fault(child(Shape::sphere({}), {})), CompoundFault::invalid_shape);
  EXPECT_EQ(fault(child({ShapeKind::hull, {}, {7}}, {})), CompoundFault::missing_asset);
  EXPECT_EQ(fault(child(Shape::sphere(1_m), {512_m, {}, {}})),
            CompoundFault::coordinate_out_of_range);
  CompoundChild bad = child(Shape::sphere(1_m), {});
  bad.density = {};
  EXPECT_EQ(fault(bad), CompoundFault::invalid_density);
  bad = child(Shape::sphere(1_m), {});
  bad.orientation = {{}, {}, {}, {}};
  EXPECT_EQ(fault(bad), CompoundFault::invalid_orientation);
  bad = child(Shape::sphere(1_m), {});
  bad.surface = Surface{1.995_r, {}};
  EXPECT_EQ(fault(bad), CompoundFault::invalid_surface);
}

TEST(Compound, ComesBackFromItsBytesAndFromNoOthers) {
  test::Random random(test::run_seed());
  std::vector<CompoundChild> children;
  for (int i = 0; i < 20; ++i) {
    CompoundChild c = child(Shape::box(1_m, 0.5_m, 0.25_m), {Length::from_integer(i), {}, {}});
    for (int k = 0; k < 4; ++k)
      (k == 0   ? c.orientation.x
       : k == 1 ? c.orientation.y
       : k == 2 ? c.orientation.z
                : c.orientation.w)
          .raw = static_cast<std::int32_t>(random.between(-(1 << 30), 1 << 30));
    if (i % 3 == 0) c.surface = Surface{0.25_r, 0.5_r};
    children.push_back(c);
  }
  const CompoundResult built = Compound::build(children);
  ASSERT_TRUE(built.ok());
  const std::vector<std::byte> bytes = built.compound->canonical_bytes();
  const auto again = Compound::from_bytes(bytes, AssetSet{});
  ASSERT_TRUE(again.ok());
  EXPECT_EQ(again.value()->id(), built.compound->id());
  for (std::size_t i = 0; i < bytes.size(); ++i) {
    std::vector<std::byte> flipped = bytes;
    flipped[i] ^= static_cast<std::byte>(1 << random.between(0, 7));
    const auto loaded = Compound::from_bytes(flipped, AssetSet{});
    if (loaded.ok()) {
      EXPECT_EQ(loaded.value()->canonical_bytes(), flipped);
    }
    EXPECT_FALSE(Compound::from_bytes(ByteView(bytes).first(i), AssetSet{}).ok());
  }
}

}  // namespace
}  // namespace lockstone
