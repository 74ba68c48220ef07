// The project's quantities: one format each, chosen for its range. See
// docs/explanation/numerics.md.
#pragma once

#include <cstdint>

#include <lockstone/fixed.h>

namespace lockstone {

using Scalar = Dimension<0, 0, 0>;
using Metre = Dimension<1, 0, 0>;
using Kilogram = Dimension<0, 1, 0>;
using Second = Dimension<0, 0, 1>;
using PerSecond = Dimension<0, 0, -1>;
using MetrePerSecond = Dimension<1, 0, -1>;
using MetrePerSecond2 = Dimension<1, 0, -2>;
using SquareMetre = Dimension<2, 0, 0>;
using NewtonSecond = Dimension<1, 1, -1>;
using NewtonMetre = Dimension<2, 1, -2>;
using NewtonMetreSecond = Dimension<2, 1, -1>;
using Newton = Dimension<1, 1, -2>;
using KilogramMetre2 = Dimension<2, 1, 0>;
using KilogramPerMetre3 = Dimension<-3, 1, 0>;

/// World position, one axis. ±2^31 m representable, world limit ±2^20 m; resolution 0.23 nm.
using Position = Fixed<Metre, std::int64_t, 32>;

/// Velocity, master copy. Speed limit 500 m/s; resolution 0.23 nm/s.
using Velocity = Fixed<MetrePerSecond, std::int64_t, 32>;

/// Relative position, shape size, anchor. ±2048 m; resolution 0.95 µm.
using Length = Fixed<Metre, std::int32_t, 20>;

/// Velocity as the solver sees it. ±2048 m/s; resolution 0.95 µm/s.
using SolverVelocity = Fixed<MetrePerSecond, std::int32_t, 20>;

/// Displacement within one tick, and separation of contact points. ±128 m; resolution 60 nm.
using Displacement = Fixed<Metre, std::int32_t, 24>;

/// Components of unit vectors, rotations, and coefficients in [-1, 1]. ±2; resolution 0.93e-9.
using Unit = Fixed<Scalar, std::int32_t, 30>;

/// Friction, restitution and the like, 0 … 2.
using Coefficient = Unit;

/// A plain number. ±2048; resolution 0.95e-6.
using Number = Fixed<Scalar, std::int32_t, 20>;

/// Angle in radians. ±16 (more than two turns); resolution 7.5e-9.
using Angle = Fixed<Scalar, std::int32_t, 27>;

/// Angular velocity at the interface. Resolution 0.23e-9 rad/s.
using AngularVelocity = Fixed<PerSecond, std::int64_t, 32>;

/// Damping rate. ±2048 per second.
using Rate = Fixed<PerSecond, std::int32_t, 20>;

using Acceleration = Fixed<MetrePerSecond2, std::int64_t, 32>;
using Density = Fixed<KilogramPerMetre3, std::int32_t, 8>;          ///< up to 8.3e6 kg/m³
using Mass = Fixed<Kilogram, std::int64_t, 32>;                     ///< up to 2.1e9 kg
using MomentOfInertia = Fixed<KilogramMetre2, std::int64_t, 28>;    ///< up to 3.4e10 kg·m²
using Impulse = Fixed<NewtonSecond, std::int64_t, 24>;              ///< up to 5e11 N·s
using AngularImpulse = Fixed<NewtonMetreSecond, std::int64_t, 24>;  ///< up to 5e11 N·m·s
using Force = Fixed<Newton, std::int64_t, 20>;                      ///< up to 8e12 N
using Torque = Fixed<NewtonMetre, std::int64_t, 20>;                ///< up to 8e12 N·m

}  // namespace lockstone
