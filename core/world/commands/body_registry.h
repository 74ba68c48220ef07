// Creates and destroys bodies.
#pragma once

#include <cstdint>

#include <lockstone/body.h>
#include <lockstone/status.h>

#include "core/world/commands/joint_registry.h"
#include "core/world/data/world_data.h"
#include "core/world/derived/body_names.h"
#include "core/world/sleep/sleep_flags.h"
#include "core/world/sleep/waking.h"

namespace lockstone {

class BodyRegistry {
 public:
  /// All outlive this.
  BodyRegistry(WorldData& world, SleepFlags& flags, Waking& waking, JointRegistry& joints,
               BodyNames& names)
      : world_(world), flags_(flags), waking_(waking), joints_(joints), names_(names) {}

  Result<BodyHandle> create(const BodyDef& def);
  Status destroy(BodyHandle body);

  /// After `disturb`, when no contact of the body sleeps.
  void drop_contacts_of(std::uint32_t body);

  /// Around a change of a body's record that decides where the body takes part, after `disturb`:
  /// out of the tick, with its contacts, pushes and sleep; and into it as the record says now.
  void leave(std::uint32_t body);
  void enter(std::uint32_t body);

  /// For records that were loaded.
  void rebuild() { free_hint_ = 0; }

 private:
  WorldData& world_;
  SleepFlags& flags_;
  Waking& waking_;
  JointRegistry& joints_;
  BodyNames& names_;
  std::uint32_t free_hint_ = 0;  // no index below this is free
};

}  // namespace lockstone
