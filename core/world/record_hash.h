// The hash of one record of the state.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <span>

#include <lockstone/hash.h>

#include "core/dynamics/contact_record.h"
#include "core/world/record_codec.h"

namespace lockstone {

/// Upper halves of seeds, so that equal records of two stores differ. The lower half is 0, or the
/// record's place where the record does not hold it.
inline constexpr std::uint64_t k_body_domain = 1;
inline constexpr std::uint64_t k_contact_domain = 2;
inline constexpr std::uint64_t k_joint_domain = 3;

/// Calls `hash(bytes)` with the canonical bytes: little-endian in field order, which on a
/// little-endian machine is the memory.
template <class Record, class Hash>
[[nodiscard]] auto with_canonical_bytes(const Record& record, Hash&& hash) {
  if constexpr (std::endian::native == std::endian::little) {
    return hash(std::as_bytes(std::span(&record, 1)));
  } else {
    std::array<std::byte, sizeof(Record)> bytes{};
    ByteWriter writer(bytes);
    encode(record, writer);
    return hash(std::span<const std::byte>(bytes));
  }
}

/// XXH3 of the canonical bytes.
template <class Record>
[[nodiscard]] std::uint64_t hash_record(const Record& record, std::uint64_t seed) {
  return with_canonical_bytes(
      record, [&](std::span<const std::byte> bytes) { return hash64(bytes, seed); });
}
template <class Record>
[[nodiscard]] Hash128 hash_record128(const Record& record, std::uint64_t seed) {
  return with_canonical_bytes(
      record, [&](std::span<const std::byte> bytes) { return hash128(bytes, seed); });
}

/// Of a contact: its key is in the record, and no two have the same.
[[nodiscard]] inline std::uint64_t hash_contact(const ContactRecord& record) {
  return hash_record(record, k_contact_domain << 32);
}

}  // namespace lockstone
