// A human figure with the proportions of the one in Box3D's benchmarks: 14 bodies, 13 joints.
#pragma once

#include <lockstone/world.h>

namespace lockstone::bench {

/// Its feet stand at `at`; every body has the user data.
void add_figure(World& world, const Vec3<Position>& at, std::uint64_t user_data);

}  // namespace lockstone::bench
