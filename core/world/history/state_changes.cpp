#include "core/world/history/state_changes.h"

#include <algorithm>

namespace lockstone {
namespace {

template <class Store>
bool has_changed(const WorldData& world, const NativeState<WorldStores>& before) {
  bool changed = world.header.*Store::k_count != before.header.*Store::k_count;
  for_each_record<Store>(world, [&](std::uint32_t index, const auto& record) {
    changed = changed || !is_same<Store>(record, before, index);
  });
  return changed;
}

}  // namespace

StateChanges::StateChanges(std::uint32_t body_capacity)
    : is_changed_(body_capacity), is_end_(body_capacity) {
  bodies_.reserve(body_capacity);
  ends_.reserve(body_capacity);
}

void StateChanges::find(const WorldData& world, const NativeState<WorldStores>& before) {
  for (const std::uint32_t body : bodies_)
    is_changed_[body] = 0;
  for (const std::uint32_t body : ends_)
    is_end_[body] = 0;
  bodies_.clear();
  ends_.clear();
  any_ = concern_all_ =
      world.header.tick != before.header.tick || world.header.gravity != before.header.gravity ||
      has_changed<FluidStore>(world, before) || has_changed<PairRuleStore>(world, before) ||
      has_changed<SurfaceRuleStore>(world, before) || has_changed<TerrainTileStore>(world, before);
  if (concern_all_) return;
  any_ = has_changed<VehicleStore>(world, before);
  find_bodies(world, before);
  find_contacts(world, before);
  find_joints(world, before);
}

void StateChanges::find_bodies(const WorldData& world, const NativeState<WorldStores>& before) {
  const std::uint32_t known = before.header.body_limit;
  const std::uint32_t end = std::max(known, world.header.body_limit);
  for (std::uint32_t i = 0; i < end; ++i) {
    const BodyRecord& now = world.bodies[i];
    if (i < known ? is_same<BodyStore>(now, before, i) : now == BodyRecord{}) continue;
    any_ = true;
    bodies_.push_back(i);
    is_changed_[i] = 1;
  }
}

// Both by key.
void StateChanges::find_contacts(const WorldData& world, const NativeState<WorldStores>& before) {
  const std::uint32_t count = before.header.contact_count;
  std::uint32_t at = 0;
  ContactRecord old;
  const auto read_old = [&] {
    if (at < count) before.read<ContactStore>(at, old);
  };
  read_old();
  world.for_each_contact([&](const ContactRecord& now) {
    if (at < count && is_same<ContactStore>(now, before, at)) {
      ++at;
      return read_old();
    }
    for (; at < count && old.key() <= now.key(); read_old()) {
      add_ends(world, old);
      ++at;
    }
    add_ends(world, now);
  });
  for (; at < count; read_old()) {
    add_ends(world, old);
    ++at;
  }
}

void StateChanges::find_joints(const WorldData& world, const NativeState<WorldStores>& before) {
  const std::uint32_t known = before.header.joint_limit;
  const std::uint32_t end = std::max(known, world.header.joint_limit);
  for (std::uint32_t i = 0; i < end; ++i) {
    const JointRecord& now = world.joints[i];
    if (i < known ? is_same<JointStore>(now, before, i) : now == JointRecord{}) continue;
    any_ = true;
    if (now.exists()) add_ends(world, now);
    JointRecord old;
    if (i < known) before.read<JointStore>(i, old);
    if (old.exists()) add_ends(world, old);
  }
}

template <class Record>
void StateChanges::add_ends(const WorldData& world, const Record& record) {
  const auto reaches = [&](std::uint32_t body) {
    return has(body) || links_others(world.bodies[body]);
  };
  any_ = true;
  if (std::max(record.body_a, record.body_b) >= is_end_.size()) {  // of damaged memory
    concern_all_ = true;
    return;
  }
  concern_all_ = concern_all_ || (!reaches(record.body_a) && !reaches(record.body_b));
  add_end(record.body_a);
  add_end(record.body_b);
}

void StateChanges::add_end(std::uint32_t body) {
  if (is_end_[body] != 0) return;
  is_end_[body] = 1;
  ends_.push_back(body);
}

}  // namespace lockstone
