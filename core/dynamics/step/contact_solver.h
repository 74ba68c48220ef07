// The contact solver of one tick: bodies, colours, blocks of constraints and iterations over them.
//
// Source of the method: E. Catto, "Solver2D", 2024 (the soft-step solver): each substep integrates
// velocities, starts warm, solves with soft bias, integrates positions and relaxes without bias.
// docs/explanation/solver.md lists the differences.
#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <tuple>
#include <vector>

#include "core/base/parallel.h"
#include "core/dynamics/body/solver_body.h"
#include "core/dynamics/contact/contact_prepare.h"
#include "core/dynamics/direct/proximal_solver.h"
#include "core/dynamics/islands/constraint_graph.h"
#include "core/dynamics/islands/tick_islands.h"
#include "core/dynamics/joint/coloured_balls.h"
#include "core/dynamics/stack/initial_warm_start.h"
#include "core/dynamics/stack/stack_rebalance.h"
#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/contact_record.h"
#include "core/dynamics/state/joint_record.h"
#include "core/dynamics/state/time_step.h"
#include "core/dynamics/step/energy_limit.h"
#include "core/geometry/distance/manifold.h"
#include "core/kernels/contact/manifold_block.h"

namespace lockstone {

class JointSolver;
struct JointRun;

/// The solver's inputs from a world. The manifold and the surfaces of record i are in slot
/// slots[i]; those of triggers are left out.
struct ContactScene {
  std::span<const BodyRecord> bodies;
  std::span<const Mat3> rotations;
  std::span<const std::uint32_t> slots;
  std::span<const Manifold> manifolds;
  std::span<const ContactSurface> surfaces;
  std::span<const ContactRecord> records;
  std::span<const JointRecord> joints;
  std::span<const JointLink> joint_links;
  Vec3<Acceleration> gravity;
  std::uint64_t tick = 0;
};

class ContactSolver {
 public:
  /// No functions but this and `make_room` allocate.
  [[gnu::cold]] ContactSolver(const TimeStep& step, std::size_t body_capacity,
                              std::size_t contact_capacity, std::size_t joint_capacity,
                              std::size_t converged_contacts);
  [[gnu::cold]] ~ContactSolver();

  /// For this many workers.
  void make_room(std::uint32_t workers);

  /// Gathers the touched bodies and makes the constraints, in the order of the records.
  void prepare(const ContactScene& scene, Parallel& parallel);

  /// All substeps.
  void run(Parallel& parallel);

  /// Writes the last impulses of each point, and whether the surfaces met, to the records, and the
  /// fastest approach of each to `approaches`.
  void store(std::span<const Manifold> manifolds, std::span<ContactRecord> records,
             std::span<SolverVelocity> approaches, Parallel& parallel);

  /// Writes the last impulses of each joint to the records.
  void store_joints(std::span<const JointLink> links, std::span<JointRecord> joints,
                    Parallel& parallel) const;

  /// Null when no constraint touched the body.
  [[nodiscard]] const SolverBody* find(std::uint32_t body) const;

  /// Writes a touched body's substeps back: position, orientation, velocity and spin.
  /// `rotation` is the matrix of its orientation; returns the same as `fly`.
  std::uint32_t move(const SolverBody& solved, const Mat3& rotation, BodyRecord& body);

  /// Once all have moved: bounces that would give an island energy give less.
  void limit_bounces(std::span<BodyRecord> bodies, Velocity speed_limit);

  /// The velocity and the spin that a touched body has after `run`.
  [[nodiscard]] std::array<Vec3<Velocity>, 2> speeds(const SolverBody& solved) const;

  [[nodiscard]] std::uint32_t contacts() const;
  [[nodiscard]] std::uint32_t points() const { return points_.load(); }
  [[nodiscard]] std::uint32_t colors() const { return graph_.colors(); }
  [[nodiscard]] std::uint32_t overflow() const { return graph_.count(k_overflow_color); }
  /// Whether the body's manifolds may stay as they are: its island is left to the iterations, and
  /// it has not drifted far.
  [[nodiscard]] bool keeps_contact_pose(std::uint32_t body, const BodyRecord& record) const;

  /// Times that an island gave back energy in the tick.
  [[nodiscard]] std::uint32_t energy_limits() const;

  /// Values that were clamped to their range.
  [[nodiscard]] std::uint32_t saturations() const { return saturations_; }

 private:
  static constexpr std::uint32_t k_no_contact = 0xffffffff;

  // Added to the number of a body that never moves.
  static constexpr std::uint32_t k_immovable = 0x80000000;

  // Ticks from one stack rebalance to the next.
  static constexpr std::uint64_t k_heap_ticks = 64;

  // Blocks of one colour.
  struct Range {
    std::size_t first = 0;
    std::size_t count = 0;
  };
  // A loop of the substeps.
  enum class StageKind : std::uint8_t {
    note_energies,
    velocities,
    warm_joints,
    impacts,
    solve,
    push_islands,
    lift_net,
    solve_joints,
    positions,
    move_joined,
    follow_net,
    relax_joints,
    relax_net,
    relax,
    relax_islands,
    limit_moves,
    limit_energies,
    end_islands,
    keep_speeds,
    bounce,
    store,
  };
  struct Stage {
    StageKind kind = StageKind::velocities;
    std::uint8_t color = 0;
    std::uint8_t substep = 0;
  };
  // Working memory of preparation.
  struct Scratch {
    lanes::ManifoldSources sources;
    SolverBody fixed_a, fixed_b;  // bodies that never move
  };
  // One contact in the solver.
  struct Entry {
    std::uint32_t record;
    std::uint32_t slot;
    std::uint32_t body_a;
    std::uint32_t body_b;
  };

  // A body of a record, with its motion type in the upper two bits, by which bodies enter the
  // solver. Zero for a record that is left out.
  struct Side {
    static constexpr int k_motion_bit = 30, k_mark_bit = 29;

    std::uint32_t word = 0;

    Side() = default;
    Side(std::uint32_t body, MotionType motion)
        : word(body | static_cast<std::uint32_t>(motion) << k_motion_bit) {}

    [[nodiscard]] std::uint32_t body() const { return word & ((1U << k_mark_bit) - 1); }
    [[nodiscard]] MotionType motion() const {
      return static_cast<MotionType>(word >> k_motion_bit);
    }
    [[nodiscard]] bool is_left_out() const { return word == 0; }
    // On side A: a new contact of two dynamic bodies. On side B: an overloaded contact.
    [[nodiscard]] bool is_marked() const { return (word >> k_mark_bit & 1) != 0; }
    void mark() { word |= 1U << k_mark_bit; }
    [[nodiscard]] bool is_dynamic() const { return motion() == MotionType::dynamic; }
  };
  struct Sides {
    Side a, b;

    [[nodiscard]] bool is_new() const { return a.is_marked(); }
    [[nodiscard]] bool is_bearing() const { return b.is_marked(); }
  };

  // The data of a world that `store` reads and writes.
  struct StoreTarget {
    std::span<const Manifold> manifolds;
    std::span<ContactRecord> records;
    std::span<SolverVelocity> approaches;
  };
  // Along which axis contacts pushed a body in this tick; `mixed` when along several.
  struct PushAxis {
    Vec3<Unit> normal{};
    bool pushed = false;
    bool mixed = false;

    void add(const Vec3<Unit>& n);
  };

  // Velocity and spin before the bounces of a tick, and the gains that bounces gave.
  struct Bounce {
    Vec3<Velocity> velocity, spin, velocity_gain, spin_gain;
  };
  // Of an island, twice energies in a unit of its own.
  struct IslandGain {
    BlockFloat unit{};        // inverse mass
    std::int64_t gained = 0;  // besides the work of gravity and forces
    std::int64_t square = 0;  // of bounces
    std::int64_t linear = 0;  // of bounces and of the speeds before them
    std::int32_t share = 0;   // of bounces that is left, Q30
  };

  std::uint32_t take_up(Side side);
  std::uint32_t number_of(Side side) {
    const std::uint32_t known = side.is_dynamic() ? solver_index_[side.body()] : 0;
    return known != 0 ? known : take_up(side);
  }
  void find_sides(const ContactScene& scene, std::size_t first, std::size_t end);
  void take_up_contacts(const ContactScene& scene, Parallel& parallel);
  void reserve_rows();
  [[nodiscard]] static constexpr std::size_t blocks_for(std::size_t contacts) {
    return (contacts + lanes::k_block_lanes - 1) / lanes::k_block_lanes;
  }
  void take_up_joints(const ContactScene& scene);
  void begin_joints();
  void take_up_net(const ContactScene& scene);
  // Where a body that no impulse moves pushes an island.
  struct Hold {
    std::uint32_t island = 0;
    std::uint32_t body = 0;
    Vec3<Unit> normal{};

    friend bool operator==(const Hold&, const Hold&) = default;
    [[nodiscard]] auto key() const {
      return std::tuple(island, body, normal.x.raw, normal.y.raw, normal.z.raw);
    }
  };
  void reserve_islands(std::size_t rows, std::size_t bodies, std::size_t contacts,
                       std::size_t joints, std::size_t converged);
  [[nodiscard]] IslandLoad& load_of(const ContactScene& scene, const JointLink& link);
  void bar_islands(const ContactScene& scene);
  void list_island(std::uint32_t island);
  [[nodiscard]] Hold hold_of(const ContactScene& scene, std::size_t entry) const;
  void mark_pinched(const ContactScene& scene);
  void chain_islands(const ContactScene& scene);
  [[nodiscard]] ProximalContact converged_contact(std::uint32_t index) const;
  [[nodiscard]] std::uint32_t converged_islands() const;
  void plan_converged(const ContactScene& scene);
  void begin_converged(const ContactScene& scene);
  void run_converged(StageKind kind, std::size_t first, std::size_t end);
  void find_first_loads(const ContactScene& scene, Parallel& parallel);
  template <class Takes>
  void add_supports(const ContactScene& scene, const Takes& takes);
  [[nodiscard]] bool is_free(std::uint32_t index) const;
  void count_islands(const ContactScene& scene);
  // An entry has at least one dynamic body; all others are of island 0.
  [[nodiscard]] IslandLoad& island_of(std::size_t entry) {
    const auto of = [this](std::uint32_t index) {
      return (index & k_immovable) != 0 ? 0 : islands_.of(index);
    };
    return islands_.load(std::max(of(entries_[entry].body_a), of(entries_[entry].body_b)));
  }
  [[nodiscard]] bool is_firm(const ContactScene& scene, const Entry& entry) const;
  [[nodiscard]] bool is_loaded(const ContactScene& scene, const Entry& entry,
                               std::int64_t share_b) const;
  [[nodiscard]] ContactRun contact_run();
  [[nodiscard]] JointRun joint_run();
  [[nodiscard]] NetRun net_run() {
    return {rows_.data(), before_.data(), inertias_.data(), bodies_.data(), places_.data()};
  }
  [[nodiscard]] std::uint32_t row_count() const;
  // Immovable bodies come after the members.
  [[nodiscard]] std::uint32_t row_of(std::uint32_t index) const {
    if ((index & k_immovable) == 0) return index;
    return static_cast<std::uint32_t>(members_.size()) + (index & ~k_immovable);
  }
  // 0: a body that no impulse moves.
  [[nodiscard]] std::uint32_t pushed_number(std::uint32_t index) const {
    return (index & k_immovable) == 0 && bodies_[index].is_pushed() ? index : 0;
  }
  void lay_out(Parallel& parallel);
  // The lane of an entry's contact, counted over all blocks.
  [[nodiscard]] std::uint32_t slot_of(std::size_t entry) const {
    const ConstraintGraph::Place place = graph_.places()[entry];
    return static_cast<std::uint32_t>(ranges_[place.color].first * lanes::k_block_lanes) +
           place.rank;
  }
  void add_loop(Stage stage, std::uint32_t count, std::uint32_t grain, bool is_serial = false);
  void add_loop_of_each_color(StageKind kind, std::uint8_t substep = 0);
  void add_net_loops(StageKind kind);
  void add_loops_of_substep(std::uint8_t substep);
  [[nodiscard]] const lanes::ManifoldKernels& kernels_of(std::size_t color) const;

  // Pieces of loops.
  void fill_bodies(const ContactScene& scene, std::size_t first, std::size_t end);
  void fill_member(const ContactScene& scene, std::size_t index);
  void fill_blocks(const ContactScene& scene, std::size_t color, std::size_t first,
                   std::size_t end);
  const Entry* look_ahead(std::size_t slot, std::span<const ContactRecord> records) const;
  std::uint32_t fill_block(const ContactScene& scene, std::size_t block, Scratch& scratch);
  void prepare_piece(const ContactScene& scene, const Stage& stage, std::size_t first,
                     std::size_t end);
  void run_piece(const Stage& stage, std::size_t first, std::size_t end);
  void sweep(const Stage& stage, std::size_t first, std::size_t end);
  void integrate_velocities(bool is_first, std::size_t first, std::size_t end);
  void integrate_positions(std::size_t first, std::size_t end);
  void hold(std::size_t index);
  void hold_blocks(std::size_t first, std::size_t end);
  void bounce(const lanes::ManifoldKernels& kernels, std::size_t first, std::size_t end);
  std::uint32_t move(std::size_t index, const Mat3& rotation, BodyRecord& body) const;
  void find_impacts(const ContactScene& scene);
  [[nodiscard]] bool meets(const Entry& entry) const;
  void push_by_impact(std::uint32_t index, const BodyRecord& before, const BodyRecord& after);
  void answer(std::uint32_t index);
  void run_impacts();
  void find_fed_islands(const ContactScene& scene);
  [[nodiscard]] EnergyLimit::Bodies energy_bodies();
  void keep_speeds(std::size_t first, std::size_t end);
  void note_gain(std::size_t index, const BodyRecord& body, const BodyRecord& start);
  [[nodiscard]] Bounce bounce_of(std::size_t index, const BodyRecord& body) const;
  [[nodiscard]] static std::int32_t share_of_bounces(const IslandGain& gain);
  template <class Visit>
  void for_gaining(const Visit& visit);
  [[nodiscard]] Vec3<Velocity> half_step_back(std::size_t index, const BodyRecord& body) const;
  void add_axes(const Entry& entry, const Vec3<Unit>& normal);
  [[nodiscard]] bool is_alone(const Entry& entry) const;
  std::uint32_t store_blocks(const Stage& stage, std::size_t first, std::size_t end,
                             const StoreTarget& target);
  std::uint32_t store_contact(std::size_t block_index, std::size_t lane,
                              ContactRecord& record) const;

  TimeStep step_;
  ContactSoftness softness_;
  lanes::SweepRules rules_;
  std::uint32_t first_substep_ = 0;  // of the tick, from the world's beginning, modulo 2^32
  int load_shift_;  // a contact's load follows its impulses over 2^this ticks: four to eight
                    // seconds
  ConstraintGraph graph_;
  std::uint32_t immovables_ = 0;
  std::atomic<std::uint32_t> points_{0};
  std::uint32_t saturations_ = 0;

  // By body: the first of its numbers here; 0: not in the solver.
  std::vector<std::uint32_t> solver_index_;

  // By number: bodies that move, from 1; then, in all but the first two, one for each contact of a
  // body that does not.
  std::vector<std::uint32_t> members_;  // the body
  std::vector<SolverBody> bodies_;
  std::vector<lanes::SourceBody> inertias_;
  std::vector<lanes::RowBody> rows_;
  std::vector<lanes::RowBody> before_;  // at the beginning of the substep; before the first: warm
  std::vector<lanes::RowTravel> travel_;
  std::vector<PushAxis> axes_;
  std::vector<std::int64_t> gained_;  // twice the energy that no force accounts for, of each mass
  std::vector<IslandGain> gains_;
  EnergyLimit energy_limit_;
  std::vector<lanes::BodyPlace> places_;  // of the bodies in nets of joints

  std::unique_ptr<JointSolver> joints_;
  JointNet net_;
  std::unique_ptr<ProximalSolver> proximal_;  // null where no island is solved to convergence
  std::uint32_t most_island_contacts_ = 0;    // of an island that is
  std::vector<std::uint32_t> first_of_;  // of an island: its first body, then its first entry, + 1
  std::vector<std::uint32_t> next_of_;   // of a body, then of an entry: the next, + 1
  std::vector<std::uint32_t> island_bodies_;
  std::vector<ProximalContact> island_contacts_;
  std::vector<IslandJoint> island_joints_;
  std::vector<Hold> moving_holds_;  // by island
  SupportOrder supports_;
  FirstLoads first_loads_;
  HeapLoads heap_loads_;
  std::uint32_t first_without_contacts_ = 1;  // by number

  std::vector<Sides> sides_;  // by record
  std::vector<Entry> entries_;
  std::vector<std::uint32_t> impacts_;  // entries of balls that may bounce within a substep
  ContactScene scene_{};                // of such a tick
  TickIslands islands_;
  Range ranges_[k_graph_colors + 1];
  const lanes::ManifoldKernels* kernels_ = nullptr;  // for as many contacts as a colour has at most
  std::vector<std::uint32_t> slots_;  // by lane of each block: an entry, or k_no_contact
  std::vector<std::uint8_t> kept_;    // by lane: whether the record has the manifold's points
  std::size_t block_count_ = 0;
  std::vector<lanes::ManifoldBlock> blocks_;
  std::vector<lanes::ManifoldApproach> approaches_;
  std::vector<lanes::BlockWord> restitution_;
  bool is_idle_ = false;              // neither contacts nor joints in this tick
  bool has_heap_ = false;             // an island bears many loads
  std::int64_t heap_push_ = 0;        // from which on a contact bears several times a weight,
                                      // of all its points, m/s, Q20
  std::atomic<bool> bounces_{false};  // any restitution at all
  std::atomic<bool> holds_{false};    // any locked axis of moving
  std::vector<Loop> loops_;           // of the sequence at hand
  std::vector<Stage> stages_;         // of each loop
};

}  // namespace lockstone
