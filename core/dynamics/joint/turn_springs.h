// Springs about several axes of a joint that act together, on the rotation that is left to their
// targets: by their own angles, springs about two axes part from each other beyond a quarter turn.
//
// The targets are a rotation vector: frame B is at its target when it is frame A turned by it. With
// θ the rotation vector from there to frame B, and k_i the stiffness about axis i of frame B, the
// springs have the potential ½·Σ k_i·θ_i². It is continuous where θ jumps from π to −π about an
// axis. Its torque is that of impulses along the rows dθ_i/dt = (J(θ)·ω)_i, where J is the inverse
// of the right Jacobian of SO(3): ω + ½·θ × ω + (1 − ½θ·cot ½θ)/θ²·θ × (θ × ω), with |J·ω| ≤
// ½π·|ω|. Without anisotropy the torque is −k·θ.
#pragma once

#include <array>
#include <cstdint>

#include "core/dynamics/body/raw_vec3.h"
#include "core/dynamics/joint/joint_rows.h"
#include "core/dynamics/state/joint_record.h"

namespace lockstone {

enum class SpringTurn : std::uint8_t {
  apart,  ///< each by its own angle
  whole,  ///< two or three axes; a third is locked
  swing,  ///< tilts of the x axis, while the twist has no spring
};

[[nodiscard]] SpringTurn spring_turn(const JointRecord& joint);

/// Whether an angular axis, 3 … 5, has a spring that acts together with others.
[[nodiscard]] bool acts_together(const JointRecord& joint, SpringTurn turn, std::size_t axis);

struct SpringTurnRows {
  std::array<RawVec3, 3> axes{};  ///< of ω of B against A, in world axes, Q30
  RawVec3 errors{};  ///< θ, radians, Q32, each times |axis|²: a row's mass falls by as much
};

/// For `whole` and `swing`; of the latter the first axis is left alone.
[[nodiscard]] SpringTurnRows spring_turn_rows(const JointRecord& joint, SpringTurn turn,
                                              const Quat& orientation_a, const Quat& orientation_b);

}  // namespace lockstone
