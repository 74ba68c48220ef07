// Fields of records by name: the first that differs, and bits of one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <lockstone/simulation.h>

#include "core/dynamics/fields.h"

namespace lockstone {

struct FieldText {
  std::string name;
  std::string value;
};

template <class Record>
[[nodiscard]] std::vector<FieldText> fields_of(Record record) {
  std::vector<FieldText> fields;
  visit_fields(record, [&](const char* name, const char* suffix, auto& integer) {
    fields.push_back({std::string(name) + suffix, hexadecimal(integer)});
  });
  return fields;
}

template <class Record>
[[nodiscard]] StateDifference compare(const char* store, std::uint64_t object, const Record& here,
                                      const Record& there) {
  const std::vector<FieldText> a = fields_of(here), b = fields_of(there);
  for (std::size_t i = 0; i < a.size(); ++i) {
    if (a[i].value == b[i].value) continue;
    return {true, store, object, "", a[i].name, a[i].value, b[i].value};
  }
  return {};
}

/// False, and nothing happens, when the record has no such field or the field no such bit.
template <class Record>
bool flip_in(Record& record, std::string_view field, unsigned bit) {
  bool found = false;
  visit_fields(record, [&](std::string_view name, std::string_view suffix, auto& integer) {
    using Integer = std::remove_reference_t<decltype(integer)>;
    using Bits = std::make_unsigned_t<Integer>;
    const bool wanted = field.size() == name.size() + suffix.size() && field.starts_with(name) &&
                        field.ends_with(suffix);
    if (!wanted || found || bit >= 8 * sizeof(Integer)) return;
    integer = static_cast<Integer>(static_cast<Bits>(integer) ^ static_cast<Bits>(Bits{1} << bit));
    found = true;
  });
  return found;
}

}  // namespace lockstone
