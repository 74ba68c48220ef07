// Tables of records that are sorted by key: the first `count` of a container.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>

#include <lockstone/assert.h>

namespace lockstone {

/// The record with the key; null where there is none.
template <class Record, class Key>
[[nodiscard]] const Record* find_by_key(std::span<const Record> records, const Key& key) {
  const auto at = std::ranges::lower_bound(records, key, {}, &Record::key);
  return at != records.end() && at->key() == key ? &*at : nullptr;
}

/// Writes `record` in the place of its key, which it may take from the records that follow. False,
/// and nothing is changed, where that is one more than the container has.
template <class Table, class Count, class Record>
[[nodiscard]] bool set_record(Table& table, Count& count, const Record& record) {
  LKS_ASSERT(count <= table.size());
  const auto end = table.begin() + count;
  const auto at = std::lower_bound(
      table.begin(), end, record,
      [](const Record& one, const Record& other) { return one.key() < other.key(); });
  if (at == end || at->key() != record.key()) {
    if (count == table.size()) return false;
    std::copy_backward(at, end, end + 1);
    ++count;
  }
  *at = record;
  return true;
}

/// Removes all records for which `is_removed`; the places that become free are zero.
template <class Table, class Count, class Predicate>
void remove_records(Table& table, Count& count, Predicate is_removed) {
  LKS_ASSERT(count <= table.size());
  const auto end = table.begin() + count;
  const auto kept = std::remove_if(table.begin(), end, is_removed);
  std::fill(kept, end, typename Table::value_type{});
  count = static_cast<Count>(kept - table.begin());
}

}  // namespace lockstone
