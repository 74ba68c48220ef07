// The hash of a state: one hash a record, seeded with its place, summed per store. A sum lets a
// record be exchanged without hashing the others again.

#include <array>
#include <bit>

#include <lockstone/hash.h>

#include "core/world/record_codec.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

// Canonical bytes are little-endian in field order, which on a little-endian machine is the memory.
template <class Record>
std::uint64_t hash_record(const Record& record, std::uint64_t seed) {
  if constexpr (std::endian::native == std::endian::little) {
    return hash64(std::as_bytes(std::span(&record, 1)), seed);
  } else {
    std::array<std::byte, sizeof(Record)> bytes{};
    ByteWriter writer(bytes);
    encode(record, writer);
    return hash64(bytes, seed);
  }
}

template <class Record>
std::uint64_t hash_store(std::span<const Record> records, std::uint64_t domain) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < records.size(); ++i) {
    sum += hash_record(records[i], (domain << 32) + i);
  }
  return sum;
}

}  // namespace

StateHash World::hash() const {
  const Impl& world = *impl_;
  StateHash hash;
  hash.header = hash_record(world.header, 0);
  hash.bodies =
      hash_store(std::span<const BodyRecord>(world.bodies.data(), world.header.body_limit), 1);
  hash.contacts = hash_store(world.contacts(), 2);
  std::array<std::byte, 24> parts{};
  ByteWriter writer(parts);
  writer.put(hash.header);
  writer.put(hash.bodies);
  writer.put(hash.contacts);
  hash.total = hash64(writer.written());
  return hash;
}

}  // namespace lockstone
