// The hash of a state: one hash a record, seeded with its place, summed per store. A sum lets a
// record be exchanged without hashing the others again, and does not depend on their order.

#include <array>

#include "core/world/record_hash.h"
#include "core/world/world_impl.h"

namespace lockstone {
StateHash World::hash() const {
  Impl& world = *impl_;
  StateHash hash;
  hash.header = hash_record(world.header, 0);
  hash.bodies = world.body_hashes.sum(std::span(world.bodies).first(world.header.body_limit));
  hash.contacts = world.frozen.hash();
  for (const ContactRecord& contact : world.contacts())
    hash.contacts += hash_contact(contact);
  hash.joints = world.joint_hashes.sum(std::span(world.joints).first(world.header.joint_limit));
  hash.hashed =
      1 + world.body_hashes.hashed() + world.active_contacts + world.joint_hashes.hashed();
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
