// The frame of a path joint, which goes along its path on body a.
#pragma once

#include <lockstone/asset.h>

#include "core/dynamics/body/raw_vec3.h"
#include "core/dynamics/state/joint_record.h"
#include "core/geometry/assets/curve.h"

namespace lockstone {

/// In the axes of the world.
struct PathFrame {
  Mat3 axes{};           // x along the path, z up
  Vec3<Position> gap{};  // from the path to anchor b
  Position distance{};   // along the path
  RawVec3 turning{};     // of the frame on its way along the path, rad/m, Q30
};

/// Null for a path that the set does not have.
[[nodiscard]] const geometry::Curve* find_curve(AssetId path, const AssetSet* assets);

/// The same for other joints than path joints.
[[nodiscard]] inline const geometry::Curve* curve_of(const JointRecord& joint,
                                                     const AssetSet* assets) {
  return joint.is(JointKind::path) ? find_curve(path_of(joint), assets) : nullptr;
}

/// Where anchor b is, `gap` away from frame a of the joint: near the place of the parameter.
[[nodiscard]] PathFrame path_frame(const geometry::Curve& curve, const Mat3& frame_a,
                                   const Vec3<Position>& gap, Position parameter);

}  // namespace lockstone
