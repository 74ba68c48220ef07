// Scenes of cylinders, cones and tapered capsules.
#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

// Three cylinders of different lengths, which roll straight down a slope: a = 2/3 g sin θ.
void build_rollers(World& world, std::uint64_t) {
  const Quat tilt = from_axis_angle(k_z_axis, -0.2_rad);
  const Mat3 axes = to_matrix(tilt);
  add_ground(world, 20_m);
  BodyDef slope = fixed_box({{}, 2_m, {}}, {8_m, 0.5_m, 4_m});
  slope.orientation = tilt;
  add(world, slope);
  for (int i = 0; i < 3; ++i) {
    const Vec3<Length> on_slope{-6.5_m, 0.9_m, millimetres_long(i * 2400 - 2400)};
    BodyDef roller = loose(Shape::cylinder(millimetres_long(150 + 350 * i), 0.4_m),
                           slope.position + rounded<Position>(rotate(axes, on_slope)));
    roller.orientation = multiply(tilt, from_axis_angle(k_x_axis, 1.5707963267_rad));
    add(world, roller);
  }
}

// Drums on one another, a pyramid of lying pipes, and a pile of both that falls.
void build_drums(World& world, std::uint64_t seed, const SceneValues& values) {
  add_ground(world, 20_m);
  for (int i = 0; i < 6; ++i)
    add(world, loose(Shape::cylinder(0.45_m, 0.3_m), {-3_m, millimetres(450 + 900 * i), {}}));
  for (int row = 0; row < 3; ++row) {
    for (int i = 0; i < 3 - row; ++i) {
      BodyDef pipe =
          loose(Shape::cylinder(0.9_m, 0.3_m),
                {millimetres(1000 + 600 * i + 300 * row), millimetres(300 + 520 * row), {}});
      pipe.orientation = from_axis_angle(k_x_axis, 1.5707963267_rad);
      if (row == 0) pipe.material.friction = 1_r;
      add(world, pipe);
    }
  }
  Random random(mix(seed));
  for (int i = 0; i < values[0]; ++i) {
    BodyDef def =
        loose(i % 2 == 0 ? Shape::cylinder(0.2_m, 0.25_m) : Shape::cylinder(0.05_m, 0.3_m),
              {millimetres(random.between(-400, 400)), millimetres(1000 + 500 * i),
               millimetres(4000 + random.between(-400, 400))});
    def.orientation = random_orientation(random);
    add(world, def);
  }
}

// Cones on their base, on a drum, on their side, on their tip, and in a pile.
void build_cones(World& world, std::uint64_t seed, const SceneValues& values) {
  add_ground(world, 20_m);
  add(world, loose(Shape::cone(1_m, 0.4_m), {-3_m, 0.25_m, {}}));
  add(world, loose(Shape::cylinder(0.3_m, 0.5_m), {-1.5_m, 0.3_m, {}}));
  add(world, loose(Shape::cone(0.8_m, 0.3_m), {-1.5_m, 0.8_m, {}}));
  // On its side, pushed: it rolls in a circle about its apex.
  BodyDef roller = loose(Shape::cone(1_m, 0.4_m), {1.5_m, 0.3_m, {}});
  roller.orientation = from_axis_angle(k_z_axis, 1.951302703_rad);  // 90° and its half angle
  roller.angular_velocity = {-4_rps, 1_rps, {}};
  add(world, roller);
  BodyDef top = loose(Shape::cone(0.6_m, 0.4_m), {3.5_m, 0.46_m, {}});
  top.orientation = from_axis_angle(k_x_axis, 3.1_rad);
  add(world, top);
  Random random(mix(seed));
  for (int i = 0; i < values[0]; ++i) {
    BodyDef def = loose(Shape::cone(0.5_m, 0.25_m),
                        {millimetres(random.between(-300, 300)), millimetres(800 + 500 * i),
                         millimetres(3500 + random.between(-300, 300))});
    def.orientation = random_orientation(random);
    add(world, def);
  }
}

// Clubs: one rolls in a circle about its apex, one is thrown at a wall of bricks, one spins
// upright, and a pile falls on a slope.
void build_clubs(World& world, std::uint64_t seed, const SceneValues& values) {
  add_ground(world, 20_m);
  const Shape club = Shape::tapered_capsule(1_m, 0.35_m, 0.15_m);
  // On its side, which leans from the axis by asin 0.2.
  BodyDef roller = loose(club, {-3_m, 0.28_m, -2_m});
  roller.orientation = from_axis_angle(k_z_axis, -1.369438406_rad);
  roller.angular_velocity = {3_rps, {}, {}};
  add(world, roller);
  for (int row = 0; row < 3; ++row) {
    for (int i = 0; i < 3; ++i)
      add(world, loose(Shape::box(0.2_m, 0.2_m, 0.2_m),
                       {3_m, millimetres(200 + 400 * row), millimetres(-2400 + 400 * i)}));
  }
  BodyDef thrown = loose(club, {-0.5_m, 1_m, -2_m});
  thrown.velocity = {7_mps, 2_mps, {}};
  thrown.angular_velocity = {{}, {}, -6_rps};
  add(world, thrown);
  BodyDef top = loose(Shape::tapered_capsule(0.5_m, 0.1_m, 0.4_m), {-3_m, 0.5_m, 2_m});
  top.orientation = from_axis_angle(k_x_axis, 0.05_rad);
  top.angular_velocity = {{}, 30_rps, {}};
  add(world, top);
  BodyDef slope = fixed_box({1_m, 0.5_m, 3_m}, {2_m, 0.2_m, 2_m});
  slope.orientation = from_axis_angle(k_z_axis, -0.3_rad);
  add(world, slope);
  Random random(mix(seed));
  for (int i = 0; i < values[0]; ++i) {
    const auto radius = [&] { return millimetres_long(random.between(80, 250)); };
    // Compilers differ in the order of arguments.
    const Length bottom = radius(), height = millimetres_long(random.between(150, 700)),
                 top_radius = radius();
    BodyDef def = loose(Shape::tapered_capsule(height, bottom, top_radius),
                        {millimetres(1000 + random.between(-300, 300)), millimetres(1400 + 500 * i),
                         millimetres(3000 + random.between(-300, 300))});
    def.orientation = random_orientation(random);
    add(world, def);
  }
}

// Coins: one spins on its rim and settles, one rolls, one falls flat, one is tilted.
void build_coins(World& world, std::uint64_t) {
  add_ground(world, 10_m);
  const Shape coin = Shape::cylinder(0.02_m, 0.4_m);
  const Quat upright = from_axis_angle(k_x_axis, 1.5707963267_rad);
  // Rolls on its rim about its centre, which stays: Ω² = 4 g / (r sin 0.4).
  BodyDef spins = loose(coin, {{}, 0.1742_m, {}});
  spins.orientation = from_axis_angle(k_x_axis, 0.4_rad);
  spins.angular_velocity = {{}, 2.4_rps, -5.69_rps};
  add(world, spins);
  BodyDef rolls = loose(coin, {-5_m, 0.4_m, 2_m});
  rolls.orientation = upright;
  rolls.velocity = {2_mps, {}, {}};
  rolls.angular_velocity = {{}, {}, -5_rps};
  add(world, rolls);
  add(world, loose(coin, {2_m, 0.5_m, {}}));
  BodyDef tilted = loose(coin, {-2_m, 0.5_m, {}});
  tilted.orientation = from_axis_angle(k_z_axis, 0.5_rad);
  add(world, tilted);
}

}  // namespace

const Scene k_rollers = {"rollers", "cylinders of three lengths roll straight down a slope", 240,
                         small_world, build_rollers};
const Scene k_drums{.name = "drums",
                    .description = "a stack of drums, a pyramid of pipes, a pile of cylinders",
                    .golden_ticks = 240,
                    .define = small_world,
                    .builder = build_drums,
                    .own_parameters = {{{"pile", 12, 0, 200}}}};
const Scene k_cones{.name = "cones",
                    .description = "cones on their base, rolling in a circle, on their tip",
                    .golden_ticks = 240,
                    .define = small_world,
                    .builder = build_cones,
                    .own_parameters = {{{"pile", 10, 0, 200}}}};
const Scene k_clubs{.name = "clubs",
                    .description = "tapered capsules roll, are thrown, spin, and fall in a pile",
                    .golden_ticks = 240,
                    .define = small_world,
                    .builder = build_clubs,
                    .own_parameters = {{{"pile", 10, 0, 200}}}};
const Scene k_coins = {"coins", "a coin that spins and settles, one that rolls, two that fall", 300,
                       small_world, build_coins};

}  // namespace lockstone::scenes
