// Finds the islands that rest, and puts their bodies to sleep together.
#pragma once

#include <cstdint>
#include <vector>

#include <lockstone/status.h>
#include <lockstone/world.h>

#include "core/dynamics/islands/islands.h"
#include "core/world/data/world_data.h"
#include "core/world/phases/tick_contacts.h"
#include "core/world/sleep/sleep_flags.h"
#include "core/world/sleep/waking.h"

namespace lockstone {

class IslandSleep {
 public:
  /// No function but this allocates. All outlive this; `islands` is scratch that others may share.
  IslandSleep(WorldData& world, SleepFlags& flags, Waking& waking, Islands& islands,
              const TickContacts& found);

  /// At the end of a tick: counts the ticks of rest, and puts islands to sleep whose bodies all
  /// rested long enough. A kinematic body that stands sleeps by itself.
  void run(StepReport& report);

  /// Puts the island of a dynamic body to sleep by command; refuses if a body of it may not sleep.
  Status put_to_sleep(std::uint32_t body);
  [[nodiscard]] bool may_island_sleep(std::uint32_t body);

  /// Sets the contacts between sleeping bodies aside.
  void freeze_contacts() {
    world_.contacts.freeze([&](std::uint32_t body) { return world_.awake.has(body); });
  }

 private:
  [[nodiscard]] bool watch_bodies();
  void join_islands();
  void hold_overlapping();
  void brake_unrested();
  std::uint32_t island_for_command(std::uint32_t body);

  WorldData& world_;
  SleepFlags& flags_;
  Waking& waking_;
  Islands& islands_;
  const TickContacts& found_;
  std::vector<std::uint32_t> to_sleep_;
};

}  // namespace lockstone
