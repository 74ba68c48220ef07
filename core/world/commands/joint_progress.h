// The state of joints that are no settings: a pulley's rope, the tooth that holds a ratchet, the
// place of a path joint. The last two follow the bodies after each tick.
#pragma once

#include <lockstone/joint.h>

#include "core/dynamics/state/joint_record.h"
#include "core/world/data/world_data.h"

namespace lockstone {

/// Whether a ratchet may have as many teeth in a turn: a whole number, 2 … 1000.
[[nodiscard]] constexpr bool is_teeth(Number ratio) {
  const Number whole = Number::from_integer(ratio.raw >> Number::frac_bits);
  return ratio == whole && ratio >= Number::from_integer(2) && ratio <= Number::from_integer(1000);
}

/// Sets that state by where the bodies are. False if there is no such path, or a pulley's rope is
/// too long: at most 1000 m each and together.
[[nodiscard]] bool begin_joint(const WorldData& world, JointRecord& joint);

/// New settings leave the tooth that holds alone, and limits of a path joint are on its path.
void keep_progress(const WorldData& world, const JointRecord& joint, JointRecord& changed);

/// After a tick: the tooth that was passed last, the place on the path.
void advance_joint(const WorldData& world, JointRecord& joint);

}  // namespace lockstone
