// Records to little-endian bytes and back, by their field lists.
#pragma once

#include <type_traits>

#include <lockstone/bytes.h>

#include "core/dynamics/state/fields.h"

namespace lockstone {

template <class Record>
void encode(const Record& record, ByteWriter& writer) {
  Record copy = record;  // visiting takes a mutable record
  visit_fields(copy, [&](const char*, const char*, auto& integer) { writer.put(integer); });
}

template <class Record>
[[nodiscard]] Record decode(ByteReader& reader) {
  Record record;
  visit_fields(record, [&](const char*, const char*, auto& integer) {
    integer = reader.get<std::remove_reference_t<decltype(integer)>>();
  });
  return record;
}

}  // namespace lockstone
