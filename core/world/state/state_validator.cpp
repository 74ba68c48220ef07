// Checks at level 2: whether records are within their ranges, and whether derived data fits the
// state. Nothing here writes; the level never changes a result.

#include "core/world/state/state_validator.h"

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_path.h"
#include "core/world/commands/command_checks.h"
#include "core/world/state/record_checks.h"
#include "core/world/state/stores.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// Within 2^-26.
bool is_unit(const Vec3<Unit>& n) {
  const std::int64_t error = dot(n, n).raw - (std::int64_t{1} << 60);
  return std::abs(error) < (std::int64_t{1} << 35);
}

bool has_features_of_its_own(const Manifold& manifold) {
  for (int i = 0; i < manifold.count; ++i) {
    for (int j = 0; j < i; ++j) {
      if (manifold.points[static_cast<std::size_t>(i)].feature ==
          manifold.points[static_cast<std::size_t>(j)].feature)
        return false;
    }
  }
  return true;
}

bool is_valid(const Manifold& manifold) {
  if (manifold.count < 0 || manifold.count > k_max_manifold_points) return false;
  return manifold.count == 0 || (is_unit(manifold.normal) && has_features_of_its_own(manifold));
}

}  // namespace

WorldFault StateValidator::fault_of_bodies() const {
  for (std::uint32_t i = 0; i < world_.header.body_limit; ++i)
    if (validate(world_.bodies[i], *world_.assets) != Status::ok) return {"a body's record", i};
  return {};
}

WorldFault StateValidator::fault_of_contacts(std::span<const ContactRecord> records) const {
  for (std::uint32_t i = 0; i < records.size(); ++i) {
    const ContactRecord& record = records[i];
    if (record.body_a >= world_.header.body_limit || record.body_b >= world_.header.body_limit)
      return {"a contact of no body", i};
    if (validate(record, world_.bodies[record.body_a], world_.bodies[record.body_b],
                 *world_.assets) != Status::ok)
      return {"a contact's record", i};
    if (i > 0 && records[i - 1].key() >= record.key()) return {"the order of contacts", i};
  }
  return {};
}

WorldFault StateValidator::fault_of_joints() const {
  for (std::uint32_t i = 0; i < world_.header.joint_limit; ++i) {
    const JointRecord& joint = world_.joints[i];
    if (validate(joint) != Status::ok) return {"a joint's record", i};
    if (!joint.exists()) continue;
    if (joint.body_a >= world_.header.body_limit || joint.body_b >= world_.header.body_limit)
      return {"a joint of no body", i};
    if (validate(joint, world_.bodies[joint.body_a], world_.bodies[joint.body_b]) != Status::ok)
      return {"the fields of a joint", i};
    if (joint.is(JointKind::path) && curve_of(joint, world_.assets.get()) == nullptr)
      return {"the path of a joint", i};
  }
  return {};
}

WorldFault StateValidator::fault_of_terrain() const {
  for (std::uint32_t i = 0; i < world_.header.terrain_tile_count; ++i) {
    const TerrainTileRecord& tile = world_.tiles[i];
    if (tile.owner >= world_.header.body_limit || !world_.bodies[tile.owner].exists())
      return {"a tile of no body", i};
    const geometry::AssetGeometry* built = geometry_as_built(world_, tile.owner);
    if (built == nullptr || !is_valid_tile(*built, tile)) return {"a tile's record", i};
    if (world_.cache.asset(tile.owner) == built) return {"the asset of a changed terrain", i};
    if (i > 0 && world_.tiles[i - 1].key() >= tile.key()) return {"the order of tiles", i};
  }
  return {};
}

WorldFault StateValidator::fault_of_rules() const {
  const auto fault_of = [](auto rules) -> WorldFault {
    for (std::uint32_t i = 0; i < rules.size(); ++i) {
      if (validate(rules[i]) != Status::ok) return {"a rule's record", i};
      if (i > 0 && rules[i - 1].key() >= rules[i].key()) return {"the order of rules", i};
    }
    return {};
  };
  for (const PairRuleRecord& rule : pair_rules_of(world_, world_.header))
    if (rule.body_b >= world_.header.body_limit || !world_.bodies[rule.body_a].exists() ||
        !world_.bodies[rule.body_b].exists())
      return {"a rule of no body", rule.body_b};
  for (std::uint32_t i = 0; i < world_.header.vehicle_count; ++i) {
    const VehicleRecord& vehicle = world_.vehicles[i];
    if (validate(vehicle) != Status::ok || vehicle.chassis >= world_.header.body_limit ||
        !world_.bodies[vehicle.chassis].exists() ||
        (i > 0 && world_.vehicles[i - 1].chassis >= vehicle.chassis))
      return {"a vehicle's record", i};
  }
  if (const WorldFault fault = fault_of_terrain()) return fault;
  const WorldFault fault = fault_of(pair_rules_of(world_, world_.header));
  return fault ? fault : fault_of(surface_rules_of(world_, world_.header));
}

// Data derived from a body alone.
WorldFault StateValidator::fault_of_derived_bodies() const {
  std::uint32_t awake_count = 0, sleepers = 0;
  for (std::uint32_t i = 0; i < world_.header.body_limit; ++i) {
    const BodyRecord& body = world_.bodies[i];
    if (world_.awake.has(i) != (body.exists() && body.is_awake()))
      return {"the list of awake bodies", i};
    awake_count += world_.awake.has(i) ? 1U : 0U;
    if (world_.sleep_flags.has_changed(i) != body.has_changed_sleep())
      return {"the list of changed sleep", i};
    if (world_.cache.persist_bodies().has(i) != has_persist_events(body))
      return {"the list of bodies with persist events", i};
    if (world_.cache.hit_bodies().has(i) != has_hit_events(body))
      return {"the list of bodies with hit events", i};
    if (world_.broad_phase.has(i) != (body.exists() && is_enabled(body)))
      return {"the bodies of the broad phase", i};
    if (!body.exists()) continue;
    sleepers += body.is_asleep() ? 1U : 0U;
    const bool is_as_built = world_.cache.asset(i) == geometry_as_built(world_, i);
    const bool is_changed =
        std::ranges::find(world_.edited_bodies, i) != world_.edited_bodies.end();
    if (is_as_built == is_changed) return {"the asset of a body", i};
    if (world_.cache.rotation(i) != to_matrix(body.orientation))
      return {"the rotation of a body", i};
    if (is_enabled(body) && world_.broad_phase.bounds(i) != world_.bounds_of(i))
      return {"the bounds of a body", i};
    if (!is_near_recycling_pose(body, wide_range(body))) return {"the recycling pose of a body", i};
    if (world_.cache.recycling_rotations()[i] != to_matrix(body.recycling_orientation))
      return {"the rotation of a recycling pose", i};
    if (world_.cache.pose_delta(i) != pose_delta_of(body)) return {"the pose delta of a body", i};
  }
  if (awake_count != world_.awake.count()) return {"the number of awake bodies", awake_count};
  if (sleepers != world_.sleep_flags.asleep_count())
    return {"the number of sleeping bodies", sleepers};
  return {};
}

// Those contacts sleep of which no body is awake.
WorldFault StateValidator::fault_of_derived_contacts() const {
  const auto is_active = [&](const ContactRecord& record) {
    return world_.awake.has(record.body_a) || world_.awake.has(record.body_b);
  };
  if (!std::ranges::all_of(world_.contacts.active(), is_active))
    return {"an active contact of sleepers"};
  WorldFault fault;
  world_.contacts.sleeping().for_each(world_.header.body_limit, [&](const ContactRecord& record) {
    if (is_active(record)) fault = {"a sleeping contact of a body that is awake", record.body_a};
    const WorldFault own = fault_of_contacts({&record, 1});
    if (own) fault = own;
  });
  if (fault) return fault;
  if (world_.header.contact_count != world_.contacts.count()) return {"the number of contacts"};
  return {};
}

WorldFault StateValidator::fault_of_derived_joints() const {
  std::size_t links = 0, joined = 0;
  for (std::uint32_t i = 0; i < world_.header.joint_limit; ++i) {
    const JointRecord& joint = world_.joints[i];
    if (!joint.exists()) continue;
    const bool known = links < world_.joint_graph.links().size() &&
                       world_.joint_graph.links()[links].joint == i &&
                       world_.joint_graph.links()[links].body_a == joint.body_a &&
                       world_.joint_graph.links()[links].body_b == joint.body_b;
    if (!known) return {"the list of joints", i};
    ++links;
    if (joint.collides()) continue;
    ++joined;
    if (!world_.are_joined(joint.body_a, joint.body_b))
      return {"the pairs that joints keep apart", i};
  }
  if (links != world_.joint_graph.links().size()) return {"the number of joints"};
  if (joined != world_.joint_graph.exempt_pairs().size() ||
      !std::ranges::is_sorted(world_.joint_graph.exempt_pairs()))
    return {"the pairs that joints keep apart"};
  return {};
}

// Each change of a record was marked, so that hashing the changed records gives the hash of all.
WorldFault StateValidator::fault_of_hashes() {
  const auto sum_of = [&](auto store) {
    std::uint64_t sum = 0;
    for_each_record<decltype(store)>(world_, [&](std::uint32_t index, const auto& record) {
      sum += hash_record(record, hash_seed<decltype(store)>(index));
    });
    return sum;
  };
  WorldFault fault;
  world_.visit(BodyStore{}, [&](auto records) {
    if (world_.hashes.bodies.sum(records) != sum_of(BodyStore{})) fault = {"the hash of bodies"};
  });
  world_.visit(JointStore{}, [&](auto records) {
    if (world_.hashes.joints.sum(records) != sum_of(JointStore{})) fault = {"the hash of joints"};
  });
  return fault;
}

WorldFault StateValidator::fault_of_pairs() const {
  for (std::uint32_t i = 0; i < world_.pairs.size(); ++i) {
    const Pair& pair = world_.pairs[i];
    if (i > 0 && !(world_.pairs[i - 1] < pair)) return {"the order of pairs", i};
    if (!world_.awake.has(pair.a) && !world_.awake.has(pair.b)) return {"a pair of sleepers", i};
    if (!overlap(world_.broad_phase.bounds(pair.a), world_.broad_phase.bounds(pair.b)))
      return {"a pair that is apart", i};
  }
  return {};
}

WorldFault StateValidator::fault_of_manifolds() const {
  for (std::uint32_t i = 0; i < world_.found.manifold_ids.size(); ++i)
    if (!is_valid(world_.found.manifold_of(i))) return {"a manifold", i};
  return {};
}

WorldFault StateValidator::find_fault() {
  if (!WorldStores::fits(world_.header, world_.def) || !is_valid_gravity(world_.header.gravity))
    return {"the header"};
  for (const WorldFault& fault :
       {fault_of_bodies(), fault_of_contacts(world_.contacts.active()), fault_of_joints()})
    if (fault) return fault;
  for (std::uint32_t i = 0; i < world_.header.fluid_limit; ++i)
    if (validate(world_.fluids[i]) != Status::ok) return {"a fluid's record", i};
  if (const WorldFault fault = fault_of_rules()) return fault;
  for (const WorldFault& fault :
       {fault_of_derived_bodies(), fault_of_derived_contacts(), fault_of_derived_joints()})
    if (fault) return fault;
  if (!world_.broad_phase.is_valid()) return {"the broad phase"};
  return fault_of_hashes();
}

// Between the stages the derived data of bodies may wait to be brought up to date.
WorldFault StateValidator::find_fault_after(StepStage stage) {
  switch (stage) {
    case StepStage::find_pairs:
      return fault_of_pairs();
    case StepStage::collide:
      if (const WorldFault fault = fault_of_manifolds()) return fault;
      return fault_of_contacts(world_.found.records);
    case StepStage::prepare:
    case StepStage::solve:
      return {};
    case StepStage::store:
      if (const WorldFault fault = fault_of_joints()) return fault;
      return fault_of_contacts(world_.found.records);
    case StepStage::move:
    case StepStage::continuous:
      return fault_of_bodies();
    case StepStage::refresh:
      return fault_of_derived_bodies();
    case StepStage::events:
      return fault_of_contacts(world_.contacts.active());
    default:
      return find_fault();
  }
}

void StateValidator::check_after(StepStage stage) {
  const WorldFault fault = find_fault_after(stage);
  if (!fault) return;
  char text[160];
  (void)std::snprintf(text, sizeof text, "after %s: %s, %u", name_of(stage), fault.what,
                      static_cast<unsigned>(fault.index));
  check_failed(text, "World::set_validation", 2);
}

WorldFault World::find_fault() const {
  return StateValidator(*impl_).find_fault();
}

void World::set_validation(bool each_stage) {
  impl_->trace.validate(each_stage);
}

}  // namespace lockstone
