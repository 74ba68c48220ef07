#include "core/world/history/computed_bodies.h"

#include <algorithm>

namespace lockstone {
namespace {

bool has_triangles(const geometry::AssetGeometry* asset) {
  return asset != nullptr && asset->mesh_kernels() != nullptr;
}

}  // namespace

ComputedBodies::ComputedBodies(const WorldDef& def)
    : changes_(def.body_capacity), is_computed_(def.body_capacity), is_reached_(def.body_capacity) {
  left_out_.reserve(def.body_capacity);
  pairs_.reserve(def.pair_capacity);
}

void ComputedBodies::choose(WorldData& world, bool has_sleepers, const TickMemory& known) {
  changes_.find(world, known.before.open(world.def));
  const std::uint32_t awake = world.awake.count();
  most_ = awake - awake / 4;
  count_ = 0;
  all_ = changes_.concern_all() || changes_.bodies().size() > most_ || may_reach_all(world, known);
  if (all_) return;
  std::ranges::fill(is_reached_, std::uint8_t{0});
  std::ranges::fill(is_computed_, std::uint8_t{0});
  add_roots(world, known);
  if (has_sleepers && !known.had_sleepers) add_sweepers(world, known);
  add_groups(world, known);
}

// Thin bodies are held before one-sided faces, and look for them along their whole paths: faces
// that differ, or that move, concern all.
bool ComputedBodies::may_reach_all(WorldData& world, const TickMemory& known) const {
  const auto moves_triangles = [&](std::uint32_t body) {
    return has_triangles(world.cache.asset(body));
  };
  if (std::ranges::any_of(world.awake.list(), moves_triangles)) return true;
  const NativeState<WorldStores> before = known.before.open(world.def);
  const auto had_triangles = [&](std::uint32_t body) {
    if (body >= before.header.body_limit) return false;
    BodyRecord record;
    before.read<BodyStore>(body, record);
    return has_triangles(geometry::geometry_of(world.assets->find(record.shape().asset_id())));
  };
  return std::ranges::any_of(changes_.bodies(), [&](std::uint32_t body) {
    return has_triangles(geometry_as_built(world, body)) || had_triangles(body);
  });
}

void ComputedBodies::add_roots(const WorldData& world, const TickMemory& known) {
  for (const std::uint32_t body : changes_.ends())
    add_root(body, known);
  for (const std::uint32_t body : known.lookers)
    add_root(body, known);
  for (std::uint32_t i = 0; i < world.header.vehicle_count; ++i)
    add_root(world.vehicles[i].chassis, known);
  if (changes_.bodies().empty()) return;
  for (const std::uint32_t body : changes_.bodies()) {
    add_root(body, known);
    add_neighbours(world, body, known);
  }
  for (const Pair& pair : known.pairs) {
    if (!changes_.has(pair.a) && !changes_.has(pair.b)) continue;
    add_root(pair.a, known);
    add_root(pair.b, known);
  }
  for (const JointLink& link : world.joint_graph.links()) {
    if (!changes_.has(link.body_a) && !changes_.has(link.body_b)) continue;
    add_root(link.body_a, known);
    add_root(link.body_b, known);
  }
}

// Kinematic bodies look for sleepers along their paths, and did not where nothing slept.
void ComputedBodies::add_sweepers(WorldData& world, const TickMemory& known) {
  for (const std::uint32_t body : world.awake.list())
    if (!world.bodies[body].is_dynamic()) add_root(body, known);
}

// A body that does not move is a group by itself, and reaches no other.
void ComputedBodies::add_root(std::uint32_t body, const TickMemory& known) {
  is_reached_[body < known.groups.size() ? known.groups[body] : body] = 1;
}

// Sleeping bodies too: others may wake them in the tick.
void ComputedBodies::add_neighbours(const WorldData& world, std::uint32_t body,
                                    const TickMemory& known) {
  if (!world.broad_phase.has(body)) return;
  const Bounds here = world.broad_phase.bounds(body);
  world.broad_phase.traverse(
      k_every_category, [&](const Bounds& bounds) { return overlap(here, bounds); },
      [&](std::uint32_t other) { add_root(other, known); });
}

void ComputedBodies::add_groups(WorldData& world, const TickMemory& known) {
  for (const std::uint32_t body : changes_.bodies()) {
    is_computed_[body] = 1;
    ++count_;
  }
  for (std::uint32_t body = 0; body < world.header.body_limit; ++body) {
    const std::uint32_t group = body < known.groups.size() ? known.groups[body] : body;
    if (is_reached_[group] == 0 || is_computed_[body] != 0) continue;
    if (!links_others(world.bodies[body])) continue;
    is_computed_[body] = 1;
    ++count_;
  }
}

void ComputedBodies::leave_out_others(WorldData& world) {
  left_out_.clear();
  for (const std::uint32_t body : world.awake.list())
    if (!has(body)) left_out_.push_back(body);
  for (const std::uint32_t body : left_out_)
    world.awake.erase(body);
  world.contacts.keep_active(
      [&](const ContactRecord& record) { return has_any(record.body_a, record.body_b); });
  world.joint_graph.forget_awake_list();
}

void ComputedBodies::bring_back_others(WorldData& world) {
  for (const std::uint32_t body : left_out_)
    world.awake.insert(body);
  world.joint_graph.forget_awake_list();
}

std::span<const Pair> ComputedBodies::take_pairs(std::span<const Pair> all) {
  all_pairs_ = all;
  pairs_.clear();
  for (const Pair& pair : all)
    if (has_any(pair.a, pair.b)) pairs_.push_back(pair);
  return pairs_;
}

bool ComputedBodies::kept_to_themselves(const WorldData& world, const StateCopy& before,
                                        std::span<const Pair> looks) const {
  const NativeState<WorldStores> start = before.open(world.def);
  for (std::uint32_t i = 0; i < world.header.body_limit; ++i)
    if (!has(i) && !is_same<BodyStore>(world.bodies[i], start, i)) return false;
  JointRecord joint;
  for (std::uint32_t i = 0; i < world.header.joint_limit; ++i) {
    start.read<JointStore>(i, joint);
    const bool is_computed = joint.exists() && has_any(joint.body_a, joint.body_b);
    if (!is_computed && !is_same<JointStore>(world.joints[i], start, i)) return false;
  }
  return std::ranges::none_of(
      looks, [&](const Pair& look) { return !has(look.b) && links_others(world.bodies[look.b]); });
}

}  // namespace lockstone
