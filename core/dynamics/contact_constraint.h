// Contact constraints in the form that the solver iterates on.
//
// For a direction u (the normal or a tangent) at a point with lever arms rA, rB, with r̄ = r/s the
// lever arm normalised by the body's scale, and with shares α = (1/m) / (1/mA + 1/mB):
//   relative velocity  v = u·(vB − vA) + jB·LB − jA·LA,   j = M·(r̄ × u),  L = spin
//   an impulse P (the pair's velocity jump) changes  vB by αB·u·P,  LB by αB·(r̄B × u)·P,
//                                                   vA by −αA·u·P, LA by −αA·(r̄A × u)·P
//   effective mass     m̄ = 1 / (1 + Σ α (r̄ × u)·j)  in (0, 1].
// Writing to L, not to the surface speed, makes what A gains exactly what B loses.
#pragma once

#include <array>
#include <cstdint>

#include "core/dynamics/solver_body.h"
#include "core/geometry/manifold.h"

namespace lockstone {

/// One direction at one point.
struct ContactRow {
  Lanes32 gain_a{}, gain_b{};  // α·(r̄ × u), Q30
  Lanes32 read_a{}, read_b{};  // M·(r̄ × u), Q(30 − exponent)
  std::int32_t mass = 0;       // m̄, Q30
  std::int32_t impulse = 0;    // P of the current substep, m/s, Q20
};

/// u itself with its shares.
struct ContactAxis {
  Lanes32 unit{};              // Q30
  Lanes32 gain_a{}, gain_b{};  // α·u, Q30
};

struct ContactPoint {
  ContactRow normal;
  ContactRow tangent[2];
  Lanes32 lever_a{}, lever_b{};      // r̄ × n, Q30: how turning changes the separation
  std::int32_t soft_mass = 0;        // m̄ · mass scale of the soft constraint, Q30
  std::int32_t separation = 0;       // at the tick's beginning, m, Q24
  std::int32_t approach = 0;         // relative normal velocity before the solver, m/s, Q20
  std::int32_t largest_impulse = 0;  // of all substeps, m/s, Q20
};

/// Stiffness of a soft constraint: E. Catto, "Solver2D", 2024, and "Soft Constraints", GDC 2011.
struct Softness {
  std::int32_t bias_rate = 0;      // 1/s, Q20
  std::int32_t mass_scale = 0;     // Q30
  std::int32_t impulse_scale = 0;  // Q30
};

/// One manifold. Solver indices name entries of the solver's body array; 0 is the immovable body.
struct ContactConstraint {
  std::uint32_t body_a = 0;
  std::uint32_t body_b = 0;
  std::uint32_t record = 0;  // index of its ContactRecord
  int exponent = 0;          // of read_a, read_b
  int count = 0;
  std::uint8_t tangent_axis = 0;
  std::int32_t friction = 0;     // Q30
  std::int32_t restitution = 0;  // Q30
  Softness softness;
  ContactAxis normal;
  ContactAxis tangent[2];
  ContactRow common;  // the normal at the mean of the points; its impulse is not used
  std::int32_t common_soft_mass = 0;
  std::array<ContactPoint, k_max_manifold_points> points;
};

}  // namespace lockstone
