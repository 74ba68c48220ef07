// Wakes bodies, and all bodies that contacts and joints connect to them.
#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/state/joint_record.h"
#include "core/world/data/world_data.h"
#include "core/world/phases/tick_contacts.h"
#include "core/world/sleep/sleep_flags.h"

namespace lockstone {

/// Bodies are listed first; `wake_listed` then spreads over their contacts and joints. Between the
/// stages of a tick the list is empty, but for bodies that `note_hit` names.
class Waking {
 public:
  /// No function but this allocates. All outlive this. The records of `found` serve as scratch:
  /// wake only where the contacts of a tick are not in use.
  Waking(WorldData& world, SleepFlags& flags, TickContacts& found);

  /// Wakes the body, which sleeps or not, and everything connected to it. Here and below a body
  /// that is awake begins to count its still ticks again.
  void wake(std::uint32_t body);
  void wake_ends(const JointRecord& joint);
  void wake_all();
  /// Wakes each body that a joint connects to an awake one.
  void wake_joined();

  /// The body changes: it wakes, and so do the bodies in contact with it or joined to it.
  void disturb(std::uint32_t body);
  /// The body is new at its place: the bodies that sleep there wake.
  void disturb_around(std::uint32_t body);

  /// Something of the body changed within `here`: the bodies that sleep there wake.
  void disturb_within(const Bounds& here, std::uint32_t body);

  /// Wakes the body at once; the next `wake_listed` wakes the bodies connected to it.
  void list(std::uint32_t body);
  /// The island of a body that is awake is solved again, if it was still.
  void stir(std::uint32_t body);
  /// For a sleeping body that was hit during a step: it wakes by the next `wake_listed`.
  void note_hit(std::uint32_t body) { to_wake_.push_back(body); }
  /// Returns whether any body was listed.
  bool wake_listed();

 private:
  void stir_around(std::uint32_t body);
  void spread_from(std::uint32_t body);

  WorldData& world_;
  SleepFlags& flags_;
  std::vector<ContactRecord>& thawed_;
  std::vector<std::uint32_t> to_wake_;
};

}  // namespace lockstone
