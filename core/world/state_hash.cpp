// The hash of a state: one hash a record, seeded with its place, summed per store. A sum lets a
// record be exchanged without hashing the others again.

#include <array>

#include "core/world/record_hash.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

template <class Record>
std::uint64_t hash_records(std::span<const Record> records, std::uint64_t domain) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < records.size(); ++i)
    sum += hash_record(records[i], (domain << 32) + i);
  return sum;
}

}  // namespace

StateHash World::hash() const {
  Impl& world = *impl_;
  StateHash hash;
  hash.header = hash_record(world.header, 0);
  hash.bodies = world.body_hashes.sum(std::span(world.bodies).first(world.header.body_limit));
  hash.contacts = hash_records(std::span<const ContactRecord>(world.contacts()), k_contact_domain);
  hash.joints = hash_records(
      std::span<const JointRecord>(world.joints).first(world.header.joint_limit), k_joint_domain);
  std::array<std::byte, 32> parts{};
  ByteWriter writer(parts);
  writer.put(hash.header);
  writer.put(hash.bodies);
  writer.put(hash.contacts);
  writer.put(hash.joints);
  hash.total = hash64(writer.written());
  return hash;
}

}  // namespace lockstone
