#include "tools/scenes/scene.h"

#include <array>

#include "tools/scenes/build.h"

namespace lockstone::scenes {

std::span<const Scene> world_scenes() {
  static const std::array k_scenes{
      k_stack,     k_rolling,    k_capsule, k_pyramid,       k_wall,         k_pile,   k_bounce,
      k_friction,  k_kinematic,  k_trigger, k_spawn,         k_far,          k_spin,   k_commands,
      k_hulls,     k_compounds,  k_terrain, k_mesh,          k_bullets,      k_layers, k_sleep,
      k_chain,     k_pendulum,   k_bridge,  k_ragdoll,       k_vehicle,      k_arch,   k_cards,
      k_belts,     k_rollers,    k_drums,   k_cones,         k_coins,        k_crowd,  k_boats,
      k_explosion, k_one_way,    k_race,    k_ragdoll_drive, k_terrain_edit, k_clubs,  k_coaster,
      k_ratchets,  k_trapdoors,  k_dice,    k_pebbles,       k_motorcycle,   k_tank,   k_characters,
      k_level,     k_moving_deck};
  return k_scenes;
}

const Scene* find_scene(std::string_view name) {
  for (const Scene& scene : world_scenes()) {
    if (scene.name == name) return &scene;
  }
  return nullptr;
}

}  // namespace lockstone::scenes
