// Relates a manifold to the axis that was found: shared by the pairs of solids.
#pragma once

#include "core/geometry/distance/contact_point.h"

namespace lockstone::geometry {

/// Whether the manifold's deepest point is as near as the separating axis says: then its face is
/// where the solids are nearest.
[[nodiscard]] bool attains(const Manifold& manifold, Fine separation);

/// Whether some point touches or overlaps.
[[nodiscard]] bool touches(const Manifold& manifold);

/// Whether a push along one normal is nearly one along the other: within 14°.
[[nodiscard]] bool are_alike(const Vec3<Unit>& a, const Vec3<Unit>& b);

/// The separation of the deepest point; positive where nothing touches.
[[nodiscard]] Fine deepest_of(const Manifold& manifold);

/// A manifold without points whose normal is that of a plane which separates by more than the
/// margin.
[[nodiscard]] Manifold separated_by(const Vec3<Unit>& normal);

/// More than any overlap.
inline constexpr Fine k_any_separation = Fine{1} << 62;

}  // namespace lockstone::geometry
