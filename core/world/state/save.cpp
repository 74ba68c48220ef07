// Saving. The native snapshot is a copy of the used parts of the stores. The canonical one is:
//   u32 magic "LKSW" · u16 version · u16 reserved · u64 config hash
//   header record · body records · contact records · joint records · fluid records ·
//   pair rule records · surface rule records · vehicle records · terrain tile records · u64 XXH3 of
//   all before
// all little-endian, each record its fields in the order of its list.

#include <lockstone/hash.h>

#include "core/world/state/delta.h"
#include "core/world/state/snapshot_format.h"
#include "core/world/state/stores.h"
#include "core/world/world_impl.h"

namespace lockstone {

namespace {

std::size_t save_canonical(const WorldData& world, std::span<std::byte> out) {
  ByteWriter writer(out);
  writer.put(k_snapshot_magic);
  writer.put(k_snapshot_version);
  writer.put<std::uint16_t>(0);
  writer.put(config_hash(world.def, world.assets->hash()));
  write_canonical<WorldStores>(world, writer);
  if (!writer.ok()) return 0;
  writer.put(hash64(writer.written()));
  return writer.ok() ? writer.size() : 0;
}

}  // namespace

std::size_t World::snapshot_bytes_max(SnapshotKind kind) const {
  const std::size_t frame = kind == SnapshotKind::native ? 0 : k_snapshot_frame_bytes;
  return frame + sizeof(WorldHeader) + WorldStores::record_bytes_max(impl_->def);
}

std::size_t World::save(SnapshotKind kind, std::span<std::byte> out) const {
  return kind == SnapshotKind::native ? write_native<WorldStores>(*impl_, out)
                                      : save_canonical(*impl_, out);
}

std::size_t World::delta_bytes_max() const {
  return snapshot_bytes_max(SnapshotKind::native) + delta_overhead<WorldStores>(impl_->def);
}

std::size_t World::save_delta(ByteView base, std::span<std::byte> out) const {
  return write_delta<WorldStores>(*impl_, base, out);
}

}  // namespace lockstone
