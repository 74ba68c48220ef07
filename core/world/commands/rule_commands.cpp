// The commands that set rules about pairs.

#include <span>
#include <utility>

#include "core/dynamics/state/one_way_bits.h"
#include "core/geometry/convex/shape_properties.h"
#include "core/world/commands/command_checks.h"
#include "core/world/commands/command_executor.h"
#include "core/world/commands/rule_changes.h"
#include "core/world/data/sorted_table.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// The rule of a key, or none. Returns whether there was room.
template <class Table, class Record>
bool set_or_remove(Table& table, std::uint8_t& count, const Record& record, bool exists) {
  if (exists) return set_record(table, count, record);
  remove_records(table, count, [&](const Record& old) { return old.key() == record.key(); });
  return true;
}

PairRuleRecord record_of(const SetPairRule& command) {
  PairRuleRecord record;
  const RuleKey key = rule_key(command.a.index, command.b.index);
  record.body_a = key.low;
  record.body_b = key.high;
  if (!command.rule.collides) record.flags |= k_pair_ignored;
  if (!command.rule.surface) return record;
  record.flags |= k_pair_has_surface;
  record.surface = *command.rule.surface;
  return record;
}

SurfaceRuleRecord record_of(const SetSurfaceRule& command) {
  SurfaceRuleRecord record;
  const RuleKey key = rule_key(command.tag_a, command.tag_b);
  record.tag_a = key.low;
  record.tag_b = key.high;
  if (!command.surface) return record;
  record.surface = *command.surface;
  return record;
}

bool is_surface_or_none(const std::optional<PairSurface>& surface) {
  return !surface || is_valid(*surface);
}

}  // namespace

bool is_valid(const PairSurface& surface) {
  Surface as_surface;
  as_surface.friction = surface.friction;
  as_surface.restitution = surface.restitution;
  as_surface.rolling_resistance = surface.rolling_resistance;
  return geometry::is_valid(as_surface);
}

bool has_room_for_rule(const WorldData& world, const RuleKey& bodies) {
  const auto rules = pair_rules_of(world, world.header);
  return rules.size() < k_max_pair_rules || find_rule(rules, bodies) != nullptr;
}

bool has_room_for_surface_rule(const WorldData& world, const RuleKey& tags) {
  const auto rules = surface_rules_of(world, world.header);
  return rules.size() < k_max_surface_rules || find_rule(rules, tags) != nullptr;
}

void forget_rules_of(WorldData& world, std::uint32_t body) {
  remove_records(world.pair_rules, world.header.pair_rule_count, [&](const PairRuleRecord& rule) {
    return rule.body_a == body || rule.body_b == body;
  });
}

void forget_vehicle_of(WorldData& world, std::uint32_t body) {
  remove_records(world.vehicles, world.header.vehicle_count,
                 [&](const VehicleRecord& vehicle) { return vehicle.chassis == body; });
}

const VehicleRecord* find_vehicle(const WorldData& world, std::uint32_t body) {
  const auto all = std::span(world.vehicles).first(world.header.vehicle_count);
  return find_by_key(all, body);
}

VehicleRecord* find_vehicle(WorldData& world, std::uint32_t body) {
  return const_cast<VehicleRecord*>(find_vehicle(std::as_const(world), body));
}

Status CommandExecutor::execute(const SetPairRule& command) {
  if (world_.find(command.a) == nullptr || world_.find(command.b) == nullptr)
    return Status::stale_handle;
  if (command.a == command.b || !is_surface_or_none(command.rule.surface))
    return Status::invalid_argument;
  if (!set_or_remove(world_.pair_rules, world_.header.pair_rule_count, record_of(command),
                     !command.rule.collides || command.rule.surface))
    return Status::capacity_exhausted;
  world_.waking.disturb(command.a.index);
  world_.waking.disturb(command.b.index);
  return Status::ok;
}

Status CommandExecutor::execute(const SetSurfaceRule& command) {
  if (!is_surface_or_none(command.surface)) return Status::invalid_argument;
  if (!set_or_remove(world_.surface_rules, world_.header.surface_rule_count, record_of(command),
                     command.surface.has_value()))
    return Status::capacity_exhausted;
  world_.waking.wake_all();
  return Status::ok;
}

Status CommandExecutor::execute(const SetOneWay& command) {
  BodyRecord* record = world_.edit(command.body);
  if (record == nullptr) return Status::stale_handle;
  if (record->is_dynamic() || !is_valid(command.one_way)) return Status::invalid_argument;
  world_.waking.disturb(command.body.index);
  record->union_c = one_way_bits(command.one_way);
  return Status::ok;
}

/// The way of the functions below into a world.
class WorldRules {
 public:
  static const WorldData& of(const World& world) { return *world.impl_; }
};

PairRule pair_rule_of(const World& world, BodyHandle a, BodyHandle b) {
  const WorldData& data = WorldRules::of(world);
  PairRule rule;
  if (data.find(a) == nullptr || data.find(b) == nullptr) return rule;
  const PairRuleRecord* record =
      find_rule(pair_rules_of(data, data.header), rule_key(a.index, b.index));
  if (record == nullptr) return rule;
  rule.collides = !record->is_ignored();
  if (record->has_surface()) rule.surface = record->surface;
  return rule;
}

std::optional<PairSurface> surface_rule_of(const World& world, std::uint32_t tag_a,
                                           std::uint32_t tag_b) {
  const WorldData& data = WorldRules::of(world);
  const SurfaceRuleRecord* record =
      find_rule(surface_rules_of(data, data.header), rule_key(tag_a, tag_b));
  if (record == nullptr) return {};
  return record->surface;
}

OneWay one_way_of(const World& world, BodyHandle body) {
  const BodyRecord* record = WorldRules::of(world).find(body);
  LKS_ASSERT(record != nullptr);
  return record == nullptr ? OneWay{} : one_way_of(*record);
}

}  // namespace lockstone
