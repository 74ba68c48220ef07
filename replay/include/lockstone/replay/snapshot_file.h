// A canonical snapshot as a file of its own: compressed, checksummed, of bounded size.
#pragma once

#include <cstddef>
#include <vector>

#include <lockstone/bytes.h>
#include <lockstone/status.h>

namespace lockstone::replay {

/// The file's bytes (docs/reference/replay-format.md, "Snapshot files"); compressed where this
/// build can and it helps. `canonical` has at most k_max_keyframe_bytes.
[[nodiscard]] std::vector<std::byte> pack_snapshot(ByteView canonical);

/// The canonical snapshot in a file. The bytes may come from anywhere: nothing is allocated before
/// lengths and checksum were looked at, and never more than k_max_keyframe_bytes. truncated,
/// malformed, checksum_mismatch, or unsupported_version: a newer file, or compressed and this build
/// cannot.
[[nodiscard]] Result<std::vector<std::byte>> unpack_snapshot(ByteView file);

}  // namespace lockstone::replay
