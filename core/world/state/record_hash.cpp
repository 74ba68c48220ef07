// Hashes of bodies and contacts, of which a tick changes thousands, with XXH3 inlined for their
// sizes.

#include "core/world/state/record_hash.h"

#include "core/base/inline_hash.h"

namespace lockstone {
namespace {

template <class Record>
[[nodiscard]] std::uint64_t hash_inlined(const Record& record, std::uint64_t seed) {
  return with_canonical_bytes(record, [&](auto bytes) {
    return hash_in_parts(bytes, seed, [](auto part, std::uint64_t its_seed) {
      return hash64_inline(part, its_seed);
    });
  });
}

}  // namespace

template <>
std::uint64_t hash_record(const BodyRecord& record, std::uint64_t seed) {
  return hash_inlined(record, seed);
}
template <>
std::uint64_t hash_record(const ContactRecord& record, std::uint64_t seed) {
  return hash_inlined(record, seed);
}

std::uint64_t hash_contacts(std::span<const ContactRecord> records) {
  std::uint64_t sum = 0;
  for (const ContactRecord& record : records)
    sum += hash_contact(record);
  return sum;
}

}  // namespace lockstone
