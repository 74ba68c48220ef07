// Fast and small bodies against thin ones.
#include <vector>

#include "tools/scenes/assets.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr int k_hill_samples = 9;

// A hillside of 8 m that faces the shooters.
AssetPtr hillside() {
  std::vector<Length> heights;
  for (int j = 0; j < k_hill_samples; ++j) {
    for (int i = 0; i < k_hill_samples; ++i)
      heights.push_back(millimetres_long(i * 500 + (i * j * 7 + j * 3) % 5 * 60));
  }
  HeightFieldDef def;
  def.columns = def.rows = k_hill_samples;
  def.origin = {{}, {}, -2_m};
  def.cell_x = def.cell_z = 0.5_m;
  def.heights = heights;
  const HeightFieldResult made = HeightField::build(def);
  LKS_CHECK(made.ok());
  return made.height_field;
}

enum : std::size_t { k_wall, k_hill, k_shard, k_room_wall };

std::vector<AssetPtr> bullet_assets(std::uint64_t seed) {
  Random random(mix(seed));
  return {wall_mesh(2_m, 1.5_m), hillside(), random_hull(random, {0.08_m, 0.03_m, 0.04_m}, 12),
          wall_mesh(14_m, 6_m)};
}

// Targets stand in rows along x, one row every 4.5 m of z.
constexpr int k_row_mm = 4500;

void shoot(World& world, const Shape& shape, int row, int height_mm, int aside_mm, int speed,
           bool bullet = false) {
  BodyDef def = loose(shape, {millimetres(-8000 - speed * 8), millimetres(height_mm),
                              millimetres(row * k_row_mm + aside_mm)});
  def.velocity = {Velocity::from_integer(speed), 1_mps, {}};
  def.angular_velocity = {3_rps, 20_rps, 5_rps};
  def.is_bullet = bullet;
  def.material.density = 7800_kgpm3;
  def.linear_damping = 0.5_rps;
  def.angular_damping = 1_rps;
  add(world, def);
}

void shoot_volley(World& world, std::span<const AssetPtr> assets, int row) {
  for (int i = 0; i < 4; ++i) {
    const int aside_mm = i * 600 - 900, speed = 60 + 110 * i;
    shoot(world, Shape::sphere(0.04_m), row, 700, aside_mm, speed);
    shoot(world, Shape::box(0.05_m, 0.02_m, 0.03_m), row, 1300, aside_mm, speed);
    shoot(world, assets[k_shard]->shape(), row, 1900, aside_mm, speed);
  }
}

// Thin plates that stand free: a bullet is stopped by the first, a body that is none may pass.
void add_plates(World& world, int row) {
  for (int i = 0; i < 3; ++i) {
    for (const int aside_mm : {-900, 900}) {
      add(world, loose(Shape::box(0.04_m, 0.5_m, 0.6_m),
                       {millimetres(i * 800), 0.5_m, millimetres(row * k_row_mm + aside_mm)}));
    }
  }
  shoot(world, Shape::sphere(0.1_m), row, 600, -900, 301, true);
  shoot(world, Shape::sphere(0.1_m), row, 600, 900, 301, false);
}

void add_rod(World& world, int row) {
  BodyDef rod = loose(Shape::capsule(0.8_m, 0.03_m), {-1.2_m, 1.2_m, millimetres(row * k_row_mm)});
  rod.velocity = {6_mps, {}, {}};
  rod.angular_velocity = {{}, {}, 60_rps};
  rod.gravity_scale = {};
  add(world, rod);
}

// Four walls of two triangles each, met from inside only.
void add_room(World& world, const Shape& wall) {
  for (int i = 0; i < 4; ++i) {
    const Vec3<Unit> out = arena::direction_of(static_cast<std::int16_t>(i * 16384));
    const auto metres = [](Unit part, int count) {
      return Position::from_raw(std::int64_t{part.raw} * 4 * count);
    };
    BodyDef def = fixed(wall, {metres(out.x, 12), 6_m, metres(out.z, 12)});
    def.orientation = from_axis_angle(k_y_axis, Angle::from_raw(-210828714 * i));  // -π/2
    add(world, def);
  }
}

void build_bullets(World& world, std::uint64_t seed) {
  const std::vector<AssetPtr> assets = bullet_assets(seed);
  add(world, fixed(Shape::half_space(), {}));
  add(world, fixed_box({{}, 1.5_m, {}}, {0.005_m, 1.5_m, 2_m}));
  add(world, fixed(assets[k_wall]->shape(), {{}, 1.5_m, millimetres(k_row_mm)}));
  add(world, fixed(assets[k_hill]->shape(), {-1_m, {}, millimetres(2 * k_row_mm)}));
  add_room(world, assets[k_room_wall]->shape());
  for (int row = 0; row < 3; ++row)
    shoot_volley(world, assets, row);
  add_plates(world, -1);
  add(world, fixed_box({{}, 1.5_m, millimetres(-2 * k_row_mm)}, {0.01_m, 1.5_m, 2_m}));
  add_rod(world, -2);
  add(world, fixed_box({8_m, 2_m, millimetres(-k_row_mm)}, {0.5_m, 2_m, 2_m}));
}

}  // namespace

constinit const Scene k_bullets{.name = "bullets",
                                .description = "fast shots against thin walls, mesh and hillside",
                                .golden_ticks = 300,
                                .define = small_world,
                                .builder = build_bullets,
                                .assets = bullet_assets};

}  // namespace lockstone::scenes
