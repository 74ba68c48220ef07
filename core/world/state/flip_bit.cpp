// A fault on purpose.

#include "core/world/state/record_fields.h"
#include "core/world/state/stores.h"
#include "core/world/world_impl.h"

namespace lockstone {

bool World::Impl::flip_in_contact(std::uint64_t object, std::string_view field, unsigned bit) {
  const ContactRecord* wanted = nullptr;
  for_each_record<ContactStore>(*this, [&](std::uint32_t index, const ContactRecord& record) {
    if (index == object) wanted = &record;
  });
  if (wanted == nullptr) return false;
  bool found = false;
  const auto flip = [&](ContactRecord& record) { found = flip_in(record, field, bit); };
  const std::span<const ContactRecord> active = contacts();
  const bool is_active = !active.empty() && wanted >= &active.front() && wanted <= &active.back();
  if (is_active) {
    flip(contact_store[index_of(*wanted)]);
  } else {
    frozen.change(*wanted, flip);
  }
  return found;
}

bool World::Impl::flip_in_header(std::string_view field, unsigned bit) {
  body_hashes.clear();  // there may be fewer records than before
  joint_hashes.clear();
  return flip_in(header, field, bit);
}

bool World::flip_bit(std::string_view store, std::uint64_t object, std::string_view field,
                     unsigned bit) {
  Impl& world = *impl_;
  world.is_derived_stale = true;
  const auto index = static_cast<std::uint32_t>(object);
  if (store == "world") return object == 0 && world.flip_in_header(field, bit);
  if (store == ContactStore::k_name) return world.flip_in_contact(object, field, bit);
  if (store == BodyStore::k_name && object < world.header.body_limit) {
    world.body_hashes.mark(index);
    return flip_in(world.bodies[index], field, bit);
  }
  if (store == JointStore::k_name && object < world.header.joint_limit) {
    world.joint_hashes.mark(index);
    return flip_in(world.joints[index], field, bit);
  }
  return false;
}

}  // namespace lockstone
