// Ranges of fluids, apart from the phase: checks of states need them alone.

#include "core/dynamics/state/limits.h"
#include "core/math/rotation_log.h"
#include "core/world/phases/fluids.h"

namespace lockstone {

const FluidPhase* linked_fluid_phase = nullptr;

Fluid fluid_of(const FluidRecord& record) {
  if (!record.exists()) return {};
  return {record.surface, record.orientation, record.size, record.density,
          record.drag,    record.linear_drag, record.flow, record.mask};
}

bool is_valid(const Fluid& fluid) {
  const auto is_size = [](Position x) { return x > Position{} && x <= k_most_fluid_size; };
  return fluid.density > Density{} && is_within(fluid.surface, k_world_limit) &&
         has_direction(fluid.orientation) && is_size(fluid.size.x) && is_size(fluid.size.y) &&
         is_size(fluid.size.z) && fluid.drag >= Number{} && fluid.drag <= k_most_fluid_drag &&
         fluid.linear_drag >= Rate{} && is_within(fluid.flow, k_speed_limit);
}

}  // namespace lockstone
