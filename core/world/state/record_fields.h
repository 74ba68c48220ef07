// Fields of records by name: the first that differs, and bits of one.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <lockstone/decimal.h>
#include <lockstone/simulation.h>

#include "core/dynamics/state/fields.h"

namespace lockstone {

struct FieldText {
  std::string name;
  std::string value;
};

/// Notes the fields of a record: "0x0003a2f1", or "0x3a1cac08 (0.227 m/s)" of a quantity.
class FieldLister {
 public:
  template <class Integer>
  void operator()(const char* name, const char* suffix, Integer& integer) {
    fields.push_back({std::string(name) + suffix, hexadecimal(integer)});
  }
  template <class Integer>
  void operator()(const char* name, const char* suffix, Integer& integer,
                  const FieldFormat& format) {
    std::string value = hexadecimal(integer) + " (" + format_decimal(integer, format.frac_bits);
    if (!format.unit.empty()) value.append(1, ' ').append(format.unit);
    fields.push_back({std::string(name) + suffix, value + ')'});
  }

  std::vector<FieldText> fields;
};

template <class Record>
[[nodiscard]] std::vector<FieldText> fields_of(Record record) {
  FieldLister lister;
  visit_fields(record, lister);
  return lister.fields;
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
