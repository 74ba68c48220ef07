// Assets of any kind from the bytes of a file or a peer.
#pragma once

#include <lockstone/asset.h>
#include <lockstone/bytes.h>
#include <lockstone/status.h>

namespace lockstone {

/// The hull, mesh, height field or compound that these canonical bytes came from, by the kind in
/// their head. The bytes may come from anywhere. Equal bytes give equal ids; a loaded asset has
/// exactly these canonical bytes.
///
/// `known` holds the hulls and meshes of compounds: not_found when it lacks one. Otherwise
/// truncated, unsupported_version, or malformed: not an asset's bytes, or not in canonical form.
///
/// A program that calls it links all four kinds; `T::from_bytes` links its own alone.
[[nodiscard]] Result<AssetPtr> load_asset(ByteView canonical, const AssetSet& known = {});

}  // namespace lockstone
