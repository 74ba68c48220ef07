// Checks of a joint's definition.
#pragma once

#include <cstdint>

#include <lockstone/asset.h>
#include <lockstone/joint.h>

#include "core/dynamics/state/joint_record.h"

namespace lockstone {

/// π in Q27.
inline constexpr std::int32_t k_pi = 421657428;

inline constexpr std::int32_t k_ratio_limit = Number::from_integer(1000).raw;
inline constexpr std::int64_t k_effort_limit = std::int64_t{1} << 56;

/// Whether any of the axes that a ball, hinge, slider, weld or wheel has locked is locked, limited
/// or driven; true of other kinds. A definition that did not begin with JointDef::of has none.
[[nodiscard]] bool holds_something(const JointDef& def);

/// The record of a definition, in the bodies' frames of mass; false where an orientation is none.
[[nodiscard]] bool make_joint(const JointDef& from, const geometry::AssetGeometry* asset_a,
                              const geometry::AssetGeometry* asset_b, JointRecord& joint);

/// How far an anchor may be from the centre of mass, along each axis.
[[nodiscard]] Length anchor_reach(const BodyRecord& body);

}  // namespace lockstone
