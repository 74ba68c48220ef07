// The contact solver of one tick: bodies, colours, blocks of constraints and the sweeps over them.
//
// Source of the method: E. Catto, "Solver2D", 2024 (the soft-step solver): each substep integrates
// velocities, starts warm, solves with soft bias, integrates positions and relaxes without bias.
// What differs is told in docs/solver.md.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/body_record.h"
#include "core/dynamics/constraint_graph.h"
#include "core/dynamics/contact_prepare.h"
#include "core/dynamics/contact_record.h"
#include "core/dynamics/solver_body.h"
#include "core/dynamics/time_step.h"
#include "core/geometry/manifold.h"
#include "core/math/wide/manifold_block.h"

namespace lockstone {

/// What the solver reads of a world. Manifolds, surfaces and records go together; those of triggers
/// are left out.
struct ContactScene {
  std::span<const BodyRecord> bodies;
  std::span<const Mat3> rotations;
  std::span<const Manifold> manifolds;
  std::span<const SurfacePair> surfaces;
  std::span<const ContactRecord> records;
  Vec3<Acceleration> gravity;
};

class ContactSolver {
 public:
  /// No function but this allocates.
  ContactSolver(const TimeStep& step, std::size_t body_capacity, std::size_t contact_capacity);

  /// Takes up the touched bodies and makes the constraints, in the order of the records.
  void prepare(const ContactScene& scene);

  /// All substeps.
  void run();

  /// Writes what each point ended with, and whether the surfaces met, to the records, and the
  /// fastest approach of each to `approaches`.
  void store(std::span<const Manifold> manifolds, std::span<ContactRecord> records,
             std::span<SolverVelocity> approaches);

  /// Null when no constraint touched the body.
  [[nodiscard]] const SolverBody* find(std::uint32_t body) const;

  /// Writes a touched body's substeps back: position, orientation, velocity and spin.
  /// `rotation` is the matrix of its orientation; answers as `fly`.
  std::uint32_t move(const SolverBody& solved, const Mat3& rotation, BodyRecord& body) const;

  [[nodiscard]] std::uint32_t contacts() const;
  [[nodiscard]] std::uint32_t points() const { return points_; }
  [[nodiscard]] std::uint32_t colors() const { return graph_.colors(); }
  [[nodiscard]] std::uint32_t overflow() const { return graph_.count(k_overflow_color); }

  /// Values that were clamped to their range.
  [[nodiscard]] std::uint32_t saturations() const { return saturations_; }

 private:
  static constexpr std::uint32_t k_no_contact = 0xffffffff;

  // Blocks of one colour.
  struct Range {
    std::size_t first = 0;
    std::size_t count = 0;
  };
  // One contact in the solver.
  struct Entry {
    std::uint32_t record;
    std::uint32_t body_a;
    std::uint32_t body_b;
  };

  std::uint32_t take_up(const ContactScene& scene, std::uint32_t body);
  void lay_out();
  void look_ahead(const ContactScene& scene, std::size_t slot) const;
  void fill_block(const ContactScene& scene, std::size_t block);
  void integrate_velocities(int substep);
  void integrate_positions();
  void bounce();
  void store_contact(std::size_t block, std::size_t lane, const Manifold& manifold,
                     ContactRecord& record, SolverVelocity& approach);

  TimeStep step_;
  ContactSoftness softness_;
  lanes::SweepRules rules_;
  int load_shift_;  // a contact's load follows its impulses over 2^this ticks: four to eight
                    // seconds
  ConstraintGraph graph_;
  std::uint32_t points_ = 0;
  std::uint32_t saturations_ = 0;

  // By body; 0: not in the solver.
  std::vector<std::uint32_t> solver_index_;
  std::vector<std::uint32_t> taken_up_;  // those that are in it

  // By solver body; entry 0 is the immovable one.
  std::vector<SolverBody> bodies_;
  std::vector<lanes::SourceBody> inertias_;
  std::vector<lanes::RowBody> rows_;
  std::vector<lanes::RowBody> before_;  // at the beginning of the substep; before the first: warm
  std::vector<lanes::RowTravel> travel_;

  std::vector<Entry> entries_;
  Range ranges_[k_graph_colors + 1];
  std::vector<std::uint32_t> slots_;  // by lane of each block: an entry, or k_no_contact
  std::size_t block_count_ = 0;
  lanes::ManifoldSources sources_;
  std::vector<lanes::ManifoldBlock> blocks_;
  std::vector<lanes::ManifoldApproach> approaches_;
  std::vector<lanes::BlockWord> restitution_;
};

}  // namespace lockstone
