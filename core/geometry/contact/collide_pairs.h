// One function a pair of kinds; A is the kind with the higher number. `collide` arranges the order.
#pragma once

#include "core/geometry/distance/manifold.h"

namespace lockstone::geometry {

/// Of concentric spheres the smaller leaves upwards; of equal ones B.
[[nodiscard]] Manifold collide_spheres(const PosedShape& a, const PosedShape& b,
                                       const Vec3<Length>& offset, Length margin);

/// A sphere centred on the core segment gets a normal square to the capsule's axis.
[[nodiscard]] Manifold collide_capsule_sphere(const PosedShape& capsule, const PosedShape& sphere,
                                              const Vec3<Length>& offset, Length margin);

/// Two points when nearly parallel and side by side (features 1 and 2, along A's axis), else one
/// (feature 0).
[[nodiscard]] Manifold collide_capsules(const PosedShape& a, const PosedShape& b,
                                        const Vec3<Length>& offset, Length margin);

/// A centre inside the box leaves by the nearest face, the first of equals in the order x, y, z.
[[nodiscard]] Manifold collide_box_sphere(const PosedShape& box, const PosedShape& sphere,
                                          const Vec3<Length>& offset, Length margin);

/// Two points when a face meets the capsule's side, else one.
[[nodiscard]] Manifold collide_box_capsule(const PosedShape& box, const PosedShape& capsule,
                                           const Vec3<Length>& offset, Length margin);

/// Whether of two boxes B takes the first place: see `collide`.
[[nodiscard]] bool box_belongs_first(const PosedShape& b, const PosedShape& a,
                                     const Vec3<Length>& offset);

/// A is preferred as the owner of the reference face. With `flip` the manifold is that of B and A,
/// flipped. `held`: as in `collide`. `out` is filled again.
void collide_boxes(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                   Length margin, bool flip, const HeldFeatures& held, Manifold& out);

/// The same where `out` is the manifold on the reference face, which alone does not settle how they
/// meet. No face parts them; no edges are held, and of overlapping boxes not the other face.
void collide_boxes_beyond(const PosedShape& a, const PosedShape& b, const Vec3<Length>& offset,
                          Length margin, bool flip, const HeldFeatures& held, Manifold& out);

/// Whether this feature of a point of two boxes is that of two edges.
[[nodiscard]] bool is_of_edges(std::uint32_t feature);

/// Whether it is of a face, and of one of the second box: the one that does not come first.
[[nodiscard]] bool is_of_face(std::uint32_t feature);
[[nodiscard]] bool is_of_second_face(std::uint32_t feature);

/// Of the deepest features of B, up to four points: a sphere's pole, the poles of a capsule's ends
/// within the margin (features 0 and 1), and of a box or polytope the vertices of the face that is
/// turned most towards the plane, of those around the deepest vertex (features: vertices).
[[nodiscard]] Manifold collide_half_space(const PosedShape& half_space, const PosedShape& b,
                                          const Vec3<Length>& offset, Length margin);

}  // namespace lockstone::geometry
