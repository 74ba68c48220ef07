// Where a body's contacts are found.
//
// Finding the points in which two bodies touch costs as much as solving them, and points that
// change keep iterations from coming to rest. So manifolds are computed at the recycling pose of
// each body, and reused until the body has moved too far from it. Meanwhile separations follow to
// first order, as they do within a tick. Recycling contacts of bodies that hardly move is Box3D's
// (E. Catto); here the pose is part of the state, so that a manifold follows from the state alone,
// before and after a load.
#pragma once

#include <array>
#include <cstdint>

#include "core/dynamics/state/body_record.h"
#include "core/geometry/distance/manifold.h"

namespace lockstone {

/// How far a body is from its recycling pose.
struct PoseDelta {
  std::array<std::int32_t, 3> way{};   // of the centre, m, Q32
  std::array<std::int32_t, 3> turn{};  // rotation vector, rad, Q32

  friend bool operator==(const PoseDelta&, const PoseDelta&) = default;
  [[nodiscard]] bool is_none() const {
    return (way[0] | way[1] | way[2] | turn[0] | turn[1] | turn[2]) == 0;
  }
};

/// The centre of the recycling pose, of a body that is near it: a multiple of 2^-20 m, so that
/// geometry reads it as it is.
[[nodiscard]] Vec3<Position> recycling_position(const BodyRecord& body);

/// How far a body may be from its recycling pose, m. In islands that iterations solve: 2 mm, or
/// 2^-9 of its scale where that is less.
[[nodiscard]] Length coarse_range(const BodyRecord& body);
/// In a pile whose bodies are all as near: 16 mm, or an eighth of its scale. Thin bodies that have
/// passed each other are jammed: they tremble from one pair of features to another, which overlaps
/// as much, and rest only where both stay as they are (docs/notes/thin-bodies.md). Box3D goes 50 mm
/// and 14 degrees.
[[nodiscard]] Length wide_range(const BodyRecord& body);
/// In another pile: a sixteenth of its inner radius, between the two. The slow bodies of a pile
/// that is stirred keep their manifolds; thin ones would tip over edges that are no longer there.
[[nodiscard]] Length pile_range(const BodyRecord& body, Length inner_radius);

/// Whether centre and surface are so near to the recycling pose (the centre, within 2^-19 m at
/// least). Of every stored body it holds with `wide_range`.
[[nodiscard]] bool is_near_recycling_pose(const BodyRecord& body, Length range);

/// The recycling pose is the body's own from now on.
void set_recycling_pose(BodyRecord& body);

/// Of a body that is near its recycling pose.
[[nodiscard]] PoseDelta pose_delta_of(const BodyRecord& body);

/// From separations at the recycling poses to those where the bodies are: along the normal, to
/// first order; the error is below 2^-17 m for bodies of a metre within `coarse_range`, and grows
/// with the square of the way. Anchors and the normal stay, so that a wall that leans by a hair
/// gains no lever from it: soft contacts that carry it would buckle.
void shift_manifold(const PoseDelta& a, const PoseDelta& b, Manifold& manifold);

}  // namespace lockstone
