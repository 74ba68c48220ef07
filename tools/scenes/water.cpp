// Bodies afloat: boats, buoys and barrels in a basin, with wind above it.
#include <array>
#include <vector>

#include <lockstone/compound.h>
#include <lockstone/hull.h>

#include "tools/scenes/assets.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

// Away from the places of other scenes, to which water and wind must not reach.
constexpr Vec3<Position> k_basin{{}, {}, 80_m};

Vec3<Position> in_basin(std::int64_t x, std::int64_t y, std::int64_t z) {
  return k_basin + Vec3<Position>{millimetres(x), millimetres(y), millimetres(z)};
}

// A hull 4 m long, pointed at the bow, narrower at the keel.
AssetPtr boat_hull() {
  std::vector<Vec3<Length>> points;
  for (const Length side : {Length(1_m), Length(-1_m)}) {
    points.push_back({-2_m, 0.4_m, side * 3 / 4});
    points.push_back({1_m, 0.4_m, side * 3 / 4});
    points.push_back({-1.8_m, -0.4_m, side * 3 / 10});
    points.push_back({0.8_m, -0.4_m, side * 3 / 10});
  }
  points.push_back({2_m, 0.4_m, 0_m});
  return Hull::build(points).hull;
}

// The same with a mast, and ballast in a keel: it rights itself.
AssetPtr sailing_boat() {
  std::array<CompoundChild, 3> children;
  children[0].asset = boat_hull();
  children[0].shape = children[0].asset->shape();
  children[1].shape = Shape::cylinder(1.2_m, 0.06_m);
  children[1].position = {0.2_m, 1.6_m, 0_m};
  children[2].shape = Shape::box(0.5_m, 0.35_m, 0.05_m);
  children[2].position = {-0.2_m, -0.75_m, 0_m};
  children[2].density = Number::from_integer(24);
  return Compound::build(children).compound;
}

std::vector<AssetPtr> boat_assets(std::uint64_t) {
  return {boat_hull(), sailing_boat()};
}

void add_basin(World& world) {
  add(world, fixed_box(in_basin(0, -3200, 0), {8.4_m, 0.2_m, 6.4_m}));
  for (const std::int64_t side : {-1, 1}) {
    add(world, fixed_box(in_basin(side * 8200, -1250, 0), {0.2_m, 1.75_m, 6.4_m}));
    add(world, fixed_box(in_basin(0, -1250, side * 6200), {8_m, 1.75_m, 0.2_m}));
  }
  Fluid water{.surface = k_basin, .size = {8_m, 3_m, 6_m}};
  water.density = Density::from_integer(1000);
  water.drag = Number::from_ratio(4, 5);
  water.linear_drag = 0.5_rps;
  order(world, SetFluid{0, water});
  Fluid wind{.surface = in_basin(0, 12000, 0), .size = {8_m, 12_m, 6_m}};
  wind.density = Density::from_ratio(6, 5);
  wind.drag = Number::from_integer(1);
  wind.flow = {6_mps, {}, 1_mps};
  order(world, SetFluid{1, wind});
}

BodyHandle add_afloat(World& world, const Shape& shape, const Vec3<Position>& at,
                      std::int64_t density) {
  BodyDef def = loose(shape, at);
  def.material.density = Density::from_integer(density);
  return add(world, def);
}

// Planks one behind the other, joined at their ends.
void add_pontoons(World& world) {
  BodyHandle last{};
  for (int i = 0; i < 6; ++i) {
    const BodyHandle plank = add_afloat(world, Shape::box(0.55_m, 0.15_m, 0.8_m),
                                        in_basin(i * 1200 - 3000, 100, 4500), 400);
    if (!last.is_null()) {
      JointDef joint = JointDef::of(JointKind::hinge, last, plank);
      joint.frame_a.position = {0.6_m, 0_m, 0_m};
      joint.frame_b.position = {-0.6_m, 0_m, 0_m};
      joint.frame_a.orientation = joint.frame_b.orientation = from_axis_angle(k_y_axis, 90_deg);
      order(world, CreateJoint{joint});
    }
    last = plank;
  }
}

void build_boats(World& world, std::uint64_t seed) {
  add_basin(world);
  const std::vector<AssetPtr> assets = boat_assets(seed);
  add_afloat(world, assets[0]->shape(), in_basin(-3500, 200, -1000), 300);
  for (int i = 0; i < 3; ++i)
    add_afloat(world, Shape::box(0.2_m, 0.2_m, 0.2_m), in_basin(-4300 + i * 700, 850, -1000), 500);
  BodyDef capsized = loose(assets[1]->shape(), in_basin(2500, 800, -2500));
  capsized.material.density = Density::from_integer(180);
  capsized.orientation = from_axis_angle(k_x_axis, 150_deg);
  add(world, capsized);
  add_pontoons(world);
  // Buoys and barrels; a cannonball sinks.
  add_afloat(world, Shape::capsule(0.4_m, 0.25_m), in_basin(-500, 1500, 1500), 400);
  add_afloat(world, Shape::cone(1_m, 0.5_m), in_basin(1500, 1500, 1500), 300);
  add_afloat(world, Shape::cylinder(0.5_m, 0.35_m), in_basin(3500, 1500, 1500), 600);
  add_afloat(world, Shape::sphere(0.4_m), in_basin(5500, 1500, 1500), 250);
  add_afloat(world, Shape::sphere(0.2_m), in_basin(5500, 2500, -500), 7000);
  add_afloat(world, Shape::box(0.4_m, 0.4_m, 0.4_m), in_basin(-5500, 1500, 2500), 900);
}

}  // namespace

constinit const Scene k_boats{
    "boats",     "boats, buoys, barrels and a chain of pontoons afloat, in the wind",
    180,         small_world,
    build_boats, nullptr,
    nullptr,     boat_assets};

}  // namespace lockstone::scenes
