// Checks of the commands that change a body itself, shared with the explanation of refusals.
#pragma once

#include <lockstone/command.h>
#include <lockstone/world.h>

#include "core/dynamics/state/body_record.h"

namespace lockstone {

/// The body with another motion.
[[nodiscard]] BodyRecord with_motion(const World::Impl& world, std::uint32_t body,
                                     MotionType motion);
/// Whether a body may become `changed`, which has another type of motion.
[[nodiscard]] bool can_become(const World::Impl& world, std::uint32_t body,
                              const BodyRecord& changed);

/// The mass that the command gives a body that becomes dynamic.
[[nodiscard]] Mass mass_as_dynamic(const World::Impl& world, const SetMotionType& command);

/// Whether the body, which exists, may take the shape, which is valid and has this asset.
[[nodiscard]] bool can_take_shape(const World::Impl& world, const SetShape& command,
                                  const geometry::AssetGeometry* asset);

}  // namespace lockstone
