#include "tools/scenes/scene.h"

#include <algorithm>
#include <array>

#include "tools/scenes/build.h"

namespace lockstone::scenes {
namespace {

constexpr std::uint32_t k_many_bodies = 4096;

// Downwards, cm/s².
std::int32_t gravity_of(const WorldDef& def) {
  return static_cast<std::int32_t>(
      raw::round_divide(std::int64_t{-100} * def.gravity.y.raw, Acceleration::from_integer(1).raw));
}

SceneValues usual_values(std::span<const SceneParameter> parameters) {
  SceneValues values{};
  std::ranges::transform(parameters, values.begin(),
                         [](const SceneParameter& one) { return one.usual; });
  return values;
}

}  // namespace

std::span<const Scene> world_scenes() {
  static const std::array k_scenes{
      k_stack,      k_rolling,   k_capsule,       k_pyramid,      k_wall,       k_pile,
      k_bounce,     k_friction,  k_kinematic,     k_trigger,      k_spawn,      k_far,
      k_spin,       k_commands,  k_hulls,         k_compounds,    k_terrain,    k_mesh,
      k_bullets,    k_layers,    k_sleep,         k_chain,        k_pendulum,   k_bridge,
      k_ragdoll,    k_vehicle,   k_arch,          k_cards,        k_belts,      k_rollers,
      k_drums,      k_cones,     k_coins,         k_crowd,        k_boats,      k_explosion,
      k_one_way,    k_race,      k_ragdoll_drive, k_terrain_edit, k_clubs,      k_coaster,
      k_ratchets,   k_trapdoors, k_dice,          k_pebbles,      k_motorcycle, k_tank,
      k_characters, k_level,     k_moving_deck,   k_shaken_wall,  k_net};
  return k_scenes;
}

void Scene::build(World& world, std::uint64_t seed) const {
  builder(world, seed, usual_values(parameters_of(*this)));
}

std::vector<SceneParameter> parameters_of(const Scene& scene) {
  std::vector<SceneParameter> list;
  for (const SceneParameter& one : scene.own_parameters)
    if (!one.name.empty()) list.push_back(one);
  const WorldDef def = scene.define();
  list.push_back({"substeps", def.substeps, 1, 16});
  list.push_back({"gravity", gravity_of(def), 0, 3000});
  return list;
}

Result<SceneValues> scene_values(const Scene& scene, std::span<const std::int32_t> given) {
  const std::vector<SceneParameter> list = parameters_of(scene);
  if (given.size() > list.size()) return Status::invalid_argument;
  SceneValues values = usual_values(list);
  for (std::size_t i = 0; i < given.size(); ++i) {
    if (given[i] < list[i].least || given[i] > list[i].most) return Status::invalid_argument;
    values[i] = given[i];
  }
  return values;
}

WorldDef define_scene(const Scene& scene, const SceneValues& values) {
  WorldDef def = scene.define();
  const std::vector<SceneParameter> list = parameters_of(scene);
  const std::size_t own = list.size() - 2;
  const SceneValues usual = usual_values(list);
  if (!std::equal(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(own),
                  usual.begin())) {
    def.body_capacity = std::max(def.body_capacity, k_many_bodies);
    def.pair_capacity = std::max(def.pair_capacity, 16 * k_many_bodies);
    def.contact_capacity = std::max(def.contact_capacity, 8 * k_many_bodies);
    def.joint_capacity = std::max(def.joint_capacity, k_many_bodies);
  }
  def.substeps = static_cast<std::uint8_t>(values[own]);
  if (values[own + 1] != usual[own + 1])
    def.gravity.y = Acceleration::from_ratio(-values[own + 1], 100);
  return def;
}

const Scene* find_scene(std::string_view name) {
  for (const Scene& scene : world_scenes()) {
    if (scene.name == name) return &scene;
  }
  return nullptr;
}

}  // namespace lockstone::scenes
