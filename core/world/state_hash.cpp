// The hash of a state: one hash a record, seeded with its place, summed per store. A sum lets a
// record be exchanged without hashing the others again.

#include <array>

#include "core/world/record_hash.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

std::uint64_t hash_contacts(std::span<const ContactRecord> contacts) {
  std::uint64_t sum = 0;
  for (std::size_t i = 0; i < contacts.size(); ++i)
    sum += hash_record(contacts[i], (k_contact_domain << 32) + i);
  return sum;
}

}  // namespace

StateHash World::hash() const {
  Impl& world = *impl_;
  StateHash hash;
  hash.header = hash_record(world.header, 0);
  hash.bodies = world.body_hashes.sum(std::span(world.bodies).first(world.header.body_limit));
  hash.contacts = hash_contacts(world.contacts());
  std::array<std::byte, 24> parts{};
  ByteWriter writer(parts);
  writer.put(hash.header);
  writer.put(hash.bodies);
  writer.put(hash.contacts);
  hash.total = hash64(writer.written());
  return hash;
}

}  // namespace lockstone
