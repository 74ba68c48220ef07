// Bodies thinner than their penetration stay on the front side of meshes and height fields.
#include <algorithm>
#include <array>

#include <gtest/gtest.h>

#include <lockstone/compound.h>
#include <lockstone/height_field.h>
#include <lockstone/hull.h>
#include <lockstone/mesh.h>

#include "tests/support/random.h"
#include "tests/world/world_fixture.h"

namespace lockstone {
namespace {

using namespace literals;
using test::metres;

// Sixteen metres square, a little uneven, triangles of one metre.
AssetPtr field(test::Random& random) {
  constexpr std::uint32_t k_side = 17;
  std::vector<Length> heights;
  for (std::uint32_t i = 0; i < k_side * k_side; ++i)
    heights.push_back(Length::from_ratio(static_cast<int>(random.between(0, 20)), 1000));
  HeightFieldDef def;
  def.columns = def.rows = k_side;
  def.origin = {-8_m, {}, -8_m};
  def.heights = heights;
  return HeightField::build(def).height_field;
}

// A sheet in the plane y = 0 that faces up.
AssetPtr sheet(Length half) {
  const std::array<Vec3<Length>, 4> corners{
      Vec3<Length>{-half, {}, -half}, {-half, {}, half}, {half, {}, half}, {half, {}, -half}};
  constexpr std::array triangles{TriangleIndices{0, 1, 2}, TriangleIndices{0, 2, 3}};
  MeshDef def;
  def.vertices = corners;
  def.triangles = triangles;
  return Mesh::build(def).mesh;
}

// Irregular, a few millimetres thick; null when the points make no hull.
AssetPtr flake(test::Random& random) {
  std::vector<Vec3<Length>> points;
  const auto within = [&](std::int64_t um) {
    return Length::from_ratio(static_cast<int>(random.between(-um, um)), 1'000'000);
  };
  const std::int64_t thickness = std::int64_t{250} << random.between(0, 4);
  for (int i = 0; i < 9; ++i) {
    const Length x = within(400'000), y = within(thickness), z = within(200'000);
    points.push_back({x, y, z});
  }
  return Hull::build(points).hull;
}

World world_on(std::vector<AssetPtr> assets, const AssetPtr& floor) {
  assets.push_back(floor);
  WorldDef def{.body_capacity = 64, .pair_capacity = 1024, .contact_capacity = 1024};
  World world = test::make_world(def, std::make_shared<const AssetSet>(assets));
  BodyDef body;
  body.motion = MotionType::static_body;
  body.shape = floor->shape();
  test::add(world, body);
  return world;
}

std::vector<BodyHandle> drop(World& world, const std::vector<AssetPtr>& hulls,
                             test::Random& random) {
  std::vector<BodyHandle> bodies;
  for (std::size_t i = 0; i < hulls.size(); ++i) {
    const auto n = static_cast<std::int64_t>(i);
    BodyDef def = test::dynamic_body(hulls[i]->shape(), Position::from_integer(n % 5 * 2 - 4),
                                     Position::from_ratio(random.between(3, 20), 10),
                                     Position::from_integer(n / 5 * 2 - 4));
    def.angular_velocity.x.raw = random.between(-(std::int64_t{20} << 32), std::int64_t{20} << 32);
    bodies.push_back(test::add(world, def));
  }
  return bodies;
}

TEST(Fronts, HoldFlakesThatFall) {
  test::Random random(test::run_seed());
  for (const bool is_sheet : {false, true}) {
    std::vector<AssetPtr> hulls;
    while (hulls.size() < 25)
      if (AssetPtr hull = flake(random); hull != nullptr) hulls.push_back(hull);
    const AssetPtr floor = is_sheet ? sheet(8_m) : field(random);
    World world = world_on(hulls, floor);
    const std::vector<BodyHandle> bodies = drop(world, hulls, random);
    for (int tick = 0; tick < 150; ++tick) {
      (void)world.step();
      for (const BodyHandle body : bodies) {
        const BodyView view = world.body(body);
        const bool is_beside =
            std::max(metres(abs(view.position.x)), metres(abs(view.position.z))) > 7.5;
        ASSERT_TRUE(is_beside || metres(view.centre_of_mass.y) > -0.05)
            << "flake " << body.index << " tick " << tick << " of " << is_sheet;
      }
    }
  }
}

TEST(Fronts, LetThroughBodiesFromBehind) {
  World world = world_on({}, sheet(4_m));
  BodyDef def = test::dynamic_body(Shape::box(0.3_m, 0.001_m, 0.3_m), {}, -0.1_m, {});
  def.velocity.y = 3_mps;
  const BodyHandle rising = test::add(world, def);
  def.position = {2_m, -0.0001_m, {}};
  def.velocity = {};
  const BodyHandle behind = test::add(world, def);
  test::step(world, 10);
  EXPECT_GT(metres(world.position(rising).y), 0.2);
  EXPECT_LT(metres(world.position(behind).y), -0.05);
}

// Two plates side by side, with nothing between them: each by itself.
TEST(Fronts, HoldEachThinPieceOfACompound) {
  std::array<CompoundChild, 2> children;
  for (CompoundChild& child : children)
    child.shape = Shape::box(0.2_m, 0.001_m, 0.2_m);
  children[0].position.x = -0.5_m;
  children[1].position.x = 0.5_m;
  const AssetPtr wings = Compound::build(children).compound;
  World world = world_on({wings}, sheet(4_m));
  BodyDef def = test::dynamic_body(wings->shape(), {}, 1_m, {});
  def.angular_velocity.z = 9_rps;
  const BodyHandle body = test::add(world, def);
  for (int tick = 0; tick < 180; ++tick) {
    (void)world.step();
    ASSERT_GT(metres(world.body(body).centre_of_mass.y), -0.01) << tick;
  }
}

TEST(Fronts, PushOutBodiesThatBeginBarelyBeforeThem) {
  World world = world_on({}, sheet(4_m));
  BodyDef def = test::dynamic_body(Shape::box(0.3_m, 0.001_m, 0.3_m), {}, 0.0000005_m, {});
  const BodyHandle plate = test::add(world, def);
  test::step(world, 120);
  EXPECT_NEAR(metres(world.position(plate).y), 0.001, 1e-4);
}

}  // namespace
}  // namespace lockstone
