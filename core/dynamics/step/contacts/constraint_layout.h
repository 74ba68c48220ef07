// Gives each contact of a tick a colour, and a lane in the blocks of that colour.
//
// Contacts of one colour share no body that moves, so they can be solved side by side; those that
// find no colour stand in the blocks of the overflow colour, which are solved one by one.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "core/base/parallel.h"
#include "core/dynamics/islands/constraint_graph.h"
#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/solver_bodies.h"

namespace lockstone {

class ConstraintLayout {
 public:
  /// No function but this allocates.
  [[gnu::cold]] ConstraintLayout(std::size_t body_capacity, std::size_t contact_capacity);

  /// Blocks that contacts of all colours can need.
  [[nodiscard]] static std::size_t most_blocks(std::size_t contact_capacity);

  /// Colours the contacts in their order, and gives them their lanes: of a colour first those of
  /// one point, then those of two.
  void build(const ContactScene& scene, const SolverBodies& bodies, const ContactList& contacts,
             Parallel& parallel);

  /// Blocks of one colour.
  struct Range {
    std::size_t first = 0;
    std::size_t count = 0;
  };
  [[nodiscard]] const Range& blocks_of(std::size_t color) const { return ranges_[color]; }
  [[nodiscard]] std::size_t block_count() const { return block_count_; }
  [[nodiscard]] std::size_t lane_count() const { return block_count_ * lanes::k_block_lanes; }

  [[nodiscard]] ContactLane lane_of(ContactId contact) const {
    const ConstraintGraph::Place place = graph_.places()[contact.value];
    return {first_lanes_[place.color][place.kind] + place.rank};
  }
  [[nodiscard]] bool has_contact(ContactLane lane) const {
    return contacts_[lane.value].value != k_no_contact;
  }
  /// The contact of a lane that has one.
  [[nodiscard]] ContactId contact_at(ContactLane lane) const {
    LKS_ASSERT(has_contact(lane));
    return contacts_[lane.value];
  }

  /// Whether a contact is between a body that stands still and one that touches nothing else.
  [[nodiscard]] bool is_alone(const ContactRef& contact) const {
    if (contact.a.is_standing() == contact.b.is_standing()) return false;
    const BodyRef moving = contact.a.is_standing() ? contact.b : contact.a;
    return graph_.degree(moving.number()) == 1;
  }

  [[nodiscard]] const ConstraintGraph& graph() const { return graph_; }

 private:
  static constexpr std::uint32_t k_no_contact = 0xffffffff;

  [[nodiscard]] static std::size_t kind_of(const Manifold& manifold);
  void color_contacts(const ContactScene& scene, const SolverBodies& bodies,
                      const ContactList& contacts);

  ConstraintGraph graph_;
  Range ranges_[k_graph_colors + 1];
  std::uint32_t first_lanes_[k_graph_colors + 1][k_constraint_kinds] = {};
  std::size_t block_count_ = 0;
  std::vector<ContactId> contacts_;  // by lane
};

}  // namespace lockstone
