// The contacts of a tick as blocks of constraints: prepared from manifolds, iterated, and stored.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/contact/contact_prepare.h"
#include "core/dynamics/contact/row_geometry.h"
#include "core/dynamics/step/contacts/constraint_layout.h"
#include "core/dynamics/step/contacts/solved_motion.h"
#include "core/dynamics/step/input/contact_list.h"
#include "core/dynamics/step/input/contact_scene.h"
#include "core/dynamics/step/input/solver_bodies.h"
#include "core/dynamics/step/islands/effort_policy.h"
#include "core/dynamics/step/islands/island_builder.h"

namespace lockstone {

class ContactConstraints {
 public:
  /// The other parts of the tick, which must outlive this.
  struct Parts {
    SolverBodies& bodies;
    const ContactList& contacts;
    IslandBuilder& islands;
    const EffortPolicy& effort;
  };

  /// No function but this allocates.
  [[gnu::cold]] ContactConstraints(const TimeStep& step, std::size_t body_capacity,
                                   std::size_t contact_capacity, const Parts& parts);

  /// Gives each contact its lane, and makes room for the blocks.
  void lay_out(const ContactScene& scene, Parallel& parallel);
  [[nodiscard]] const ConstraintLayout& layout() const { return layout_; }

  /// Prepares blocks of one colour, counted from its first, once bodies are filled.
  void prepare(const ContactScene& scene, std::size_t color, std::size_t first, std::size_t end);

  /// An iteration over blocks of one colour: pushes overlap out by soft rows.
  void solve(std::size_t color, std::size_t first, std::size_t end);
  /// Without bias, with friction. `substep`: since the world's beginning, modulo 2^32.
  void relax(std::size_t color, std::size_t first, std::size_t end, std::uint32_t substep);
  /// Restitution, after the last substep.
  void bounce(std::size_t color, std::size_t first, std::size_t end);

  /// The world's data that `store` reads and writes.
  struct StoreTarget {
    std::span<const Manifold> manifolds;
    std::span<ContactRecord> records;
    std::span<SolverVelocity> approaches;
  };
  /// Writes blocks of one colour to the records, and their normals to `motion`. Returns the number
  /// of clamped values.
  std::uint32_t store(std::size_t color, std::size_t first, std::size_t end,
                      const StoreTarget& target, SolvedMotion& motion) const;

  /// The fastest approach of a point, m/s, Q20.
  [[nodiscard]] std::int32_t approach_of(ContactLane place) const {
    return approaches_[place.block()].fastest(place.lane());
  }
  /// The contact has bounced in this tick.
  void forget_restitution(ContactLane place) { restitution_[place.block()][place.lane()] = 0; }
  /// Whether any contact of the tick has restitution.
  [[nodiscard]] bool has_restitution() const {
    return has_restitution_.load(std::memory_order_relaxed);
  }
  [[nodiscard]] std::uint32_t points() const { return points_.load(std::memory_order_relaxed); }

  /// The data that other solvers share.
  [[nodiscard]] ContactRun run();

 private:
  // Working memory of preparation.
  struct Scratch {
    lanes::PrepareInputs inputs;
    SolverBody fixed_a, fixed_b;  // bodies that stand still
  };

  std::uint32_t fill_block(const ContactScene& scene, std::size_t block, Scratch& scratch);
  void fill_lane(const ContactScene& scene, ContactLane place, Scratch& scratch);
  [[nodiscard]] const ContactRef* look_ahead(std::size_t lane,
                                             std::span<const ContactRecord> records) const;
  [[nodiscard]] const lanes::ManifoldKernels& kernels_of(std::size_t color) const;
  void apply_axis_locks(std::size_t first, std::size_t end);
  std::uint32_t store_contact(ContactLane place, ContactRecord& record) const;

  Parts parts_;
  ContactSoftness softness_;
  lanes::SolverParams params_;
  int mean_shift_;  // a contact's mean impulse follows its impulses over 2^this ticks: four to
                    // eight seconds
  ConstraintLayout layout_;
  const lanes::ManifoldKernels* kernels_ = nullptr;  // for as many contacts as a colour has at most
  std::vector<lanes::ManifoldBlock> blocks_;
  std::vector<lanes::ManifoldApproach> approaches_;
  std::vector<lanes::BlockWord> restitution_;
  std::vector<std::uint8_t> has_points_;  // by lane: whether the record has the manifold's points
  std::atomic<std::uint32_t> points_{0};
  std::atomic<bool> has_restitution_{false};
};

}  // namespace lockstone
