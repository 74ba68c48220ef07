// Face contacts of two polytopes: the incident face clipped against the sides of the reference
// face.
#pragma once

#include "core/geometry/contact/manifold/contact_choice.h"
#include "core/geometry/contact/polytope/polytope_pair.h"

namespace lockstone::geometry {

/// A reference face of a view's own polytope, against the other.
struct PolytopeFaceMeeting {
  const PolytopeView& view;
  const Vec3<Length>& offset;  ///< own centre to the other's, world axes
  Length margin;
  FaceSupport face;
  bool own_is_b = false;
  const HeldFeatures& held;  ///< of a tick ago
};

/// Features: kind in the two highest of 30 bits.
inline constexpr std::uint32_t k_hull_face_bits = 1U << 28;
inline constexpr std::uint32_t k_hull_edge_bits = 2U << 28;
inline constexpr std::uint32_t k_hull_vertex_bits = 3U << 28;
inline constexpr std::uint32_t k_hull_of_b = 1U << 27;

[[nodiscard]] constexpr bool is_of_hull_face(std::uint32_t feature) {
  return feature >> 28 == k_hull_face_bits >> 28;
}

/// The manifold from the own polytope to the other: up to four points above or below the face.
/// The incident face is, of those around the deepest vertex, the one that is turned most towards
/// the reference (Gregorius, as above; Box3D). Clipped by Sutherland and Hodgman, Reentrant polygon
/// clipping, on a lattice of 30 bits a lane: resolution 2^-29 of the extent. A vertex beyond a side
/// by less than k_snap is moved onto it and keeps its feature; by √2 · k_snap in all. Where all
/// points would be higher than `highest`, there may be none.
[[nodiscard]] Manifold face_manifold(const PolytopeFaceMeeting& meeting,
                                     Fine highest = k_any_separation);

/// One point at the deepest vertex.
[[nodiscard]] Manifold support_manifold(const PolytopeFaceMeeting& meeting);

}  // namespace lockstone::geometry
