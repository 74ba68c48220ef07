// Vectors for the rules: headings, speeds, impulses.
#pragma once

#include <lockstone/world.h>

namespace lockstone::arena {

/// `direction` (length ≤ 1) at `speed`.
[[nodiscard]] inline Vec3<SolverVelocity> along(const Vec3<Unit>& direction, SolverVelocity speed) {
  return {rounded<SolverVelocity>(direction.x * speed),
          rounded<SolverVelocity>(direction.y * speed),
          rounded<SolverVelocity>(direction.z * speed)};
}

[[nodiscard]] inline Vec3<Length> along(const Vec3<Unit>& direction, Length distance) {
  return {rounded<Length>(direction.x * distance), rounded<Length>(direction.y * distance),
          rounded<Length>(direction.z * distance)};
}

[[nodiscard]] inline Vec3<SolverVelocity> solver_velocity(const Vec3<Velocity>& velocity) {
  return saturated<SolverVelocity>(velocity);
}

[[nodiscard]] inline Vec3<Velocity> master_velocity(const Vec3<SolverVelocity>& velocity) {
  return rounded<Velocity>(velocity);
}

[[nodiscard]] inline Vec3<Position> moved(const Vec3<Position>& from, const Vec3<Length>& by) {
  return from + rounded<Position>(by);
}

/// The impulse that changes the velocity of `mass` by `change`.
[[nodiscard]] inline Vec3<Impulse> impulse_for(Mass mass, const Vec3<SolverVelocity>& change) {
  return {multiply<Impulse>(mass, change.x), multiply<Impulse>(mass, change.y),
          multiply<Impulse>(mass, change.z)};
}

/// `velocity` shortened to at most `limit`.
[[nodiscard]] Vec3<SolverVelocity> shortened(const Vec3<SolverVelocity>& velocity,
                                             SolverVelocity limit);

/// b − a, components clamped to ± 2000 m.
[[nodiscard]] Vec3<Length> offset_between(const Vec3<Position>& a, const Vec3<Position>& b);

/// The square of a length, in 2^-24 m² (raw, so that distances below 2000 m compare exactly
/// enough).
[[nodiscard]] std::int64_t squared_raw(const Vec3<Length>& offset);

}  // namespace lockstone::arena
