// Where two states first differ, down to the field.

#include <algorithm>
#include <string>

#include "core/world/record_fields.h"
#include "core/world/snapshot_format.h"

namespace lockstone {
namespace {

StateDifference unreadable(const char* side, Status status) {
  return {true, "snapshot", 0, side, "bytes", std::string(to_string(status)), ""};
}

template <class Store>
std::string name_of(const typename Store::Record& record) {
  if constexpr (!Store::k_has_key) return {};
  if constexpr (Store::k_has_key) {
    return std::to_string(record.body_a).append("-").append(std::to_string(record.body_b));
  }
}

// Of the records that both have.
template <class Store>
StateDifference compare_store(const SnapshotView& here, const SnapshotView& there) {
  const std::uint32_t both = std::min(here.header.*Store::k_count, there.header.*Store::k_count);
  for (std::uint32_t i = 0; i < both; ++i) {
    const auto a = here.record<Store>(i), b = there.record<Store>(i);
    if (a == b) continue;
    StateDifference found = compare(Store::k_name, i, a, b);
    found.name = name_of<Store>(a);
    return found;
  }
  return {};
}

// Without the counts: they differ because records do.
StateDifference compare_headers(const WorldHeader& here, WorldHeader there) {
  WorldStores::for_each([&](auto store) {
    constexpr auto count = decltype(store)::k_count;
    there.*count = here.*count;
  });
  return compare("world", 0, here, there);
}

StateDifference compare_states(const SnapshotView& here, const SnapshotView& there) {
  StateDifference found = compare_headers(here.header, there.header);
  WorldStores::for_each([&](auto store) {
    if (!found.differs) found = compare_store<decltype(store)>(here, there);
  });
  return found.differs ? found : compare("world", 0, here.header, there.header);
}

// Of bytes whose counts belie their size: what the header says.
StateDifference compare_headers(ByteView here, ByteView there) {
  const auto header_of = [](ByteView bytes) {
    ByteReader reader(bytes);
    (void)reader.get_bytes(k_snapshot_front_bytes);
    return decode<WorldHeader>(reader);
  };
  return compare("world", 0, header_of(here), header_of(there));
}

}  // namespace

StateDifference World::describe_difference(ByteView here, ByteView there) const {
  const Result<SnapshotView> a = SnapshotView::open(here, impl_->def, *impl_->assets);
  const Result<SnapshotView> b = SnapshotView::open(there, impl_->def, *impl_->assets);
  if (a.ok() && b.ok()) return compare_states(a.value(), b.value());
  const StateDifference found = compare_headers(here, there);
  if (found.differs) return found;
  return a.ok() ? unreadable("there", b.status()) : unreadable("here", a.status());
}

}  // namespace lockstone
