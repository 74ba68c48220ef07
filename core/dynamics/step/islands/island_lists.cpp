#include "core/dynamics/step/islands/island_lists.h"

#include <lockstone/assert.h>

#include "core/base/reserved.h"

namespace lockstone {

IslandLists::IslandLists(std::size_t body_capacity, std::size_t contact_capacity,
                         std::size_t joint_capacity) {
  for (Chains* chains : {&bodies_, &contacts_, &joints_})
    chains->first.reserve(body_capacity + 1);
  bodies_.next.reserve(body_capacity + contact_capacity + 1);
  contacts_.next.reserve(contact_capacity);
  joints_.next.reserve(joint_capacity);
}

void IslandLists::clear(Chains& chains, std::uint32_t islands, std::uint32_t items) {
  LKS_ASSERT(is_reserved(chains.first, islands) && is_reserved(chains.next, items));
  chains.first.assign(islands, 0);
  chains.next.assign(items, 0);
}

void IslandLists::push_front(Chains& chains, std::uint32_t island, std::uint32_t item) {
  chains.next[item] = chains.first[island];
  chains.first[island] = item + 1;
}

// From the last to the first, so that chains have them in their order.
void IslandLists::build(const ContactScene& scene, const SolverBodies& bodies,
                        const ContactList& contacts, IslandBuilder& islands) {
  const auto joints = static_cast<std::uint32_t>(scene.joint_links.size());
  clear(bodies_, islands.count(), bodies.count());
  clear(contacts_, islands.count(), contacts.size());
  clear(joints_, islands.count(), joints);
  for (std::uint32_t number = bodies.count(); number-- > 1;) {
    const std::uint32_t island = islands.of(BodyRef::numbered(number));
    if (island == 0) continue;
    LKS_ASSERT(island < islands.count());
    ++islands.tally(island).bodies;
    push_front(bodies_, island, number);
  }
  for (std::uint32_t i = contacts.size(); i-- > 0;)
    push_front(contacts_, islands.of(contacts[{i}]), i);
  for (std::uint32_t i = joints; i-- > 0;) {
    const std::uint32_t island = islands.of(scene, bodies, scene.joint_links[i]);
    LKS_ASSERT(island < islands.count());
    ++islands.tally(island).joints;
    push_front(joints_, island, i);
  }
}

}  // namespace lockstone
