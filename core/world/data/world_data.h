// The data of a world that all phases of a tick share: its definition, its canonical state, and the
// data derived from that. Phases refer to it; it knows none of them.
#pragma once

#include <algorithm>
#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <vector>

#include <lockstone/world.h>

#include "core/base/parallel.h"
#include "core/collision/broad_phase/broad_phase.h"
#include "core/collision/narrow_phase/placed_shape.h"
#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/contact_record.h"
#include "core/dynamics/state/joint_record.h"
#include "core/dynamics/state/time_step.h"
#include "core/dynamics/state/vehicle_record.h"
#include "core/world/data/rule_tables.h"
#include "core/world/data/terrain_data.h"
#include "core/world/debug/profiler.h"
#include "core/world/derived/body_cache.h"
#include "core/world/derived/index_set.h"
#include "core/world/derived/joint_graph.h"
#include "core/world/state/contact_lists.h"
#include "core/world/state/record_hashes.h"
#include "core/world/state/stores.h"
#include "core/world/state/world_header.h"

namespace lockstone {

/// Pairs closer than this get contact points ahead of time. Half of it widens each body's bounds.
inline constexpr Length k_contact_margin = Length::from_ratio(1, 50);

/// The hashes of records; a change of a record marks it.
struct StoreHashes {
  RecordHashes<BodyRecord, k_body_domain> bodies;
  RecordHashes<JointRecord, k_joint_domain> joints;
};

struct FluidPhase;
struct VehiclePhase;

/// The rest of a body that fluids push in the tick, which the push takes the place of.
struct SavedRest {
  std::uint32_t body = 0;
  std::uint16_t ticks = 0;
  Vec3<Unit> union_a{};
  Vec3<Unit> union_b{};
  Unit union_c{};
};

/// The fluids of a world.
struct FluidData {
  std::array<FluidRecord, k_max_fluids> fluids;  // canonical state: the first header.fluid_limit
  const FluidPhase* fluid_phase = nullptr;       // derived: null only without fluids
  std::vector<SavedRest> rests;                  // scratch of that phase
};

/// The vehicles of a world.
struct VehicleData {
  std::vector<VehicleRecord> vehicles;          // canonical state: the first header.vehicle_count
  const VehiclePhase* vehicle_phase = nullptr;  // derived: null only without vehicles
};

/// The tables of these stores; the header counts the records that exist.
[[nodiscard]] inline std::span<const VehicleRecord> table_of(const VehicleData& data,
                                                             VehicleStore) {
  return data.vehicles;
}
[[nodiscard]] inline std::span<const TerrainTileRecord> table_of(const TerrainData& data,
                                                                 TerrainTileStore) {
  return data.tiles;
}

struct WorldData : FluidData, RuleTables, VehicleData, TerrainData {
  /// No function but this allocates.
  [[gnu::cold]] WorldData(const WorldDef& definition, std::shared_ptr<const AssetSet> known_assets);

  /// Null for a handle of no body or joint that exists.
  [[nodiscard]] const BodyRecord* find(BodyHandle body) const;
  [[nodiscard]] const JointRecord* find(JointHandle joint) const;
  /// The record to be written, or null: the only way for a command to change one that exists.
  [[nodiscard]] BodyRecord* edit(BodyHandle body);
  [[nodiscard]] JointRecord* edit(JointHandle joint);
  [[nodiscard]] BodyHandle handle_of(std::uint32_t body) const {
    return {body, bodies[body].generation};
  }
  [[nodiscard]] std::uint32_t body_count() const;

  /// The body's shape where it is.
  [[nodiscard]] PlacedShape placed(std::uint32_t body) const {
    return cache.placed(body, bodies[body]);
  }
  /// The bounds of the body, swept over the coming tick, with a margin.
  [[nodiscard]] Bounds bounds_of(std::uint32_t body) const;
  /// Brings the data derived from one body up to date: after every write to it.
  void refresh(std::uint32_t body);
  /// The same for bounds and the broad phase alone.
  void refresh_bounds(std::uint32_t body);

  /// The pair of two bodies in the order of the broad phase: the moving one first, else the lower
  /// index.
  [[nodiscard]] Pair pair_of(std::uint32_t a, std::uint32_t b) const;
  /// The pair that the joint exempts from collision, if it does.
  [[nodiscard]] std::optional<Pair> exempt_pair(const JointRecord& joint) const;
  /// Whether a joint exempts the two from collision.
  [[nodiscard]] bool are_joined(std::uint32_t a, std::uint32_t b) const;
  /// Whether a joint or a rule keeps the two from meeting.
  [[nodiscard]] bool are_exempt(std::uint32_t a, std::uint32_t b) const;
  /// Whether a body's path may end at another, as far as filters and joints decide.
  [[nodiscard]] bool is_obstacle(std::uint32_t body, std::uint32_t other) const;
  /// Lists the joints with an awake body again, if any slept, woke, came or went.
  void list_awake_joints() {
    joint_graph.list_awake([&](std::uint32_t body) { return awake.has(body); });
  }

  /// Calls `visit(record)` for every contact there is, by key.
  template <class Visit>
  void for_each_contact(Visit&& visit) const {
    contacts.for_each(header.body_limit, visit);
  }

  /// The records of a store in the order of the state, as `f(span)`, once or more often.
  template <class F>
  void visit(BodyStore, F&& f) const {
    f(std::span(bodies).first(std::min(header.body_limit, def.body_capacity)));
  }
  template <class F>
  void visit(ContactStore, F&& f) const {
    if (contacts.sleeping().count() == 0) return f(contacts.active());
    for_each_contact([&](const ContactRecord& contact) { f(std::span(&contact, 1)); });
  }
  template <class F>
  void visit(JointStore, F&& f) const {
    f(std::span(joints).first(std::min(header.joint_limit, def.joint_capacity)));
  }

  template <class F>
  void visit(FluidStore, F&& f) const {
    f(std::span(fluids).first(std::min<std::size_t>(header.fluid_limit, k_max_fluids)));
  }
  template <class F>
  void visit(PairRuleStore, F&& f) const {
    f(pair_rules_of(*this, header));
  }
  template <class F>
  void visit(SurfaceRuleStore, F&& f) const {
    f(surface_rules_of(*this, header));
  }
  template <class Store, class F>
  void visit(Store, F&& f) const {
    const auto table = table_of(*this, Store{});
    f(table.first(std::min<std::size_t>(header.*Store::k_count, table.size())));
  }

  const WorldDef def;
  const std::shared_ptr<const AssetSet> assets;
  const TimeStep time_step;

  // Canonical state.
  WorldHeader header;
  std::vector<BodyRecord> bodies;  // by index; size: body capacity
  ContactLists contacts;
  std::vector<JointRecord> joints;  // by index; size: joint capacity

  // Derived from the state.
  IndexSet awake;     // bodies that move
  IndexSet triggers;  // triggers that exist
  JointGraph joint_graph;
  BodyCache cache;
  BroadPhase broad_phase;
  StoreHashes hashes;

  // These change no result.
  Profiler profiler;
  Parallel parallel;
};

/// Whether a rule keeps the two from meeting.
[[nodiscard]] inline bool are_ignored(const WorldData& world, std::uint32_t a, std::uint32_t b) {
  if (world.header.pair_rule_count == 0) return false;
  const PairRuleRecord* rule = find_rule(pair_rules_of(world, world.header), rule_key(a, b));
  return rule != nullptr && rule->is_ignored();
}

/// The speed that turning gives to any point of a body, at most, m/s, Q32, less the speed that the
/// contact margin covers: 0 of most bodies.
[[nodiscard]] std::int64_t turning_speed(const WorldData& world, std::uint32_t body);

}  // namespace lockstone
