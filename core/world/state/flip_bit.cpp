// A fault on purpose.

#include "core/world/state/record_fields.h"
#include "core/world/state/stores.h"
#include "core/world/world_impl.h"

namespace lockstone {

namespace {

bool flip_in_contact(WorldData& world, std::uint64_t object, std::string_view field, unsigned bit) {
  const ContactRecord* wanted = nullptr;
  for_each_record<ContactStore>(world, [&](std::uint32_t index, const ContactRecord& record) {
    if (index == object) wanted = &record;
  });
  if (wanted == nullptr) return false;
  bool found = false;
  world.contacts.change(*wanted,
                        [&](ContactRecord& record) { found = flip_in(record, field, bit); });
  return found;
}

bool flip_in_header(WorldData& world, std::string_view field, unsigned bit) {
  world.hashes.bodies.clear();  // there may be fewer records than before
  world.hashes.joints.clear();
  world.is_tile_hash_known = false;
  return flip_in(world.header, field, bit);
}

}  // namespace

bool World::flip_bit(std::string_view store, std::uint64_t object, std::string_view field,
                     unsigned bit) {
  Impl& world = *impl_;
  world.is_derived_stale = true;
  const auto index = static_cast<std::uint32_t>(object);
  if (store == "world") return object == 0 && flip_in_header(world, field, bit);
  if (store == ContactStore::k_name) return flip_in_contact(world, object, field, bit);
  if (store == BodyStore::k_name && object < world.header.body_limit) {
    world.hashes.bodies.mark(index);
    return flip_in(world.bodies[index], field, bit);
  }
  if (store == JointStore::k_name && object < world.header.joint_limit) {
    world.hashes.joints.mark(index);
    return flip_in(world.joints[index], field, bit);
  }
  if (store == FluidStore::k_name && object < world.header.fluid_limit)
    return flip_in(world.fluids[index], field, bit);
  if (store == PairRuleStore::k_name && object < world.header.pair_rule_count)
    return flip_in(world.pair_rules[index], field, bit);
  if (store == SurfaceRuleStore::k_name && object < world.header.surface_rule_count)
    return flip_in(world.surface_rules[index], field, bit);
  if (store == VehicleStore::k_name && object < world.header.vehicle_count)
    return flip_in(world.vehicles[index], field, bit);
  if (store == TerrainTileStore::k_name && object < world.header.terrain_tile_count) {
    world.is_tile_hash_known = false;
    return flip_in(world.tiles[index], field, bit);
  }
  return false;
}

}  // namespace lockstone
