// Other engines that play the neutral scenes. Each is a file here that only a build with
// LOCKSTONE_BENCH_PEERS and that engine's headers has.
#pragma once

#include <span>

#include "tools/bench/neutral/engine.h"

namespace lockstone::bench {

/// All native ones that the project knows of, in this build or not.
[[nodiscard]] std::span<const NeutralMaker> scene_peers();

/// bullet_scenes.cpp: sequential impulses, steps of a sixtieth over the setting.
[[nodiscard]] std::unique_ptr<NeutralEngine> make_bullet_scene(const NeutralScene& scene,
                                                               int setting);

/// ode_scenes.cpp: dWorldQuickStep, an iterative solver of twenty iterations.
[[nodiscard]] std::unique_ptr<NeutralEngine> make_ode_scene(const NeutralScene& scene, int setting);

/// ode_scenes.cpp: dWorldStep, a direct solver, whose time grows with the cube of the number of
/// contacts: only scenes of few contacts.
[[nodiscard]] std::unique_ptr<NeutralEngine> make_ode_direct_scene(const NeutralScene& scene,
                                                                   int setting);

}  // namespace lockstone::bench
