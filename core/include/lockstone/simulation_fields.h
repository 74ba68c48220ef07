// The fields of records that several formats hold, in their order in all of them.
#pragma once

#include <lockstone/simulation.h>

namespace lockstone {

/// Calls `f(field)` for each field. `Info` is SimulationInfo, const or not.
template <class Info, class F>
void visit_fields(Info& info, F&& f) {
  f(info.abi);
  f(info.config_hash);
  f(info.scene_hash);
  f(info.canary);
  f(info.tick_rate);
  f(info.player_count);
  f(info.input_bytes);
}

}  // namespace lockstone
