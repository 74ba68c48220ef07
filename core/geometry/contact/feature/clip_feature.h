// A segment or a polygon clipped against the sides of a face.
#pragma once

#include <span>

#include "core/geometry/contact/feature/contact_feature.h"
#include "core/geometry/contact/manifold/manifold_reduction.h"

namespace lockstone::geometry {

/// The bit of ids of points where two lines cross.
inline constexpr std::uint32_t k_crossing = std::uint32_t{1} << 29;

/// The frame on a face: its origin is the surface above the face's first point.
struct ClipFrame {
  RawVec origin;
  Vec3<Unit> u;
  Vec3<Unit> v;
  Vec3<Unit> normal;
};
[[nodiscard]] ClipFrame frame_on(const ContactFeature& face);

/// The part of `other` over the face, in the face's frame; other's points are `offset` away. Ids of
/// `other` are kept; those of new points name the two lines that cross there. After I. Sutherland
/// and G. Hodgman, Reentrant polygon clipping, in 30 bits a coordinate: resolution 2^-29 of the
/// extent. `shift` is the one that `reduce_to_four` wants.
struct ClippedFeature {
  int count = 0;
  int shift = 0;
  std::array<FaceVertex, k_most_reduced> vertices;

  [[nodiscard]] std::span<FaceVertex> all() {
    return std::span(vertices).first(static_cast<std::size_t>(count));
  }
};
void clip(const ContactFeature& face, const ClipFrame& frame, const ContactFeature& other,
          const RawVec& offset, ClippedFeature& out);

}  // namespace lockstone::geometry
