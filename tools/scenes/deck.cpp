// Meshes that move: a deck that goes, rises and turns with its cargo, and a bowl that rocks.
#include <vector>

#include <lockstone/terrain.h>

#include "tools/scenes/assets.h"
#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

using namespace lockstone::literals;

constexpr std::uint32_t k_deck = 1, k_bowl = 2;  // the bodies' indices, after the ground
constexpr std::uint32_t k_side = 6, k_hatch = 14;

std::vector<AssetPtr> deck_assets(std::uint64_t) {
  return {panels(k_side, k_side, 1200), bowl(3_m, 1_m, 3, 8)};
}

WorldDef deck_world() {
  WorldDef def = small_world();
  def.terrain_tile_capacity = 4;
  return def;
}

void add_cargo(World& world, Random& random, const Vec3<Position>& middle, int count) {
  for (int i = 0; i < count; ++i) {
    const Vec3<Position> at{millimetres(i % 4 * 1100 - 1650), millimetres(600 + i / 16 * 900),
                            millimetres(i / 4 % 4 * 1100 - 1650)};
    BodyDef def = loose(random_shape(random), middle + at);
    def.material.friction = 0.8_r;
    add(world, def);
  }
}

void build_deck(World& world, std::uint64_t seed) {
  add_ground(world, 14_m);
  const std::vector<AssetPtr> assets = deck_assets(seed);
  BodyDef deck = fixed(assets[0]->shape(), {-4_m, 2_m, {}});
  deck.motion = MotionType::kinematic;
  deck.angular_velocity = {{}, 0.4_rps, {}};
  deck.material.friction = 0.8_r;
  add(world, deck);
  BodyDef rocking = fixed(assets[1]->shape(), {6_m, 1.5_m, {}});
  rocking.motion = MotionType::kinematic;
  add(world, rocking);
  Random random(mix(seed));
  add_cargo(world, random, deck.position, 16);
  add_cargo(world, random, {6_m, 2_m, {}}, 8);
}

// To and fro in four seconds; a hatch opens after 2.5.
void drive_deck(World& world, std::uint64_t) {
  const std::uint64_t tick = world.tick();
  const BodyHandle deck = world.body_at(k_deck), rocking = world.body_at(k_bowl);
  if (tick % 120 == 0) {
    const bool goes = tick / 120 % 2 == 0;
    order(world, SetVelocity{deck, {goes ? 0.8_mps : -0.8_mps, goes ? 0.5_mps : -0.5_mps, {}}});
  }
  if (tick % 120 == 60 || tick == 0) {
    const bool left = tick / 120 % 2 == 0;
    order(world, SetAngularVelocity{rocking, {{}, {}, left ? 0.25_rps : -0.25_rps}});
  }
  if (tick == 150) order(world, SetMeshGroup{deck, k_hatch, false});
}

}  // namespace

constinit const Scene k_moving_deck{
    .name = "deck",
    .description = "a deck of triangles carries its cargo, turns and opens a hatch; a bowl rocks",
    .golden_ticks = 300,
    .define = deck_world,
    .builder = build_deck,
    .drive = drive_deck,
    .assets = deck_assets};

}  // namespace lockstone::scenes
