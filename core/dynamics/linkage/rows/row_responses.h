// The rows of a joint where its bodies are: errors, Jacobians, and responses to impulses.
#pragma once

#include <cstdint>

#include "core/dynamics/linkage/system/joint_system.h"

namespace lockstone {

/// The inputs of a joint's rows, with its bodies and frames where they are now.
[[nodiscard]] JointPlace place_now(const JointSystem& system, const LinkedJoint& joint);
/// And where they will be after the substep; `room` may hold its frames.
[[nodiscard]] JointPlace place_ahead(const JointSystem& system, const LinkedJoint& joint,
                                     JointFrames& room);

/// Makes the rows of a joint where the bodies are now.
void linearize(const JointSystem& system, LinkedJoint& joint);

/// Makes those of all joints of a cluster. A direct factor stays, as one of earlier rows.
void linearize(JointSystem& system, const JointCluster& cluster);

/// Finds the responses of the first `rows` rows to impulses, where the bodies are now or half a
/// substep ahead.
void find_responses(const JointSystem& system, LinkedJoint& joint, std::size_t rows, bool ahead);

/// |J|² + G·M·Gᵀ of one side of a row: its response to itself, Q30.
[[nodiscard]] std::int64_t self_response(const RawVec3& linear, const RawVec3& angular,
                                         const RawVec3& response);

}  // namespace lockstone
