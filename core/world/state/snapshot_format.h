// Canonical snapshots as read: a view that decodes one record at a time.
#pragma once

#include <cstdint>

#include <lockstone/bytes.h>
#include <lockstone/status.h>
#include <lockstone/world.h>

#include "core/world/state/stores.h"

namespace lockstone {

inline constexpr std::uint32_t k_snapshot_magic = 0x57534b4c;  // "LKSW"
inline constexpr std::uint16_t k_snapshot_version = 4;
inline constexpr std::size_t k_snapshot_front_bytes = 4 + 2 + 2 + 8;
inline constexpr std::size_t k_snapshot_frame_bytes = k_snapshot_front_bytes + 8;

class SnapshotView {
 public:
  /// Checks frame, sizes and checksum, and that the snapshot belongs to `def` and `assets`, which
  /// must outlive the view.
  static Result<SnapshotView> open(ByteView bytes, const WorldDef& def, const AssetSet& assets);

  /// Checks every record: a state that passes can be simulated.
  [[nodiscard]] Status check() const;

  template <class Store>
  [[nodiscard]] typename Store::Record record(std::uint32_t index) const {
    return records_.decoded<Store>(index);
  }
  [[nodiscard]] BodyRecord body(std::uint32_t index) const { return record<BodyStore>(index); }
  [[nodiscard]] ContactRecord contact(std::uint32_t index) const {
    return record<ContactStore>(index);
  }
  [[nodiscard]] JointRecord joint(std::uint32_t index) const { return record<JointStore>(index); }

  WorldHeader header;

 private:
  // One for each store.
  [[nodiscard]] Status check(BodyStore) const;
  [[nodiscard]] Status check(ContactStore) const;
  [[nodiscard]] Status check(JointStore) const;
  [[nodiscard]] Status check(FluidStore) const;
  [[nodiscard]] Status check(PairRuleStore) const;
  [[nodiscard]] Status check(SurfaceRuleStore) const;
  [[nodiscard]] Status check(VehicleStore) const;
  [[nodiscard]] Status check(TerrainTileStore) const;

  const AssetSet* assets_ = nullptr;
  StoredRecords<WorldStores> records_;
};

}  // namespace lockstone
