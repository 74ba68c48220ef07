// The command that sets a fluid.

#include "core/dynamics/state/limits.h"
#include "core/math/rotation_log.h"
#include "core/world/commands/command_executor.h"
#include "core/world/phases/fluids.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// Before `main`: a program that links this file can load states with fluids.
[[maybe_unused]] const bool k_links_fluids = [] {
  linked_fluid_phase = &fluid_phase();
  return true;
}();

FluidRecord record_of(const Fluid& fluid) {
  if (fluid.density == Density{}) return {};
  return {fluid.surface, fluid.size, fluid.flow,        normalized(fluid.orientation),
          fluid.density, fluid.drag, fluid.linear_drag, fluid.mask};
}

void wake_around(World::Impl& world, const FluidRecord& fluid) {
  if (!fluid.exists() || world.sleep_flags.asleep_count() == 0) return;
  for (std::uint32_t body = 0; body < world.header.body_limit; ++body) {
    if (!world.bodies[body].is_asleep() || !world.bodies[body].is_dynamic()) continue;
    if (may_hold(fluid, world.broad_phase.bounds(body))) world.waking.list(body);
  }
  world.waking.wake_listed();
}

}  // namespace

// The box around the fluid, and above it the bodies that reach into it.
bool may_hold(const FluidRecord& fluid, const Bounds& bounds) {
  const Mat3 axes = to_matrix(fluid.orientation);
  for (int i = 0; i < 3; ++i) {
    const auto along = [&](Position x, Unit axis) {
      return Position::from_raw(raw::multiply_shift(x.raw, axis.raw, Unit::frac_bits));
    };
    const Position reach =
        abs(along(fluid.size.x, axes.x[i])) + abs(along(fluid.size.z, axes.z[i]));
    const Position bottom = -along(fluid.size.y, axes.y[i]);
    const Position low = fluid.surface[i] - reach + min(bottom, Position{});
    const Position high = fluid.surface[i] + reach + max(bottom, Position{});
    if (bounds.upper[i] < round_down(low) || bounds.lower[i] > round_up(high)) return false;
  }
  return true;
}

Status CommandExecutor::execute(const SetFluid& command) {
  if (command.number >= k_max_fluids) return Status::invalid_argument;
  const bool removes = command.fluid.density == Density{};
  if (!removes && !is_valid(command.fluid)) return Status::invalid_argument;
  FluidRecord& record = world_.fluids[command.number];
  const FluidRecord changed = record_of(command.fluid);
  if (changed == record) return Status::ok;
  wake_around(world_, record);
  wake_around(world_, changed);
  record = changed;
  std::uint32_t limit = k_max_fluids;
  while (limit > 0 && !world_.fluids[limit - 1].exists())
    --limit;
  world_.header.fluid_limit = static_cast<std::uint8_t>(limit);
  world_.fluid_phase = linked_fluid_phase;
  return Status::ok;
}

/// The way of `fluid_at` into a world.
class WorldFluids {
 public:
  static const WorldData& of(const World& world) { return *world.impl_; }
};

Fluid fluid_at(const World& world, std::uint32_t number) {
  return number < k_max_fluids ? fluid_of(WorldFluids::of(world).fluids[number]) : Fluid{};
}

}  // namespace lockstone
