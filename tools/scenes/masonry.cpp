// Structures without mortar: an arch, a house of cards and a wall of bricks.
#include <vector>

#include "tools/scenes/assets.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

// The arch ----------------------------------------------------------------------------------------

constexpr int k_stones = 11;
constexpr Length k_inside = 2_m, k_outside = 2.6_m, k_half_depth = 0.5_m;

// The corner of the arch at the end of `joints` stones; the ends stand on the ground.
Point arch_corner(int joints, Length radius, Length z) {
  if (joints == 0) return {radius, {}, z};
  if (joints == k_stones) return {-radius, {}, z};
  const Vec3<Unit> out = arena::direction_of(static_cast<std::int16_t>(joints * 32768 / k_stones));
  const auto part = [&](Unit u) {
    return Length::from_raw(
        static_cast<std::int32_t>(std::int64_t{u.raw} * radius.raw / (std::int64_t{1} << 30)));
  };
  return {part(out.x), part(out.z), z};
}

// Half a circle, 2 m wide inside, 60 cm thick. All stones are in one frame and share corners.
std::vector<AssetPtr> arch_assets(std::uint64_t) {
  std::vector<AssetPtr> stones;
  for (int i = 0; i < k_stones; ++i) {
    std::vector<Point> points;
    for (const int joint : {i, i + 1}) {
      for (const Length radius : {k_inside, k_outside}) {
        for (const Length z : {-k_half_depth, k_half_depth})
          points.push_back(arch_corner(joint, radius, z));
      }
    }
    stones.push_back(hull_of(points));
  }
  return stones;
}

WorldDef sleepless() {
  WorldDef def = small_world();
  def.sleep_ms = 0;
  return def;
}

void build_arch(World& world, std::uint64_t seed) {
  add_ground(world, 6_m);
  for (const AssetPtr& stone : arch_assets(seed)) {
    BodyDef def = loose(stone->shape(), {});
    def.material.density = 2400_kgpm3;
    def.material.friction = 0.7_r;
    add(world, def);
  }
}

// The house of cards ------------------------------------------------------------------------------

// Cards of 30 cm × 20 cm × 5 mm, 2d thick and 2h high. The first of a pair leans by 29 degrees, the
// edge of the second at 31 degrees against its face; so every card rests on edges that meet faces.
constexpr Position k_pitch = 0.31_m;           // from pair to pair
constexpr Position k_first_rise = 0.132405_m;  // of a centre above its foot: d·sin + h·cos
constexpr Position k_second_rise = 0.129863_m;
constexpr Position k_between = 0.151404_m;   // the centres of a pair
constexpr Position k_over_top = 0.070535_m;  // from the first's centre to where a board lies on it
constexpr Position k_storey = k_first_rise * 2 + 0.005_m;

BodyDef card(const Vec3<Position>& position, Angle lean) {
  BodyDef def = loose(Shape::box(0.0025_m, 0.15_m, 0.1_m), position);
  def.orientation = from_axis_angle(k_z_axis, lean);
  def.material.density = 800_kgpm3;
  def.material.friction = 0.8_r;
  return def;
}

void add_pair(World& world, Position x, Position y) {
  add(world, card({x, y + k_first_rise, {}}, -0.5061455_rad));
  add(world, card({x + k_between, y + k_second_rise, {}}, 0.5410521_rad));
}

// Each storey but the last carries a board, which lies on the first card of every pair.
void build_card_house(World& world, std::uint64_t, const SceneValues& values) {
  const int storeys = values[0];
  BodyDef table = fixed_box({{}, -0.5_m, {}}, {2_m, 0.5_m, 2_m});
  table.material.friction = 0.8_r;
  add(world, table);
  for (int storey = 0; storey < storeys; ++storey) {
    const int pairs = storeys - storey;
    const Position base = k_storey * storey;
    const Position left = -(k_pitch * (pairs - 1)) / 2 - k_between / 2;
    for (int i = 0; i < pairs; ++i)
      add_pair(world, left + k_pitch * i, base);
    if (pairs == 1) continue;
    BodyDef board =
        card({left + k_over_top + k_pitch * (pairs - 1) / 2, base + k_storey - 0.0025_m, {}},
             1.5707963_rad);
    board.shape = Shape::box(0.0025_m, millimetres_long(155 * (pairs - 1) + 60), 0.1_m);
    add(world, board);
  }
}

// The wall ----------------------------------------------------------------------------------------

// Bricks of 50 cm × 25 cm × 20 cm, each laid askew by up to 1.2 mm: of so large an island the
// converged solver leaves most phases unsolved, so it is given up and iterated.
constexpr int k_rows = 10, k_bricks_in_row = 13;

BodyHandle brick(const World& world, std::uint64_t number) {
  return world.body_at(static_cast<std::uint32_t>(1 + number % (k_rows * k_bricks_in_row)));
}

void build_shaken_wall(World& world, std::uint64_t) {
  add_ground(world, 20_m);
  for (int i = 0; i < k_rows * k_bricks_in_row; ++i) {
    const int row = i / k_bricks_in_row;
    const int x = 2500 * (i % k_bricks_in_row) + 1250 * (row % 2) + i % 7;
    BodyDef def = loose(Shape::box(0.25_m, 0.1_m, 0.125_m),
                        {Position::from_ratio(x, 5000), Position::from_ratio(2 * row + 1, 10), {}});
    add(world, def);
  }
}

void push_bricks(World& world, std::uint64_t) {
  if (world.tick() % 60 != 40) return;
  const std::uint64_t number = 60 + world.tick() / 10;
  order(world, SetVelocity{brick(world, number), {{}, {}, 1_mps}});
}

}  // namespace

constinit const Scene k_arch{.name = "arch",
                             .description = "eleven stones stand without mortar",
                             .golden_ticks = 240,
                             .define = sleepless,
                             .builder = build_arch,
                             .assets = arch_assets};
constinit const Scene k_cards{.name = "cards",
                              .description = "20 cards and three boards in four storeys",
                              .golden_ticks = 240,
                              .define = sleepless,
                              .builder = build_card_house,
                              .own_parameters = {{{"storeys", 4, 1, 10}}}};
constinit const Scene k_shaken_wall{.name = "shaken-wall",
                                    .description = "130 bricks, of which one is pushed each second",
                                    .golden_ticks = 150,
                                    .define = sleepless,
                                    .builder = build_shaken_wall,
                                    .drive = push_bricks};

}  // namespace lockstone::scenes
