#include "tools/bench/speed/speed_scene.h"

#include <algorithm>

namespace lockstone::bench {
namespace {

constexpr const SpeedScene* k_scenes[] = {
    &k_large_pyramid, &k_many_pyramids, &k_ball_rain,  &k_capsule_pile, &k_box_rain,
    &k_mixed,         &k_washer,        &k_joint_grid, &k_convex_pile,  &k_junkyard,
    &k_ragdoll_rain,  &k_figure_rain,   &k_terrain,    &k_storm,        &k_city,
    &k_race,          &k_walkers_200,
};

}  // namespace

std::span<const SpeedScene* const> speed_scenes() {
  return k_scenes;
}

const SpeedScene* find_speed_scene(std::string_view name) {
  const auto* const found =
      std::ranges::find_if(k_scenes, [&](const SpeedScene* scene) { return scene->name == name; });
  return found == std::end(k_scenes) ? nullptr : *found;
}

WorldDef speed_def(BroadPhaseKind broad_phase, std::uint32_t bodies, std::uint32_t pairs,
                   std::uint32_t contacts) {
  WorldDef def;
  def.body_capacity = bodies;
  def.pair_capacity = pairs;
  def.contact_capacity = contacts;
  def.broad_phase = broad_phase;
  return def;
}

World make_speed_world(const WorldDef& def, std::vector<AssetPtr> assets) {
  Result<World> world = World::create(def, std::make_shared<const AssetSet>(std::move(assets)));
  LKS_CHECK(world.ok());
  return std::move(world.value());
}

void step_until_asleep(World& world, std::uint32_t bodies) {
  constexpr int k_most_ticks = 240;
  int ticks = 0;
  while (world.step().asleep_bodies < bodies)
    LKS_CHECK(++ticks < k_most_ticks);
}

}  // namespace lockstone::bench
