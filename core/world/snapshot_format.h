// Canonical snapshots as read: a view that decodes one record at a time.
#pragma once

#include <cstdint>

#include <lockstone/bytes.h>
#include <lockstone/status.h>

#include "core/world/world_impl.h"

namespace lockstone {

inline constexpr std::uint32_t k_snapshot_magic = 0x57534b4c;  // "LKSW"
inline constexpr std::uint16_t k_snapshot_version = 2;
inline constexpr std::size_t k_snapshot_frame_bytes = 4 + 2 + 2 + 8 + 8;

class SnapshotView {
 public:
  /// Checks frame, sizes and checksum, and that the snapshot belongs to `def` and `assets`, which
  /// must outlive the view.
  static Result<SnapshotView> open(ByteView bytes, const WorldDef& def, const AssetSet& assets);

  /// Checks every record: what passes can be simulated.
  [[nodiscard]] Status check() const;

  [[nodiscard]] BodyRecord body(std::uint32_t index) const;
  [[nodiscard]] ContactRecord contact(std::uint32_t index) const;
  [[nodiscard]] JointRecord joint(std::uint32_t index) const;

  WorldHeader header;

 private:
  [[nodiscard]] Status check_contacts() const;
  [[nodiscard]] Status check_joints() const;

  const AssetSet* assets_ = nullptr;
  ByteView bodies_;
  ByteView contacts_;
  ByteView joints_;
};

}  // namespace lockstone
