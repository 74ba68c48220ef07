// One axis, tried before all others.
#pragma once

#include "core/geometry/distance/manifold.h"

namespace lockstone {

/// True when the unit axis, from A to B in world axes, separates the shapes by clearly more than
/// the margin (122 µm, 2^-26 of the sizes, and the unevenness of merged faces): then `collide`
/// gives no points. So last tick's axis may be tried first, whatever it was, and no result depends
/// on it. Any pair that `collide` takes. The normal of a result without points may be such an axis.
[[nodiscard]] bool separated_along(const PosedShape& a, const PosedShape& b,
                                   const Vec3<Length>& offset, Length margin,
                                   const Vec3<Unit>& axis);

}  // namespace lockstone
