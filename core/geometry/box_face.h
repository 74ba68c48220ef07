// Face contacts of two boxes: the incident face clipped against the sides of the reference face.
#pragma once

#include <array>

#include "core/geometry/box_pair.h"
#include "core/geometry/manifold_reduction.h"

namespace lockstone::geometry {

/// A face of one box as the reference, and the other box seen in its frame: x and y along the face,
/// z the height above it.
struct FaceFrame {
  const PosedShape& reference;
  const Vec3<Length>& offset;  ///< reference to incident
  Length margin;
  FaceAxis face;                     ///< of the reference; points to the incident box
  RawVec centre;                     ///< of the incident box, in the reference's axes
  std::array<Vec3<Unit>, 3> axes{};  ///< of the incident box, in the reference's axes
  Vec3<Length> incident_half;
  std::uint32_t feature_bits = 0;  ///< which box is the reference
};

[[nodiscard]] FaceFrame frame_on_a(const BoxPair& pair, const FaceAxis& face);

/// `back` holds the reversed offset and must outlive the frame.
[[nodiscard]] FaceFrame frame_on_b(const BoxPair& pair, const FaceAxis& face,
                                   const Vec3<Length>& back);

struct FacePolygon {
  std::array<FaceVertex, 8> vertices;  // no initialiser: little of it is used
  int count;

  [[nodiscard]] std::span<FaceVertex> used() {
    return std::span(vertices).first(static_cast<std::size_t>(count));
  }
};

/// The part of the incident face above or below the reference face, convex, in order.
/// Sutherland and Hodgman, Reentrant polygon clipping. A vertex beyond a side by less than
/// k_snap is moved onto it along the incident face and keeps its feature, so that boxes stacked
/// flush do not change features as they tremble.
[[nodiscard]] FacePolygon clip_incident_face(const FaceFrame& frame);

/// The manifold from the reference to the incident box.
[[nodiscard]] Manifold face_manifold(const FaceFrame& frame);

}  // namespace lockstone::geometry
