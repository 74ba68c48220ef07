// Executes the commands of a game. Each checks its arguments in full before it writes.
#pragma once

#include <lockstone/command.h>
#include <lockstone/status.h>
#include <lockstone/world.h>

#include "core/dynamics/body/tick_gain.h"
#include "core/world/data/world_data.h"
#include "core/world/phases/step_records.h"

namespace lockstone {

/// A command is written in the file of its kind: bodies and their state (commands.cpp), forces,
/// settings, joints, sleep.
class CommandExecutor {
 public:
  explicit CommandExecutor(World::Impl& world) : world_(world) {}

#define LKS_DECLARE_EXECUTE(Name) Status execute(const Name& command);
  LKS_COMMANDS(LKS_DECLARE_EXECUTE)
#undef LKS_DECLARE_EXECUTE

 private:
  Status push_now(BodyHandle body, const Push& push);
  Status push_in_tick(BodyHandle body, const Push& push);
  void change_shape(const SetShape& command, const geometry::AssetGeometry* asset);
  template <class SetAxis>
  Status set_axis_of(const SetAxis& command, std::size_t first);

  World::Impl& world_;
};

/// The velocities that a push gives a body; gains along locked axes are left out.
[[nodiscard]] Status gain_of(const WorldData& world, BodyHandle body, const Push& push,
                             TickGain& gain);

}  // namespace lockstone
