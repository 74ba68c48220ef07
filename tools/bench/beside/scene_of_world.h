// A speed scene in the plain numbers of `GeneralScene`, so that any engine can play it.
#pragma once

#include <string>

#include "tools/bench/general/scene.h"
#include "tools/bench/speed/speed_scene.h"

namespace lockstone::bench {

struct SceneOfWorld {
  GeneralScene scene;
  std::string lacking;  ///< the part that plain numbers have no place for; empty: none
};

/// Reads the world that the scene makes, by its public interface, and each change that the scene's
/// `drive` makes to bodies: those that it adds or removes, and the motions that it gives to
/// kinematic ones. `drive` must not depend on dynamic bodies, which are disabled while it is
/// followed. Springs and motors of joints are not seen.
[[nodiscard]] SceneOfWorld scene_of_world(const SpeedScene& scene, int ticks);

}  // namespace lockstone::bench
