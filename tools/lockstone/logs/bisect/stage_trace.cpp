#include "tools/lockstone/logs/bisect/stage_trace.h"

#include <algorithm>

#include <lockstone/profile.h>
#include <lockstone/world.h>

#include "tools/tool/games.h"

namespace lockstone::tool {

StageTrace step_traced(const GameDef& game, Simulation& simulation,
                       std::span<const PlayerInput> inputs) {
  if (auto* own = dynamic_cast<SelfTracing*>(&simulation)) return own->step_traced(inputs);
  World* world = world_of(game, simulation);
  if (world == nullptr) {
    simulation.step(inputs);
    return {};
  }
  world->trace_stages(true);
  simulation.step(inputs);
  const StageDigests& digests = world->stage_digests();
  StageTrace trace;
  trace.push_back({"commands", digests.before});
  for (std::size_t i = 0; i < k_step_stages; ++i)
    trace.push_back({name_of(static_cast<StepStage>(i)), digests.after[i]});
  world->trace_stages(false);
  trace.push_back({"rules", simulation.hash()});
  return trace;
}

std::string first_difference(const StageTrace& here, const StageTrace& there) {
  for (std::size_t i = 0; i < std::min(here.size(), there.size()); ++i) {
    if (here[i].digest != there[i].digest) return here[i].name;
  }
  return {};
}

}  // namespace lockstone::tool
