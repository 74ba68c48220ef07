// The search for crossings of fronts, which meshes and height fields name through their table.
#pragma once

#include <lockstone/asset.h>

#include "core/geometry/mesh_contact/front_crossing.h"

namespace lockstone::geometry {

/// The first triangle whose front the way begins before, or on, and ends behind or less than
/// k_front_margin before; of equals the lowest part. Up to 31 µm beside a triangle counts, so that
/// nothing falls between two.
[[nodiscard]] FrontCrossing first_front_crossing(const AssetGeometry& asset, const PointWay& way);

}  // namespace lockstone::geometry
