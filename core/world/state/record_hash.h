// The hash of one record of the state.
#pragma once

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <span>

#include <lockstone/hash.h>

#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/contact_record.h"
#include "core/world/state/record_codec.h"

namespace lockstone {

/// Upper halves of seeds, so that equal records of two stores differ. The lower half is 0, or the
/// record's place where the record does not hold it.
inline constexpr std::uint64_t k_body_domain = 1;
inline constexpr std::uint64_t k_contact_domain = 2;
inline constexpr std::uint64_t k_joint_domain = 3;
inline constexpr std::uint64_t k_fluid_domain = 4;
inline constexpr std::uint64_t k_pair_rule_domain = 5;
inline constexpr std::uint64_t k_surface_rule_domain = 6;
inline constexpr std::uint64_t k_vehicle_domain = 7;
inline constexpr std::uint64_t k_terrain_tile_domain = 8;

/// Calls `hash(bytes)` with the canonical bytes: little-endian in field order, which on a
/// little-endian machine is the memory.
template <class Record, class Hash>
[[nodiscard]] auto with_canonical_bytes(const Record& record, Hash&& hash) {
  if constexpr (std::endian::native == std::endian::little) {
    return hash(std::as_bytes(std::span<const Record, 1>(&record, 1)));
  } else {
    std::array<std::byte, sizeof(Record)> bytes{};
    ByteWriter writer(bytes);
    encode(record, writer);
    return hash(std::span<const std::byte, sizeof(Record)>(bytes));
  }
}

/// Beyond this XXH3 derives a secret from each seed: parts of known lengths take less time.
inline constexpr std::size_t k_long_record_bytes = 240;
inline constexpr std::size_t k_hashed_part_bytes = 128;

/// `hash(bytes, seed)`; of a long record part by part, each seeded with the hash of those before.
template <std::size_t Size, class Hash>
[[nodiscard]] std::uint64_t hash_in_parts(std::span<const std::byte, Size> bytes,
                                          std::uint64_t seed, Hash&& hash) {
  if constexpr (Size <= k_long_record_bytes) {
    return hash(bytes, seed);
  } else {
    return hash_in_parts(bytes.template subspan<k_hashed_part_bytes>(),
                         hash(bytes.template first<k_hashed_part_bytes>(), seed), hash);
  }
}

/// XXH3 of the canonical bytes, in parts if there are many.
template <class Record>
[[nodiscard]] std::uint64_t hash_record(const Record& record, std::uint64_t seed) {
  return with_canonical_bytes(record,
                              [&](auto bytes) { return hash_in_parts(bytes, seed, hash64); });
}

/// The same, compiled for the records of which there are thousands.
template <>
[[nodiscard]] std::uint64_t hash_record(const BodyRecord& record, std::uint64_t seed);
template <>
[[nodiscard]] std::uint64_t hash_record(const ContactRecord& record, std::uint64_t seed);

/// XXH3 of all canonical bytes at once.
template <class Record>
[[nodiscard]] Hash128 hash_record128(const Record& record, std::uint64_t seed) {
  return with_canonical_bytes(record, [&](auto bytes) { return hash128(bytes, seed); });
}

/// Of a contact: its key is in the record, and no two have the same.
[[nodiscard]] inline std::uint64_t hash_contact(const ContactRecord& record) {
  return hash_record(record, k_contact_domain << 32);
}
/// The sum over them.
[[nodiscard]] std::uint64_t hash_contacts(std::span<const ContactRecord> records);

}  // namespace lockstone
