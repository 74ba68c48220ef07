// Queries as phases of a tick ask them.
#pragma once

#include <lockstone/query.h>

#include "core/world/data/world_data.h"

namespace lockstone {

/// As World::cast_ray and World::cast_shape.
[[nodiscard]] RayHit first_hit(const WorldData& world, const Ray& ray, const QueryFilter& filter);
[[nodiscard]] ShapeHit first_hit(const WorldData& world, const ShapeCast& cast,
                                 const QueryFilter& filter);

}  // namespace lockstone
