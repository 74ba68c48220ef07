// The hash of a state: one hash a record, seeded with its place, summed per store. A sum lets a
// record be exchanged without hashing the others again, and does not depend on their order.

#include <algorithm>
#include <array>

#include "core/world/state/stores.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// Each half of its own.
Hash128 operator+(const Hash128& a, const Hash128& b) {
  return {a.low + b.low, a.high + b.high};
}

template <class Store, class State>
Hash128 sum_of(const State& state) {
  Hash128 sum;
  for_each_record<Store>(state, [&](std::uint32_t index, const auto& record) {
    sum = sum + hash_record128(record, hash_seed<Store>(index));
  });
  return sum;
}

template <class Store>
std::uint64_t sum_of_hashes(const WorldData& world) {
  std::uint64_t sum = 0;
  for_each_record<Store>(world, [&](std::uint32_t index, const auto& record) {
    sum += hash_record(record, hash_seed<Store>(index));
  });
  return sum;
}

// Of the header; the end of it counts only where it is not zero.
template <class Hash>
auto hash_alone(const WorldHeader& header, Hash&& hash) {
  const bool has_end = header.terrain_tile_count != 0 || header.reserved != 0;
  return with_canonical_bytes(header, [&](auto bytes) {
    return has_end ? hash(bytes) : hash(bytes.template first<k_hashed_header_bytes>());
  });
}

// Tiles change seldom: their hash is kept.
std::uint64_t hash_of_tiles(WorldData& world) {
  if (!world.is_tile_hash_known) world.tile_hash = sum_of_hashes<TerrainTileStore>(world);
  world.is_tile_hash_known = true;
  return world.tile_hash;
}

// Fluids, rules, vehicles and tiles count with the header; where there are none, it is hashed
// alone.
std::uint64_t hash_of_header(WorldData& world) {
  const std::uint64_t own = hash_alone(world.header, [](auto bytes) { return hash64(bytes, 0); });
  return own + sum_of_hashes<FluidStore>(world) + sum_of_hashes<PairRuleStore>(world) +
         sum_of_hashes<SurfaceRuleStore>(world) + sum_of_hashes<VehicleStore>(world) +
         hash_of_tiles(world);
}

Hash128 hash128_of_header(const WorldData& world) {
  const Hash128 own = hash_alone(world.header, [](auto bytes) { return hash128(bytes, 0); });
  return own + sum_of<FluidStore>(world) + sum_of<PairRuleStore>(world) +
         sum_of<SurfaceRuleStore>(world) + sum_of<VehicleStore>(world) +
         sum_of<TerrainTileStore>(world);
}

template <class Store, class State>
std::size_t list_hashes(const State& state, std::span<std::uint64_t> out) {
  std::size_t count = 0;
  for_each_record<Store>(state, [&](std::uint32_t index, const auto& record) {
    if (count < out.size()) out[count] = hash_record(record, hash_seed<Store>(index));
    ++count;
  });
  return count;
}

}  // namespace

StateHash World::hash() const {
  Impl& world = *impl_;
  StateHash hash;
  hash.header = hash_of_header(world);
  world.visit(BodyStore{}, [&](auto bodies) { hash.bodies = world.hashes.bodies.sum(bodies); });
  hash.contacts = world.contacts.sleeping().hash() + hash_contacts(world.contacts.active());
  world.visit(JointStore{}, [&](auto joints) { hash.joints = world.hashes.joints.sum(joints); });
  hash.hashed = 1 + world.hashes.bodies.hashed() +
                static_cast<std::uint32_t>(world.contacts.active().size()) +
                world.hashes.joints.hashed();
  std::array<std::byte, 32> parts{};
  ByteWriter writer(parts);
  writer.put(hash.header);
  writer.put(hash.bodies);
  writer.put(hash.contacts);
  writer.put(hash.joints);
  hash.total = hash64(writer.written());
  return hash;
}

StateHash128 World::hash128() const {
  StateHash128 hash;
  hash.header = hash128_of_header(*impl_);
  hash.bodies = sum_of<BodyStore>(*impl_);
  hash.contacts = sum_of<ContactStore>(*impl_);
  hash.joints = sum_of<JointStore>(*impl_);
  std::array<std::byte, 64> parts{};
  ByteWriter writer(parts);
  for (const Hash128& part : {hash.header, hash.bodies, hash.contacts, hash.joints}) {
    writer.put(part.low);
    writer.put(part.high);
  }
  hash.total = lockstone::hash128(writer.written());
  return hash;
}

std::size_t World::record_hashes(StateStore store, std::span<std::uint64_t> out) const {
  switch (store) {
    case StateStore::bodies:
      return list_hashes<BodyStore>(*impl_, out);
    case StateStore::contacts:
      return list_hashes<ContactStore>(*impl_, out);
    default:
      return list_hashes<JointStore>(*impl_, out);
  }
}

}  // namespace lockstone
