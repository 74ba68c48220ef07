#include "core/world/history/island_groups.h"

#include <numeric>

namespace lockstone {

IslandGroups::IslandGroups(std::uint32_t body_capacity)
    : islands_(body_capacity),
      all_(body_capacity),
      links_(body_capacity),
      is_counted_(body_capacity) {
  std::iota(all_.begin(), all_.end(), 0U);
  were_awake_.reserve(body_capacity);
  had_slept_.reserve(body_capacity);
}

void IslandGroups::begin(const WorldData& world) {
  count_ = world.header.body_limit;
  islands_.begin(std::span(all_).first(count_));
  were_awake_.clear();
  had_slept_.clear();
  for (std::uint32_t body = 0; body < count_; ++body) {
    const BodyRecord& record = world.bodies[body];
    links_[body] = links_others(record) ? 1 : 0;
    if (record.is_awake()) were_awake_.push_back(body);
    if (record.moves() && record.is_asleep()) had_slept_.push_back(body);
  }
  for (const JointLink& link : world.joint_graph.links())
    join(link.body_a, link.body_b);
}

void IslandGroups::join(std::span<const Pair> pairs) {
  for (const Pair& pair : pairs)
    join(pair.a, pair.b);
}

// Contacts of sleeping bodies may connect bodies whose bounds do not overlap any more. A kinematic
// body that slept passes it on: when a joint breaks that held a body to it, all others that are
// joined to it wake.
void IslandGroups::join_woken(const WorldData& world, const StateCopy& before) {
  const auto has_woken = [&](std::uint32_t body) {
    return world.bodies[body].is_dynamic() && world.bodies[body].is_awake();
  };
  if (std::ranges::none_of(had_slept_, has_woken)) return;
  const NativeState<WorldStores> state = before.open(world.def);
  for (const std::uint32_t body : had_slept_)
    links_[body] = 1;
  JointRecord joint;
  for (std::uint32_t i = 0; i < state.header.joint_limit; ++i) {
    state.read<JointStore>(i, joint);
    if (joint.exists()) join(joint.body_a, joint.body_b);
  }
  ContactRecord contact;
  for (std::uint32_t i = 0; i < state.header.contact_count; ++i) {
    state.read<ContactStore>(i, contact);
    join(contact.body_a, contact.body_b);
  }
}

void IslandGroups::write(std::vector<std::uint32_t>& groups) {
  groups.resize(count_);
  for (std::uint32_t body = 0; body < count_; ++body)
    groups[body] = islands_.root(body);
}

}  // namespace lockstone
