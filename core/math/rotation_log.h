// From orientations back to rotations.
#pragma once

#include <lockstone/quat.h>

#include "core/math/trig.h"

namespace lockstone {

/// The rotation, by at most π, that takes `from` to `to`: integrate(from, θ) = to, within 2^-26
/// rad.
[[nodiscard]] RotationVector rotation_between(const Quat& from, const Quat& to);

/// Whether a quaternion of any origin can be normalised: a norm of at least 2^-10, and components
/// within ±5/4 (beyond, the sum of squares might overflow).
[[nodiscard]] bool has_direction(const Quat& q);

/// The orientation with this rotation matrix, w ≥ 0, components within 2^-28. S. W. Shepperd,
/// "Quaternion from rotation matrix", 1978: by the greatest component.
[[nodiscard]] Quat orientation_of(const Mat3& rotation);

}  // namespace lockstone
