// Fluids: volumes of water, mud or wind that carry, brake and drive the bodies in them.
#pragma once

#include <cstdint>

#include <lockstone/quat.h>
#include <lockstone/units.h>
#include <lockstone/vec3.h>

namespace lockstone {

class World;

/// The fluids of a world have the numbers 0 … k_max_fluids − 1, which the game gives them.
inline constexpr std::uint32_t k_max_fluids = 16;

/// A box of fluid below a flat surface. A dynamic body is in it while its centre of mass is below
/// or above the surface, within the sides and above the bottom; the part of it below the surface is
/// in the fluid, with
///
/// - buoyancy, −density · volume · gravity at the centre of that volume, exact for every shape;
/// - drag, ½ · density · drag · A · u² against the velocity u of that centre in the fluid, A the
///   area of the body's shadow along its velocity, times the part of its volume that is in the
///   fluid;
/// - linear drag, density · volume · linear_drag · u, and the same of the body's turning.
///
/// Forces work evenly over a tick and follow from the pose in its middle, so that a body that bobs
/// or rolls neither gains nor loses energy by the steps; drag never turns a motion round.
struct Fluid {
  Vec3<Position> surface{};  ///< the centre of the surface, m, within ±2^20
  Quat orientation{};        ///< y points out of the surface; is normalised
  Vec3<Position> size{};     ///< m: half the width, the depth, half the length; 0 … 2^21
  Density density{};         ///< kg/m³; 0: there is no fluid of this number
  Number drag{};             ///< coefficient of the form, 0 … 100: 0.5 of a ball, 1 of a box
  Rate linear_drag{};        ///< 1/s, ≥ 0
  Vec3<Velocity> flow{};     ///< m/s, each component within ±500: a current, or wind
  std::uint32_t mask = 0xffffffff;  ///< categories of the bodies that it acts on

  friend bool operator==(const Fluid&, const Fluid&) = default;
};

/// The fluid of a number, as it is kept; of one that was never set, or removed, a fluid without
/// density.
[[nodiscard]] Fluid fluid_at(const World& world, std::uint32_t number);

}  // namespace lockstone
