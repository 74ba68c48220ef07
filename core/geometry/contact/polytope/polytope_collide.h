// Pairs with a polytope, which is A; behind `polytope_kernels`.
#pragma once

#include "core/geometry/distance/manifold.h"

namespace lockstone::geometry {

/// B is a polytope or a box. A is preferred as the owner of the reference face. One-sided only A.
/// Without points the normal may be that of a plane which separates by the margin and more.
/// `held`: as in `collide`.
[[nodiscard]] Manifold collide_polytopes(const PosedShape& a, const PosedShape& b,
                                         const Vec3<Length>& offset, Length margin,
                                         const HeldFeatures& held);

/// A centre inside leaves by the face of least depth, the first of equals.
[[nodiscard]] Manifold collide_polytope_sphere(const PosedShape& polytope, const PosedShape& sphere,
                                               const Vec3<Length>& offset, Length margin);

/// Two points when a face meets the capsule's side, else one.
[[nodiscard]] Manifold collide_polytope_capsule(const PosedShape& polytope,
                                                const PosedShape& capsule,
                                                const Vec3<Length>& offset, Length margin);

}  // namespace lockstone::geometry
