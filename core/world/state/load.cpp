#include <algorithm>
#include <cstring>

#include "core/world/phases/fluids.h"
#include "core/world/phases/vehicle/vehicle_phase.h"
#include "core/world/state/delta.h"
#include "core/world/state/snapshot_format.h"
#include "core/world/state/state_loader.h"
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
  return a.motion == b.motion && a.flags == b.flags && a.hit_speed == b.hit_speed &&
         is_enabled(a) == is_enabled(b) && a.shape() == b.shape() && a.filter() == b.filter();
}

bool same_link(const JointRecord& a, const JointRecord& b) {
  return a.kind == b.kind && a.flags == b.flags && a.body_a == b.body_a && a.body_b == b.body_b;
}

bool is_awake_pair(const WorldData& world, const ContactRecord& contact) {
  return world.awake.has(contact.body_a) || world.awake.has(contact.body_b);
}

}  // namespace

template <class State>
void StateLoader::load(const WorldHeader& loaded, State&& state) {
  world_.forget_events();
  world_.contacts.forget_manifolds();
  const bool same_bodies = take_bodies(loaded.body_limit, state);
  const bool same_links = take_joints(loaded.joint_limit, state);
  world_.fluids = {};
  for (std::uint32_t i = 0; i < loaded.fluid_limit; ++i)
    state.template read<FluidStore>(i, world_.fluids[i]);
  for (std::uint32_t i = 0; i < loaded.pair_rule_count; ++i)
    state.template read<PairRuleStore>(i, world_.pair_rules[i]);
  for (std::uint32_t i = 0; i < loaded.surface_rule_count; ++i)
    state.template read<SurfaceRuleStore>(i, world_.surface_rules[i]);
  for (std::uint32_t i = 0; i < loaded.vehicle_count; ++i)
    state.template read<VehicleStore>(i, world_.vehicles[i]);
  for (std::uint32_t i = 0; i < loaded.terrain_tile_count; ++i)
    state.template read<TerrainTileStore>(i, world_.tiles[i]);
  const bool has_tiles = loaded.terrain_tile_count != 0 || world_.header.terrain_tile_count != 0;
  world_.header = loaded;
  world_.vehicle_phase = linked_vehicle_phase;
  world_.fluid_phase = linked_fluid_phase;
  const auto read_contacts = [&](std::span<ContactRecord> to) {
    for (std::uint32_t i = 0; i < to.size(); ++i)
      state.template read<ContactStore>(i, to[i]);
  };
  if (none_sleeps() && !world_.is_derived_stale) {
    read_contacts(world_.contacts.make_active(loaded.contact_count));
  } else {
    world_.found.records.resize(loaded.contact_count);
    read_contacts(world_.found.records);
    if (world_.is_derived_stale) return rebuild_from(world_.found.records);
    take_contacts();
  }
  world_.refresh_moved();
  if (has_tiles) refresh_terrain(world_);
  world_.broad_phase.settle();
  world_.joint_graph.forget_awake_list();
  if (!same_bodies || !same_links) world_.joint_registry.rebuild();
}

// Returns whether every changed body keeps its make (`same_make`), so that only the data of its
// pose is derived again. `moved` lists these bodies.
template <class State>
bool StateLoader::take_bodies(std::uint32_t limit, State& state) {
  const std::uint32_t old_limit = std::min(world_.header.body_limit, world_.def.body_capacity);
  world_.moved.clear();
  world_.body_registry.rebuild();
  std::uint32_t asleep = 0;
  bool same = true;
  BodyRecord record;
  for (std::uint32_t i = 0; i < limit; ++i) {
    state.template read<BodyStore>(i, record);
    if (record.is_asleep()) ++asleep;
    if (!same_bytes(world_.bodies[i], record)) same &= take_body(i, record);
  }
  for (std::uint32_t i = limit; i < old_limit; ++i)
    same &= take_body(i, {});
  if (limit < old_limit) world_.hashes.bodies.clear();
  world_.sleep_flags.set_asleep_count(asleep);
  return same;
}

bool StateLoader::take_body(std::uint32_t body, const BodyRecord& record) {
  const bool same = record.exists() && same_make(world_.bodies[body], record);
  const bool same_contact_turn =
      world_.bodies[body].recycling_orientation == record.recycling_orientation;
  world_.bodies[body] = record;
  world_.hashes.bodies.mark(body);
  if (world_.is_derived_stale) return same;
  world_.sleep_flags.note_loaded(body);
  if (same && is_enabled(record)) {
    if (!same_contact_turn) world_.cache.refresh_contact_rotation(body, record);
    world_.moved.add(body);
    return true;
  }
  if (record.exists()) {
    world_.cache.set_asset(body, geometry_as_built(world_, body));
    world_.refresh(body);
    return same;
  }
  world_.broad_phase.remove(body);
  world_.triggers.erase(body);
  world_.cache.forget_events(body);
  return false;
}

template <class State>
bool StateLoader::take_joints(std::uint32_t limit, State& state) {
  const std::uint32_t old_limit = std::min(world_.header.joint_limit, world_.def.joint_capacity);
  bool same = true;
  JointRecord record;
  const auto take_joint = [&](std::uint32_t joint) {
    if (same_bytes(world_.joints[joint], record)) return;
    same &= same_link(world_.joints[joint], record);
    world_.joints[joint] = record;
    world_.hashes.joints.mark(joint);
  };
  for (std::uint32_t i = 0; i < limit; ++i) {
    state.template read<JointStore>(i, record);
    take_joint(i);
  }
  record = {};
  for (std::uint32_t i = limit; i < old_limit; ++i)
    take_joint(i);
  if (limit < old_limit) world_.hashes.joints.clear();
  return same;
}

// Neither now nor before the load.
bool StateLoader::none_sleeps() const {
  return world_.sleep_flags.asleep_count() == 0 && world_.contacts.sleeping().count() == 0;
}

// From the records that the tick's contacts hold. Those of sleeping bodies are mostly unchanged.
void StateLoader::take_contacts() {
  const std::span<const ContactRecord> all = world_.found.records;
  const auto is_awake = [&](std::uint32_t body) { return world_.awake.has(body); };
  if (are_sleeping(all))
    world_.contacts.adopt_active(all, is_awake);
  else
    world_.contacts.adopt(all, is_awake);
}

// Whether those of bodies of which none is awake are the sleeping ones.
bool StateLoader::are_sleeping(std::span<const ContactRecord> all) const {
  bool same = true;
  const auto skip = [&] {
    while (!all.empty() && is_awake_pair(world_, all.front()))
      all = all.subspan(1);
  };
  world_.contacts.sleeping().for_each(world_.def.body_capacity, [&](const ContactRecord& record) {
    if (!same) return;
    skip();
    same = !all.empty() && same_bytes(all.front(), record);
    if (same) all = all.subspan(1);
  });
  skip();
  return same && all.empty();
}

// Manifolds, separating axes and hints of the last tick are forgotten as well.
void StateLoader::rebuild() {
  std::vector<ContactRecord>& all = world_.found.records;
  all.clear();
  world_.for_each_contact([&](const ContactRecord& contact) { all.push_back(contact); });
  rebuild_from(all);
}

void StateLoader::rebuild_from(std::span<const ContactRecord> contacts) {
  world_.is_derived_stale = false;
  world_.broad_phase.clear();
  world_.hashes.bodies.clear();
  world_.hashes.joints.clear();
  world_.contacts.forget_manifolds();
  world_.narrow.forget();
  world_.body_registry.rebuild();
  world_.triggers.clear();
  world_.cache.forget_events();
  world_.sleep_flags.rebuild();
  for (std::uint32_t i = 0; i < world_.header.body_limit; ++i) {
    if (!world_.bodies[i].exists()) continue;
    world_.cache.set_asset(i, geometry_as_built(world_, i));
    world_.refresh(i);
  }
  refresh_terrain(world_);
  world_.contacts.adopt(contacts, [&](std::uint32_t body) { return world_.awake.has(body); });
  world_.broad_phase.settle();
  world_.joint_registry.rebuild();
}

Status StateLoader::load_native(ByteView bytes) {
  const Result<NativeState<WorldStores>> state = NativeState<WorldStores>::open(bytes, world_.def);
  if (!state.ok()) return state.status();
  load(state.value().header, state.value());
  return Status::ok;
}

namespace {

Status load_canonical(World::Impl& world, ByteView bytes) {
  const Result<SnapshotView> view = SnapshotView::open(bytes, world.def, *world.assets);
  if (!view.ok()) return view.status();
  if (const Status status = view.value().check(); status != Status::ok) return status;
  const CanonicalState state{view.value()};
  StateLoader(world).load(view.value().header, state);
  return Status::ok;
}

}  // namespace

Status World::load(SnapshotKind kind, ByteView bytes) {
  return kind == SnapshotKind::native ? StateLoader(*impl_).load_native(bytes)
                                      : load_canonical(*impl_, bytes);
}

Status World::load_delta(ByteView base, ByteView delta) {
  Result<DeltaState<WorldStores>> state = DeltaState<WorldStores>::open(base, delta, impl_->def);
  if (!state.ok()) return state.status();
  StateLoader(*impl_).load(state.value().header, state.value());
  return Status::ok;
}

void World::drop_derived() {
  StateLoader(*impl_).rebuild();
}

}  // namespace lockstone
