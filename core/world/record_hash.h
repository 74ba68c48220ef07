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

/// XXH3 of the canonical bytes: little-endian in field order, which on a little-endian machine is
/// the memory.
template <class Record>
[[nodiscard]] std::uint64_t hash_record(const Record& record, std::uint64_t seed) {
  if constexpr (std::endian::native == std::endian::little) {
    return hash64(std::as_bytes(std::span(&record, 1)), seed);
  } else {
    std::array<std::byte, sizeof(Record)> bytes{};
    ByteWriter writer(bytes);
    encode(record, writer);
    return hash64(bytes, seed);
  }
}

/// Of a contact: its key is in the record, and no two have the same.
[[nodiscard]] inline std::uint64_t hash_contact(const ContactRecord& record) {
  return hash_record(record, k_contact_domain << 32);
}

}  // namespace lockstone
