// The bodies, contacts and joints of each island of a tick, as chains in their order.
#pragma once

#include <cstdint>
#include <vector>

#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/contact_scene.h"
#include "core/dynamics/step/input/solver_bodies.h"
#include "core/dynamics/step/islands/island_builder.h"

namespace lockstone {

class IslandLists {
 public:
  /// No function but this allocates.
  [[gnu::cold]] IslandLists(std::size_t body_capacity, std::size_t contact_capacity,
                            std::size_t joint_capacity);

  /// Chains all of them, and counts each island's bodies and joints.
  void build(const ContactScene& scene, const SolverBodies& bodies, const ContactList& contacts,
             IslandBuilder& islands);

  /// Calls `visit(number)` for each body of an island, `visit(contact)` for each contact, and
  /// `visit(link)` for each joint, by its place in the scene's links.
  template <class Visit>
  void for_bodies(std::uint32_t island, const Visit& visit) const {
    walk(bodies_, island, visit);
  }
  template <class Visit>
  void for_contacts(std::uint32_t island, const Visit& visit) const {
    walk(contacts_, island, [&](std::uint32_t i) { visit(ContactId{i}); });
  }
  template <class Visit>
  void for_joints(std::uint32_t island, const Visit& visit) const {
    walk(joints_, island, visit);
  }

 private:
  // The items of each island, as chains: item i stands as i + 1, and 0 ends a chain.
  struct Chains {
    std::vector<std::uint32_t> first;  // by island
    std::vector<std::uint32_t> next;   // by item
  };

  static void clear(Chains& chains, std::uint32_t islands, std::uint32_t items);
  static void push_front(Chains& chains, std::uint32_t island, std::uint32_t item);

  template <class Visit>
  static void walk(const Chains& chains, std::uint32_t island, const Visit& visit) {
    for (std::uint32_t i = chains.first[island]; i != 0; i = chains.next[i - 1])
      visit(i - 1);
  }

  Chains bodies_, contacts_, joints_;
};

}  // namespace lockstone
