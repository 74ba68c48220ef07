// The contact points of any two convex shapes.
#pragma once

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/geometry/distance/manifold.h"

namespace lockstone {

/// Contact points between A and B: those with a separation below `margin` (≥ 0, ≤ 64 m) or not
/// above zero. `offset` = centre of B − centre of A, in world axes, each component within ±2000 m.
/// Depends on nothing but its arguments. Points ascend by feature. Without points, its normal may
/// be that of a plane which separates by the margin and more (see `separated_along`), else it is
/// zero.
///
/// Apart, the least separation is the distance: within 2 µm and 4e-9 of the sizes, for two boxes
/// within 2^-16 m, and beside a box's rim within 1/2048 of the capsule core's distance.
/// Overlapping, the normal is an axis of least overlap; a face is preferred to an edge whose
/// overlap is smaller by less than a tenth and 0.5 mm, and the first of two boxes by 1/32 and 0.25
/// mm. The normal errs by at most 2^-29 in length. Separations saturate at ±128 m. Points lie on
/// both surfaces within 2 µm, for two boxes 32 µm for each flush edge that was snapped, and for two
/// points along a capsule within 1/1000 of its radius; where a capsule's core is inside a box, the
/// point is the deepest of the core.
/// Pairs with a polytope keep to the same bounds as boxes; where more than four points were
/// reduced, the deepest may be 7.6 µm deeper than those kept. A one-sided polytope (a triangle of a
/// mesh) does not collide with a shape whose centre (of a hull: the interior point) is behind its
/// front, and its normals lean backward by at most 2^-10. A half-space meets everything but its
/// like.
///
/// collide(b, a, −offset) gives the same manifold flipped, bit for bit (of two spheres, the anchors
/// within one step; equal shapes with one centre and one rotation have no order). Mirror images
/// give mirror images bit for bit, except where a tie falls to one side: concentric shapes and
/// centres level along the normal, cores that meet, the four of more than four points, equally near
/// vertices, and the order of equal capsules and boxes when the mirror reverses the axis that
/// separates their centres most.
[[nodiscard]] Manifold collide(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                               Length margin);

/// As above, in place; the old contents are overwritten.
void collide(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset, Length margin,
             Manifold& out);

/// As above, with the features of the pair's points a tick ago, in the same order of A and B. Of
/// two boxes, edges that met then do so until a face or other edges overlap less, by a tenth and
/// 0.5 mm; the face whose plane the contact had then keeps it until the other box's is better, by
/// 1/32 and 0.25 mm; and four of more points that were taken are taken again, unless another is 61
/// µm deeper: then it replaces one that carried nothing.
void collide(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset, Length margin,
             const HeldFeatures& held, Manifold& out);

/// True when A and B overlap or touch: for triggers. Agrees with collide(margin 0) having a point
/// with separation ≤ 0.
[[nodiscard]] bool overlaps(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset);

}  // namespace lockstone
