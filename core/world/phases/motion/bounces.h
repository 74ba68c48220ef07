// Bounces within the tick: groups of bodies that touch nothing but each other and immovable bodies,
// with restitution in every contact. They are moved from impact to impact (impact_island.h); the
// contact solver leaves them out.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/impact/impact_island.h"
#include "core/dynamics/islands/islands.h"
#include "core/dynamics/state/contact_record.h"
#include "core/world/data/world_data.h"
#include "core/world/phases/motion/moved_bodies.h"
#include "core/world/phases/step_records.h"
#include "core/world/phases/tick_contacts.h"

namespace lockstone {

class Bounces {
 public:
  /// No function but this allocates. All outlive this; `islands` is scratch that others may share.
  Bounces(WorldData& world, TickContacts& found, MovedBodies& moved, Islands& islands);

  /// Finds the groups among the contacts of this tick, and takes their contacts from the solver.
  void find();
  /// Moves all groups to the end of the tick.
  void run();

  /// The contacts of all groups, group by group.
  [[nodiscard]] std::span<const BouncingContact> contacts() const { return contacts_; }
  /// Of these contacts, the first ones, where any body has hit events; else none.
  [[nodiscard]] std::span<const ImpactTotal> totals() const { return totals_; }
  [[nodiscard]] bool has_moved(std::uint32_t body) const { return has_bounced_[body] != 0; }

 private:
  void join_groups();
  [[nodiscard]] bool is_ballistic(std::uint32_t body) const;
  [[nodiscard]] bool one_is_ballistic(const ContactRecord& record) const;
  [[nodiscard]] std::uint32_t root_of(const ContactRecord& record);
  [[nodiscard]] ImpactPair pair_of(std::size_t contact);
  [[nodiscard]] bool may_bounce(const ContactRecord& record);
  void look_for(std::size_t contact);
  [[nodiscard]] bool turns_much(std::uint32_t body) const;
  void mark(std::size_t contact);
  void run_group(std::uint32_t index);

  WorldData& world_;
  TickContacts& found_;
  MovedBodies& moved_;
  Islands& islands_;
  std::vector<BouncingContact> contacts_;  // by group, a group by its least body
  std::vector<ImpactTotal> totals_;
  std::vector<std::uint32_t> groups_, bodies_;  // a group is the index of its first contact
  std::vector<std::uint8_t> has_bounced_;       // by body
  std::vector<std::uint8_t> marks_;             // by body
};

}  // namespace lockstone
