// Loading. Derived data is kept where the data it follows from did not change: a rollback finds
// most bodies near where it left them.

#include <algorithm>
#include <cstring>

#include "core/world/state/delta.h"
#include "core/world/state/snapshot_format.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// Canonical bytes that were checked.
struct CanonicalState {
  const SnapshotView& view;

  template <class Store>
  void read(std::uint32_t index, typename Store::Record& record) const {
    record = view.record<Store>(index);
  }
};

// Records hold no padding.
template <class Record>
bool same_bytes(const Record& a, const Record& b) {
  return std::memcmp(&a, &b, sizeof(Record)) == 0;
}

// All that is derived of the two but place and bounds.
bool same_make(const BodyRecord& a, const BodyRecord& b) {
  return a.motion == b.motion && a.flags == b.flags && a.shape() == b.shape() &&
         a.filter() == b.filter();
}

bool same_link(const JointRecord& a, const JointRecord& b) {
  return a.kind == b.kind && a.flags == b.flags && a.body_a == b.body_a && a.body_b == b.body_b;
}

}  // namespace

Status World::load(SnapshotKind kind, ByteView bytes) {
  return kind == SnapshotKind::native ? impl_->load_native(bytes) : impl_->load_canonical(bytes);
}

Status World::load_delta(ByteView base, ByteView delta) {
  Result<DeltaState<WorldStores>> state = DeltaState<WorldStores>::open(base, delta, impl_->def);
  if (!state.ok()) return state.status();
  impl_->take(state.value().header, state.value());
  return Status::ok;
}

Status World::Impl::load_native(ByteView bytes) {
  const Result<NativeState<WorldStores>> state = NativeState<WorldStores>::open(bytes, def);
  if (!state.ok()) return state.status();
  take(state.value().header, state.value());
  return Status::ok;
}

Status World::Impl::load_canonical(ByteView bytes) {
  const Result<SnapshotView> view = SnapshotView::open(bytes, def, *assets);
  if (!view.ok()) return view.status();
  if (const Status status = view.value().check(); status != Status::ok) return status;
  const CanonicalState state{view.value()};
  take(view.value().header, state);
  return Status::ok;
}

// Each store's records are read once, in order.
template <class State>
void World::Impl::take(const WorldHeader& loaded, State&& state) {
  forget_events();
  remembers_manifolds = false;
  const bool same_bodies = take_bodies(loaded.body_limit, state);
  const bool same_links = take_joints(loaded.joint_limit, state);
  header = loaded;
  new_contacts.resize(header.contact_count);
  for (std::uint32_t i = 0; i < header.contact_count; ++i)
    state.template read<ContactStore>(i, new_contacts[i]);
  if (is_derived_stale) return rebuild_derived();
  take_contacts();
  refresh_moved();
  broad_phase.settle();
  joint_graph.forget_awake_list();
  if (!same_bodies || !same_links) rebuild_joint_links();
}

// Returns whether every changed body keeps its make (`same_make`), so that only the data of its
// pose is derived again. `moved` lists these bodies.
template <class State>
bool World::Impl::take_bodies(std::uint32_t limit, State& state) {
  const std::uint32_t old_limit = std::min(header.body_limit, def.body_capacity);
  moved.clear();
  free_hint = 0;
  asleep_count = 0;
  bool same = true;
  BodyRecord record;
  for (std::uint32_t i = 0; i < limit; ++i) {
    state.template read<BodyStore>(i, record);
    if (record.is_asleep()) ++asleep_count;
    if (!same_bytes(bodies[i], record)) same &= take_body(i, record);
  }
  for (std::uint32_t i = limit; i < old_limit; ++i)
    same &= take_body(i, {});
  if (limit < old_limit) body_hashes.clear();
  return same;
}

bool World::Impl::take_body(std::uint32_t body, const BodyRecord& record) {
  const bool same = record.exists() && same_make(bodies[body], record);
  bodies[body] = record;
  body_hashes.mark(body);
  if (is_derived_stale) return same;
  if (changed_sleep.has(body) != record.has_changed_sleep()) changed_sleep.flip(body);
  if (same) {
    cache.refresh_contact_rotation(body, record);
    moved.push_back(body);
    return true;
  }
  if (awake.has(body) != record.is_awake()) awake.flip(body);
  if (record.exists()) {
    cache.set_asset(body, assets->find(record.asset));
    refresh(body);
  } else {
    broad_phase.remove(body);
    triggers.erase(body);
  }
  return false;
}

template <class State>
bool World::Impl::take_joints(std::uint32_t limit, State& state) {
  const std::uint32_t old_limit = std::min(header.joint_limit, def.joint_capacity);
  bool same = true;
  JointRecord record;
  const auto take_joint = [&](std::uint32_t joint) {
    if (same_bytes(joints[joint], record)) return;
    same &= same_link(joints[joint], record);
    joints[joint] = record;
    joint_hashes.mark(joint);
  };
  for (std::uint32_t i = 0; i < limit; ++i) {
    state.template read<JointStore>(i, record);
    take_joint(i);
  }
  record = {};
  for (std::uint32_t i = limit; i < old_limit; ++i)
    take_joint(i);
  if (limit < old_limit) joint_hashes.clear();
  return same;
}

// From new_contacts. Those of sleeping bodies are mostly unchanged.
void World::Impl::take_contacts() {
  if (asleep_count != 0 && are_frozen(new_contacts)) {
    active_contacts = 0;
    for (const ContactRecord& contact : new_contacts)
      if (is_awake_pair(contact)) contact_store[active_contacts++] = contact;
    return;
  }
  if (asleep_count != 0 || frozen.count() != 0) return adopt_contacts(new_contacts);
  std::copy(new_contacts.begin(), new_contacts.end(), contact_store.begin());
  active_contacts = header.contact_count;
}

bool World::Impl::is_awake_pair(const ContactRecord& contact) const {
  return awake.has(contact.body_a) || awake.has(contact.body_b);
}

// Whether those of bodies of which none is awake are the frozen ones.
bool World::Impl::are_frozen(std::span<const ContactRecord> all) const {
  bool same = true;
  const auto skip = [&] {
    while (!all.empty() && is_awake_pair(all.front()))
      all = all.subspan(1);
  };
  frozen.for_each(def.body_capacity, [&](const ContactRecord& record) {
    if (!same) return;
    skip();
    same = !all.empty() && same_bytes(all.front(), record);
    if (same) all = all.subspan(1);
  });
  skip();
  return same && all.empty();
}

}  // namespace lockstone
