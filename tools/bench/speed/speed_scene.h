// The scenes that `lockstone bench speed` times: large, without anything to save or replay.
#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <lockstone/world.h>

namespace lockstone::bench {

/// A scene has no memory besides its world.
struct SpeedScene {
  std::string_view name;
  std::string_view description;
  std::uint32_t ticks = 0;
  World (*make)(BroadPhaseKind broad_phase) = nullptr;

  /// Commands and queries before a step, timed with it; may be null.
  void (*drive)(World& world) = nullptr;

  bool asks = false;  ///< whether `drive` asks queries
};

/// All, in the order in which they are listed.
[[nodiscard]] std::span<const SpeedScene* const> speed_scenes();

/// Null for an unknown name.
[[nodiscard]] const SpeedScene* find_speed_scene(std::string_view name);

/// The default rules with room for that much.
[[nodiscard]] WorldDef speed_def(BroadPhaseKind broad_phase, std::uint32_t bodies,
                                 std::uint32_t pairs, std::uint32_t contacts);

/// An empty world that knows these assets.
[[nodiscard]] World make_speed_world(const WorldDef& def, std::vector<AssetPtr> assets = {});

/// Until that many bodies sleep, which must be soon.
void step_until_asleep(World& world, std::uint32_t bodies);

extern const SpeedScene k_large_pyramid, k_many_pyramids;                  // pyramids.cpp
extern const SpeedScene k_ball_rain, k_capsule_pile, k_box_rain, k_mixed;  // pits.cpp
extern const SpeedScene k_convex_pile;                                     // convex_pile.cpp
extern const SpeedScene k_joint_grid;                                      // joint_grid.cpp
extern const SpeedScene k_washer;                                          // washer.cpp
extern const SpeedScene k_junkyard;                                        // junkyard.cpp
extern const SpeedScene k_ragdoll_rain, k_figure_rain;                     // ragdoll_rain.cpp
extern const SpeedScene k_terrain;                                         // terrain.cpp
extern const SpeedScene k_storm;                                           // storm.cpp
extern const SpeedScene k_city;                                            // city.cpp
extern const SpeedScene k_race, k_walkers_200;                             // play.cpp

}  // namespace lockstone::bench
