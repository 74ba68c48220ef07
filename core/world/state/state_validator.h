// Checks at level 2: whether records are within their ranges, and whether derived data fits the
// state. A check never changes a result.
#pragma once

#include <span>

#include <lockstone/profile.h>
#include <lockstone/world.h>

#include "core/dynamics/state/contact_record.h"

namespace lockstone {

class StateValidator {
 public:
  explicit StateValidator(World::Impl& world) : world_(world) {}

  /// The first fault of a world between two ticks.
  [[nodiscard]] WorldFault find_fault();
  /// Ends the program if the data of a stage is at fault (LKS_CHECK).
  void check_after(StepStage stage);

 private:
  [[nodiscard]] WorldFault find_fault_after(StepStage stage);
  [[nodiscard]] WorldFault fault_of_bodies() const;
  [[nodiscard]] WorldFault fault_of_contacts(std::span<const ContactRecord> records) const;
  [[nodiscard]] WorldFault fault_of_joints() const;
  [[nodiscard]] WorldFault fault_of_rules() const;
  [[nodiscard]] WorldFault fault_of_terrain() const;
  [[nodiscard]] WorldFault fault_of_derived_bodies() const;
  [[nodiscard]] WorldFault fault_of_derived_contacts() const;
  [[nodiscard]] WorldFault fault_of_derived_joints() const;
  [[nodiscard]] WorldFault fault_of_hashes();
  [[nodiscard]] WorldFault fault_of_pairs() const;
  [[nodiscard]] WorldFault fault_of_manifolds() const;

  World::Impl& world_;
};

}  // namespace lockstone
