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

/// Whether a face that was the reference a tick ago stays it: its points overlap no more than the
/// plane of the preferred face shows, `separation`, up to the margins of second_face_threshold.
[[nodiscard]] bool stays_reference(const Manifold& on_face, Fine separation);

/// Whether the points of a face hold better than two edges that met a tick ago: they overlap
/// clearly less, or push nearly the same way.
[[nodiscard]] bool is_better_than_held(const Manifold& on_face, const Vec3<Unit>& edge_normal,
                                       Fine edge_separation);

/// A manifold without points whose normal is that of a plane which separates by more than the
/// margin.
[[nodiscard]] Manifold separated_by(const Vec3<Unit>& normal);

/// More than any overlap.
inline constexpr Fine k_any_separation = Fine{1} << 62;

}  // namespace lockstone::geometry
