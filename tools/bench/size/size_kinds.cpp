// The kinds of worlds that are measured in many sizes.
#include <algorithm>

#include "tools/arena/integers.h"
#include "tools/bench/size/size_run.h"
#include "tools/bench/speed/speed_scene.h"
#include "tools/scenes/build.h"

namespace lockstone::bench {
namespace {

using namespace lockstone::literals;
using scenes::millimetres;

constexpr std::uint32_t k_million = 1'000'000;
constexpr std::uint32_t k_floors = 5;
constexpr std::uint32_t k_largest_pile = 50'000;

// The least side of a square, or of a cube, that has room for as many.
std::uint32_t side_of(std::uint32_t count, int dimensions) {
  const auto room = [&](std::uint64_t side) {
    return dimensions == 2 ? side * side : side * side * side;
  };
  std::uint32_t side = 1;
  while (room(side) < count)
    ++side;
  return side;
}

// Of `count` places with a spacing, about the middle.
Position place_of(std::uint32_t index, std::uint32_t count, std::int32_t spacing_mm) {
  return millimetres((2 * static_cast<std::int32_t>(index) + 1 - static_cast<std::int32_t>(count)) *
                     spacing_mm / 2);
}

void add_level_ground(World& world, std::uint32_t side, std::int32_t spacing_mm) {
  scenes::add_ground(world,
                     arena::millimetres_long(static_cast<std::int32_t>(side + 1) * spacing_mm / 2));
}

// Stacks of five boxes on level ground. The boxes of stack i are 5 i + 1 to 5 i + 5.
World make_stacks(std::uint32_t bodies, std::uint16_t sleep_ms) {
  constexpr std::int32_t k_spacing_mm = 2000;
  WorldDef def = speed_def(BroadPhaseKind::tree, bodies + 1, 2 * bodies + 8, bodies + 8);
  def.sleep_ms = sleep_ms;
  World world = make_speed_world(def);
  const std::uint32_t stacks = bodies / k_floors, side = side_of(stacks, 2);
  add_level_ground(world, side, k_spacing_mm);
  for (std::uint32_t stack = 0; stack < stacks; ++stack)
    scenes::add_stack(world,
                      {place_of(stack % side, side, k_spacing_mm),
                       {},
                       place_of(stack / side, side, k_spacing_mm)},
                      static_cast<int>(k_floors));
  return world;
}

World make_awake_stacks(std::uint32_t bodies) {
  return make_stacks(bodies, 0);
}

World make_asleep_stacks(std::uint32_t bodies) {
  World world = make_stacks(bodies, WorldDef{}.sleep_ms);
  step_until_asleep(world, bodies);
  return world;
}

// Pushes the topmost box of one stack in two hundred four times a second.
void push_some(World& world) {
  constexpr std::uint32_t k_one_in = 200, k_every = 15;
  if (world.tick() % k_every != 0) return;
  for (std::uint32_t box = k_floors; box < world.body_limit(); box += k_one_in * k_floors)
    scenes::order(world, ApplyImpulse{world.body_at(box), {Impulse::from_integer(100), {}, {}}});
}

// A cube of boxes of many sizes, apart from each other, that falls apart.
World make_pile(std::uint32_t bodies) {
  constexpr std::int32_t k_spacing_mm = 1000, k_least_mm = 200, k_most_mm = 450;  // half a box
  constexpr std::int32_t k_aside_mm = 50;
  WorldDef def = speed_def(BroadPhaseKind::tree, bodies + 1, 16 * bodies + 8, 8 * bodies + 8);
  def.sleep_ms = 0;
  World world = make_speed_world(def);
  const std::uint32_t side = side_of(bodies, 3);
  scenes::add_ground(world,
                     arena::millimetres_long(static_cast<std::int32_t>(side) * 4 * k_spacing_mm));
  arena::Random random(1);
  const auto half = [&] { return arena::millimetres_long(random.between(k_least_mm, k_most_mm)); };
  const auto aside = [&] { return millimetres(random.between(-k_aside_mm, k_aside_mm)); };
  for (std::uint32_t i = 0; i < bodies; ++i) {
    const Length x = half(), y = half(), z = half();
    const auto layer = static_cast<std::int32_t>(i / (side * side));
    Vec3<Position> at{place_of(i % side, side, k_spacing_mm) + aside(),
                      millimetres(k_spacing_mm / 2 + layer * k_spacing_mm),
                      place_of(i / side % side, side, k_spacing_mm) + aside()};
    scenes::add(world, scenes::loose(Shape::box(x, y, z), at));
  }
  return world;
}

// Ragdolls of ten bodies that fall and lie on each other's limbs, but not on each other.
World make_ragdolls(std::uint32_t bodies) {
  constexpr std::int32_t k_spacing_mm = 4000;
  constexpr std::uint32_t k_parts = 10;
  WorldDef def = speed_def(BroadPhaseKind::tree, bodies + 1, 8 * bodies + 8, 4 * bodies + 8);
  def.joint_capacity = bodies;
  def.sleep_ms = 0;
  World world = make_speed_world(def);
  const std::uint32_t ragdolls = bodies / k_parts, side = side_of(ragdolls, 2);
  add_level_ground(world, side, k_spacing_mm);
  for (std::uint32_t i = 0; i < ragdolls; ++i)
    scenes::add_ragdoll(world, {place_of(i % side, side, k_spacing_mm), 2_m,
                                place_of(i / side, side, k_spacing_mm)});
  return world;
}

constexpr SizeKind k_kinds[] = {
    {"asleep", "stacks of five boxes, asleep but for one in two hundred, which is pushed", 60,
     k_million, make_asleep_stacks, push_some},
    {"stacks", "stacks of five boxes, all awake", 60, k_million, make_awake_stacks},
    {"pile", "a cube of loose boxes that falls into one pile, all awake", 120, k_largest_pile,
     make_pile},
    {"ragdolls", "ragdolls of ten bodies and nine joints that fall over, all awake", 60, 100'000,
     make_ragdolls},
};

}  // namespace

std::span<const SizeKind> size_kinds() {
  return k_kinds;
}

const SizeKind* find_size_kind(std::string_view name) {
  const auto* const found = std::ranges::find(k_kinds, name, &SizeKind::name);
  return found == std::end(k_kinds) ? nullptr : found;
}

}  // namespace lockstone::bench
