// Where two states first differ, down to the field.

#include <algorithm>
#include <string>

#include "core/world/state/record_fields.h"
#include "core/world/state/snapshot_format.h"
#include "core/world/world_impl.h"

namespace lockstone {
namespace {

StateDifference unreadable(const char* side, Status status) {
  return {true, "snapshot", 0, side, "bytes", std::string(to_string(status)), ""};
}

// Names the objects that differ, by the bodies of two snapshots.
class Namer {
 public:
  Namer(const BodyNames& names, const SnapshotView& here, const SnapshotView& there)
      : names_(names), here_(here), there_(there) {}

  [[nodiscard]] std::string name_of(BodyStore, std::uint32_t index, const BodyRecord&) const {
    return std::string(of_body(index));
  }
  [[nodiscard]] std::string name_of(ContactStore, std::uint32_t, const ContactRecord& c) const {
    return end(c.body_a) + '-' + end(c.body_b);
  }
  [[nodiscard]] std::string name_of(JointStore, std::uint32_t, const JointRecord& joint) const {
    return joint.exists() ? end(joint.body_a) + '-' + end(joint.body_b) : std::string();
  }

  [[nodiscard]] std::string name_of(FluidStore, std::uint32_t, const FluidRecord&) const {
    return {};
  }
  [[nodiscard]] std::string name_of(PairRuleStore, std::uint32_t, const PairRuleRecord& r) const {
    return end(r.body_a) + '-' + end(r.body_b);
  }
  [[nodiscard]] std::string name_of(VehicleStore, std::uint32_t, const VehicleRecord& v) const {
    return end(v.chassis);
  }
  [[nodiscard]] std::string name_of(TerrainTileStore, std::uint32_t,
                                    const TerrainTileRecord& tile) const {
    const auto at = [](std::int32_t of_tile) {
      return std::to_string(of_tile * geometry::HeightTile::k_side);
    };
    if (tile.row == geometry::k_group_row)
      return end(tile.owner) + ", groups from " +
             std::to_string(tile.column * geometry::HeightTile::k_samples);
    return end(tile.owner) + ", samples from " + at(tile.column) + ", " + at(tile.row);
  }
  [[nodiscard]] std::string name_of(SurfaceRuleStore, std::uint32_t,
                                    const SurfaceRuleRecord& r) const {
    return std::to_string(r.tag_a) + '-' + std::to_string(r.tag_b);
  }

 private:
  // "17 crate", or "17" of a body without a name.
  [[nodiscard]] std::string end(std::uint32_t index) const {
    const std::string_view name = of_body(index);
    std::string text = std::to_string(index);
    return name.empty() ? text : text.append(1, ' ').append(name);
  }

  [[nodiscard]] std::string_view of_body(std::uint32_t index) const {
    for (const SnapshotView* side : {&here_, &there_}) {
      if (index >= side->header.body_limit) continue;
      const std::string_view name = names_.of({index, side->body(index).generation});
      if (!name.empty()) return name;
    }
    return {};
  }

  const BodyNames& names_;
  const SnapshotView &here_, &there_;
};

// Of the records that both have.
template <class Store>
StateDifference compare_store(const SnapshotView& here, const SnapshotView& there,
                              const Namer& namer) {
  const std::uint32_t both = std::min(here.header.*Store::k_count, there.header.*Store::k_count);
  for (std::uint32_t i = 0; i < both; ++i) {
    const auto a = here.record<Store>(i), b = there.record<Store>(i);
    if (a == b) continue;
    StateDifference found = compare(Store::k_name, i, a, b);
    found.name = namer.name_of(Store{}, i, a);
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

StateDifference compare_states(const SnapshotView& here, const SnapshotView& there,
                               const BodyNames& names) {
  const Namer namer(names, here, there);
  StateDifference found = compare_headers(here.header, there.header);
  WorldStores::for_each([&](auto store) {
    if (!found.differs) found = compare_store<decltype(store)>(here, there, namer);
  });
  return found.differs ? found : compare("world", 0, here.header, there.header);
}

// Compares the headers alone, of bytes whose size does not fit their counts.
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
  if (a.ok() && b.ok()) return compare_states(a.value(), b.value(), impl_->names);
  const StateDifference found = compare_headers(here, there);
  if (found.differs) return found;
  return a.ok() ? unreadable("there", b.status()) : unreadable("here", a.status());
}

}  // namespace lockstone
