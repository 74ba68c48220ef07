// A body in a fluid: the fluid that it displaces, and its shadow.
#pragma once

#include <cstdint>

#include <lockstone/units.h>
#include <lockstone/vec3.h>

#include "core/collision/narrow_phase/placed_shape.h"
#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/fluid_record.h"

namespace lockstone {

/// All over the mass of the body, 32 fraction bits, in world axes.
struct Immersion {
  std::int64_t share = 0;      ///< mass of the displaced fluid
  Vec3<Position> moment{};     ///< that mass times its centre from the body's centre of mass, m
  std::int64_t per_metre = 0;  ///< mass displaced by sinking a metre deeper
  std::int64_t shadow = 0;     ///< density times the shadow of the part in the fluid, 1/m
};

/// Of a body of this record whose shape is placed there. `along`: a unit vector, or zero for no
/// shadow.
[[nodiscard]] Immersion immersion_of(const BodyRecord& body, const PlacedShape& placed,
                                     const FluidRecord& fluid, const Vec3<Unit>& along);

}  // namespace lockstone
