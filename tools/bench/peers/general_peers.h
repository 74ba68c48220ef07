// Engines of checkouts that the user names, beside ours on the families of scenes.
#pragma once

#include "tools/bench/general/engine.h"

namespace lockstone::bench {

/// box3d_general.cpp
[[nodiscard]] std::unique_ptr<GeneralEngine> make_box3d_general(const GeneralScene& scene,
                                                                int substeps);
/// jolt_general.cpp
[[nodiscard]] std::unique_ptr<GeneralEngine> make_jolt_general(const GeneralScene& scene,
                                                               int substeps);

}  // namespace lockstone::bench
