// Solves each small island's contacts and joints to convergence: one proximal problem a phase.
//
// A phase finds impulses λ and velocities v = v* + M⁻¹Jᵀλ such that J·v + b + γ(λ − c) = 0 for
// every row that is neither separating nor sliding, with λ ≥ 0 along normals and friction within
// its limit: the least of D(λ) = |M⁻¹Jᵀλ|²/2 + λ·(J·v* + b) + Σ γ(λ − c)²/2 over those λ. Passes of
// projected Gauss-Seidel find which rows those are; direct steps solve for them by a factor of
// 1 + JᵀJ/γ, and go towards its solution only as far as D falls. The compliance γ is small, and the
// centre c, the last substep's impulse less a bounded leak, carries the load: the solution is that
// of rigid contacts but for a damping of the order of γ.
//
// Sources: J. Carpentier, R. Budhiraja, N. Mansard, "Proximal and sparse resolution of constrained
// dynamic equations", 2021 (the proximal problem); docs/notes/solver-choice.md (the leak, and the
// comparison of solvers). Kinetic energy after the warm start is at most that of the free motion,
// since its impulses are scaled to the least of D.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "core/dynamics/linkage/island_joints.h"
#include "core/dynamics/problem/body_factor.h"
#include "core/dynamics/problem/island_joint.h"
#include "core/dynamics/problem/proximal_rows.h"

namespace lockstone {

/// The joints of a tick, and the data that they are solved with.
struct JointAccess {
  IslandJoints& joints;
  JointRun run;
};

class ProximalSolver {
 public:
  /// Room for this many bodies, contacts with joints, and joints of islands, whose bodies are among
  /// the first `rows` of the solver. No function but this allocates.
  [[gnu::cold]] ProximalSolver(std::size_t rows, std::size_t body_capacity,
                               std::size_t contact_capacity, std::size_t joint_capacity);

  /// `first_free`: bodies of this number or above touch nothing.
  void clear(std::uint32_t first_free);

  /// An island whose bodies, contacts and joints are given in their order; false if it is too
  /// large. Bodies are numbers in the solver; of a contact the pair's numbers are read, 0 for a
  /// body that nothing moves.
  [[nodiscard]] bool add(std::span<const std::uint32_t> bodies,
                         std::span<const ProximalContact> contacts,
                         std::span<const IslandJoint> joints);

  [[nodiscard]] std::span<ProximalContact> contacts() { return contacts_; }

  [[nodiscard]] std::uint32_t count() const { return static_cast<std::uint32_t>(islands_.size()); }

  /// Bodies of all islands.
  [[nodiscard]] std::span<const std::uint32_t> bodies() const { return bodies_; }

  /// Once blocks are prepared: takes contacts over from the iterations. `weight` is gravity's gain
  /// in a substep, m/s, Q32.
  void begin(const ContactRun& run, std::uint32_t island, std::int64_t weight, int substeps);

  /// One phase. With `pushes_out` overlap goes.
  void solve(const ContactRun& run, const JointAccess& joints, std::uint32_t island,
             bool pushes_out);

  /// After the last phase: writes the impulses to the blocks, and gives the contacts back to the
  /// iterations.
  void end(const ContactRun& run, std::uint32_t island) const;

 private:
  struct Island {
    BodyFactor::Plan plan;
    std::uint32_t first_body = 0;  // in bodies_
    std::uint32_t bodies = 0;
    std::uint32_t first_vector = 0;  // in velocities_ … : one more than bodies
    std::uint32_t first_contact = 0;
    std::uint32_t contacts = 0;
    std::uint32_t first_joint = 0;
    std::uint32_t joints = 0;
    std::uint32_t first_problem = 0;  // contacts first, then joints
    BlockFloat unit{};                // 1/m₀
    int bits = 0;                     // fraction bits of the phase's units
    int loose = 0;                    // the phase's tolerance is 2^this times the least
    int drop = 0;                     // bits of residuals that the direct step at hand leaves out
    bool fits = true;                 // so far nothing in the phase had to be clamped
    bool is_solved = false;           // by the last direct step
    bool is_first = true;             // substep of the tick
    bool warms = false;               // this phase begins with the impulses of the tick before
    bool was_factored = false;        // in this tick
    bool is_factored = false;         // for the rows that are active

    [[nodiscard]] std::uint32_t problems() const { return contacts + joints; }
  };
  static constexpr std::uint32_t k_no_block = 0xffffffff;
  // Where blocks of the bodies of a contact or a joint are in the factor.
  struct Blocks {
    std::uint32_t a = k_no_block, b = k_no_block;
    BodyFactor::Place both{k_no_block, false};
  };
  // A body's change of velocity in a phase, m/s, Q32.
  struct Gain {
    RawVec3 velocity{}, spin{};
  };

  using Problem = lanes::ProximalBlock;
  static void take_over(const ContactRun& run, ProximalContact& contact);
  struct Motion;
  [[nodiscard]] BlockFloat find_unit(const ContactRun& run, const Island& island);
  static void begin_rows(const PreparedRows& prepared, std::int64_t weight,
                         ProximalContact& contact, Problem& problem);
  static void set_drives(const ContactRun& run, int substeps, ProximalContact& contact,
                         Problem& problem);
  [[nodiscard]] static std::int64_t speed_along(const RawVec3* linear, const RawVec3& response_a,
                                                const RawVec3& response_b, const Motion& motion);
  static void measure(const ContactRun& run, const PreparedRows& prepared,
                      const ProximalContact& contact, Problem& problem);
  void begin_substep(Island& island);
  void return_leaks(const Island& island);
  void loosen(Island& island);
  static void set_bias(const ContactRun& run, const ProximalContact& contact, Problem& problem,
                       bool pushes_out, bool is_jointed);
  static void soften(std::int64_t overlap, const ProximalRow& row, std::size_t i, Problem& problem);
  [[nodiscard]] bool set_units(Island& island);
  void scale_warm_start(Island& island);
  [[nodiscard]] bool pass(Island& island);
  void mark_active(Island& island);
  void factor(Island& island);
  [[nodiscard]] bool direct_step(Island& island);
  void find_residuals(Island& island);
  [[nodiscard]] bool solve_for_changes(Island& island);
  void sum_changes(Island& island);
  [[nodiscard]] std::int64_t search(const Island& island);
  void go(Island& island, std::int64_t part);
  [[nodiscard]] bool converge(Island& island, bool scales);
  [[nodiscard]] bool move_centres(Island& island);
  void iterate(Island& island);
  void add_problem(const Island& island, std::uint32_t a, std::uint32_t b);
  void see_bodies(const ContactRun& run, const Island& island);
  [[nodiscard]] std::int64_t seen_speed(const Island& island, const Problem& problem,
                                        std::size_t row);
  void find_carried_speeds(const ContactRun& run, const Island& island);
  void see_joints(const ContactRun& run, const JointAccess& joints, Island& island,
                  bool pushes_out);
  void see_inertia(const ContactRun& run, const Island& island);
  void give_joints(const JointAccess& access, const Island& island);
  void give(const ContactRun& run, Island& island);
  void follow(Island& island);
  static void give_contact(const ContactRun& run, int bits, ProximalContact& contact,
                           Problem& problem, Gain& a, Gain& b);

  [[nodiscard]] std::span<ProximalContact> contacts_of(const Island& island) {
    return std::span(contacts_).subspan(island.first_contact, island.contacts);
  }
  [[nodiscard]] std::span<Problem> problems_of(const Island& island) {
    return std::span(problems_).subspan(island.first_problem, island.problems());
  }
  [[nodiscard]] std::span<BodyVector> of(std::vector<BodyVector>& all, const Island& island) {
    return std::span(all).subspan(island.first_vector, island.bodies + 1);
  }

  std::vector<Island> islands_;
  std::vector<std::uint32_t> bodies_;  // numbers in the solver, island by island
  std::vector<ProximalContact> contacts_;
  std::vector<IslandJoint> joints_;
  std::vector<Problem> problems_;       // rows of contacts and joints, island by island
  std::vector<Blocks> blocks_;          // alike
  std::vector<BodyVector> velocities_;  // changes since the phase began
  std::vector<BodyVector> changes_;
  std::vector<Gain> gains_;
  std::vector<InertiaRoot> roots_;
  std::vector<std::uint32_t> local_;  // by number in the solver
  std::size_t body_capacity_, contact_capacity_, joint_capacity_;
  std::uint32_t first_free_ = 0;
  std::vector<BodyFactor::Pair> pairs_;
  BodyFactor factor_;
};

}  // namespace lockstone
