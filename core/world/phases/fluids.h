// Forces of fluids on the bodies in them.
#pragma once

#include "core/dynamics/state/fluid_record.h"
#include "core/world/data/world_data.h"

namespace lockstone {

inline constexpr Position k_most_fluid_size = Position::from_integer(1 << 21);
inline constexpr Number k_most_fluid_drag = Number::from_integer(100);

/// Around the part of a tick in which bodies move.
struct FluidPhase {
  /// Adds the forces of the tick to those of commands.
  void (*push)(WorldData& world);
  /// Brings back the rest of the bodies that fluids alone pushed: a floating body comes to rest.
  void (*end)(WorldData& world);
};

/// The phase of a program that links the command; null in others, which refuse states with fluids.
extern const FluidPhase* linked_fluid_phase;
[[nodiscard]] const FluidPhase& fluid_phase();

[[nodiscard]] Fluid fluid_of(const FluidRecord& record);

/// Whether a fluid, whose density is not 0, is within its ranges, its orientation a direction.
[[nodiscard]] bool is_valid(const Fluid& fluid);

/// Whether the bounds of a body may overlap a fluid.
[[nodiscard]] bool may_hold(const FluidRecord& fluid, const Bounds& bounds);

}  // namespace lockstone
