// The inside of a world: the data that its phases share, and the phases of a tick.
#pragma once

#include <memory>
#include <span>

#include <lockstone/world.h>

#include "core/dynamics/islands/islands.h"
#include "core/world/commands/body_registry.h"
#include "core/world/commands/joint_registry.h"
#include "core/world/data/world_data.h"
#include "core/world/debug/stage_trace.h"
#include "core/world/derived/body_names.h"
#include "core/world/phases/contact_events.h"
#include "core/world/phases/motion/body_mover.h"
#include "core/world/phases/motion/continuous.h"
#include "core/world/phases/motion/left_out.h"
#include "core/world/phases/motion/moved_bodies.h"
#include "core/world/phases/motion/passes.h"
#include "core/world/phases/narrow/narrow_phase.h"
#include "core/world/phases/tick_contacts.h"
#include "core/world/sleep/island_sleep.h"
#include "core/world/sleep/sleep_flags.h"
#include "core/world/sleep/waking.h"

namespace lockstone {

class ContactSolver;
class PairFilter;

/// Phases are built from the data that they read and write and from the phases that they call.
struct World::Impl : WorldData {
  [[gnu::cold]] Impl(const WorldDef& definition, std::shared_ptr<const AssetSet> known_assets);
  ~Impl();

  /// One tick. With `only`, a tick of the bodies whose pairs it takes, as if no others moved.
  StepReport step(PairFilter* only = nullptr);
  /// Makes room for as many workers as `parallel` has.
  void make_room();
  /// Derives the data of the moved bodies' poses again.
  void refresh_moved();
  void forget_events() {
    events.list().clear();
    events.hits().set({});
    joint_registry.clear_events();
  }

  BodyNames names;                // for people: neither state nor derived from it
  bool is_derived_stale = false;  // bits of the state were flipped: derived data may not fit it

  SleepFlags sleep_flags;
  Islands islands;  // scratch that phases share
  TickContacts found;
  std::span<const Pair> pairs;  // of the tick
  Waking waking;
  JointRegistry joint_registry;
  BodyRegistry body_registry;

  // The phases of a tick, in their order.
  NarrowPhase narrow;
  MovedBodies moved;
  LeftOut left_out;
  std::unique_ptr<ContactSolver> solver;  // its headers would take as long to compile as all others here
  ContinuousCollision continuous;
  TriggerPasses passes;
  BodyMover mover;
  ContactEvents events;
  IslandSleep island_sleep;

  StageTrace trace;

 private:
  void find_pairs(StepReport& report, PairFilter* only);
  [[nodiscard]] bool wake_met();
  void solve_contacts(StepReport& report);
  void find_events();
};

}  // namespace lockstone
