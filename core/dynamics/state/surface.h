// How the surfaces of two bodies meet.
#pragma once

#include <cstdint>

#include <lockstone/material.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

/// The surface properties of a contact, both sides combined.
struct ContactSurface {
  Coefficient friction{};
  Coefficient restitution{};
  Length rolling_arm{};          ///< torque against rolling / normal force
  Vec3<SolverVelocity> drive{};  ///< of B's surface against A's, at the centre of the points
  Rate twist_drive{};            ///< the same about the normal
  Vec3<SolverVelocity> arc{};    ///< the gain in a substep of the drive, which is a tick's mean
  bool is_left_out = false;      ///< of the solver: it bounces within the tick, or stands still
  std::uint32_t tag_a = 0;
  std::uint32_t tag_b = 0;
};

[[nodiscard]] Coefficient combined_friction(const Surface& a, const Surface& b);
[[nodiscard]] Coefficient combined_restitution(const Surface& a, const Surface& b);
[[nodiscard]] Coefficient combined_rolling(const Surface& a, const Surface& b);

}  // namespace lockstone
