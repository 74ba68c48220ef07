// Checks of bytes from outside that are to be records of a state.
#pragma once

#include <lockstone/asset.h>
#include <lockstone/quat.h>
#include <lockstone/status.h>

#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/contact_record.h"
#include "core/dynamics/state/fluid_record.h"
#include "core/dynamics/state/joint_record.h"
#include "core/dynamics/state/rule_records.h"
#include "core/dynamics/state/terrain_record.h"
#include "core/dynamics/state/vehicle_record.h"

namespace lockstone {

/// ok, or the reason why a stored record is invalid. For bytes from outside.
[[nodiscard]] Status validate(const BodyRecord& record, const AssetSet& assets);
[[nodiscard]] Status validate(const JointRecord& record);
[[nodiscard]] Status validate(const FluidRecord& record);
[[nodiscard]] Status validate(const PairRuleRecord& record);
[[nodiscard]] Status validate(const SurfaceRuleRecord& record);
[[nodiscard]] Status validate(const VehicleRecord& record);
/// With the asset of its body.
[[nodiscard]] bool is_valid_tile(const geometry::AssetGeometry& terrain,
                                 const TerrainTileRecord& tile);

/// The same with the bodies, themselves valid, that a contact is between, or that a joint holds.
[[nodiscard]] Status validate(const ContactRecord& record, const BodyRecord& a, const BodyRecord& b,
                              const AssetSet& assets);
[[nodiscard]] Status validate(const JointRecord& record, const BodyRecord& a, const BodyRecord& b);

/// Whether a joint may hold the two, and whether a body's joints may sit there.
[[nodiscard]] bool can_join(const BodyRecord& a, const BodyRecord& b);
[[nodiscard]] bool is_anchor(const BodyRecord& body, const Vec3<Length>& anchor);

/// |q| = 1 within 2^-20. For bytes from outside.
[[nodiscard]] bool has_unit_norm(const Quat& q);

}  // namespace lockstone
