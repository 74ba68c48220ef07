// Soft-step sequential impulses on contacts: the sweeps of one substep.
//
// Source of the method: E. Catto, "Solver2D", 2024 (the soft-step solver): each substep integrates
// velocities, starts warm, solves with soft bias, integrates positions and relaxes without bias.
#pragma once

#include <cstdint>
#include <span>

#include "core/dynamics/contact_constraint.h"
#include "core/dynamics/time_step.h"

namespace lockstone {

/// Velocity of B relative to A along one direction, m/s, Q20, rounded once per dot product.
[[nodiscard]] std::int32_t relative_velocity(const ContactAxis& axis, const ContactRow& row,
                                             int exponent, const SolverBody& a,
                                             const SolverBody& b);

class ContactSolver {
 public:
  ContactSolver(std::span<SolverBody> bodies, std::span<ContactConstraint> contacts,
                const TimeStep& step)
      : bodies_(bodies), contacts_(contacts), substep_rate_(step.substep_rate()) {}

  /// Applies the impulses of the last substep again.
  void warm_start();

  /// One sweep in constraint order; `use_bias` pushes penetration out.
  void solve(bool use_bias);

  /// Bounces what came in faster than the threshold.
  void apply_restitution();

  /// Impulses that left their range and were clamped.
  [[nodiscard]] std::uint32_t saturations() const { return saturations_; }

 private:
  void solve_common_normal(ContactConstraint& contact, bool use_bias);
  void solve_point_friction(ContactConstraint& contact, ContactPoint& point);
  void solve_point_normal(ContactConstraint& contact, ContactPoint& point, bool use_bias);
  void apply_normal(ContactConstraint& contact, ContactPoint& point, std::int64_t total);

  // The velocity that a point's separation asks for, with its stiffness.
  struct NormalTarget {
    std::int64_t bias;  // m/s, Q20
    bool soft;
  };
  [[nodiscard]] NormalTarget target(const ContactConstraint& contact, const ContactPoint& point,
                                    bool use_bias) const;
  [[nodiscard]] std::int64_t separation(const ContactConstraint& contact,
                                        const ContactPoint& point) const;
  void apply(const ContactConstraint& contact, const ContactAxis& axis, const ContactRow& row,
             std::int64_t impulse);

  std::span<SolverBody> bodies_;
  std::span<ContactConstraint> contacts_;
  std::int32_t substep_rate_;
  std::uint32_t saturations_ = 0;
};

}  // namespace lockstone
