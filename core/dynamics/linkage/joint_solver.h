// The joints of one tick, inside the substeps of the contact solver.
//
// Joints connected by pushed bodies form a cluster. In one that is a tree, or nearly one, a direct
// solve covers all locks (`JointFactor`); in worlds with converged contacts also the locks and
// motors of one with loops (`ProximalLocks`). Of other clusters, balls are left to `JointNet`, and
// other joints are solved one after another, by index. The scheme is RATTLE: impulses at the
// beginning of the substep such that locks hold at its end, and at the end such that they do not
// open (H. C. Andersen, "Rattle: a velocity version of the Shake algorithm", 1983).
// docs/explanation/solver.md says how accurate this is.
#pragma once

#include <array>
#include <atomic>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

#include "core/dynamics/body/principal_inverse.h"
#include "core/dynamics/body/solver_body.h"
#include "core/dynamics/islands/tick_islands.h"
#include "core/dynamics/joint/joint_rows.h"
#include "core/dynamics/linkage/joint_factor.h"
#include "core/dynamics/problem/island_joint.h"
#include "core/dynamics/problem/proximal_locks.h"
#include "core/dynamics/state/body_record.h"
#include "core/dynamics/state/joint_record.h"
#include "core/dynamics/state/time_step.h"
#include "core/kernels/ball/ball_block.h"
#include "core/kernels/contact/contact_rows.h"
#include "core/kernels/contact/manifold_block.h"
#include "core/math/round_divisor.h"

namespace lockstone {

/// The data of a substep, by solver body; 0 is immovable.
struct JointRun {
  std::span<SolverBody> bodies;
  std::span<lanes::RowBody> rows;
  std::span<lanes::RowBody> before;  // receives joint impulses too: they are not replayed
  std::span<lanes::SourceBody> inertias;
  std::span<lanes::BodyPlace> places;
};

/// Velocity, surface velocity and spin of a body, by its own inertia.
struct JointMotion {
  Vec3<Velocity> velocity{}, surface{}, spin{};
};

class JointSolver {
 public:
  /// Groups with loops are solved directly only if `solves_loops`. No function but this allocates.
  [[gnu::cold]] JointSolver(const TimeStep& step, std::size_t body_capacity,
                            std::size_t joint_capacity, bool solves_loops);

  void clear();

  /// A joint, in the order of their indices. Its references must stay valid for the tick.
  struct Side {
    std::uint32_t body = 0;    // index in the world
    std::uint32_t solver = 0;  // in the solver, 0 for a body that does not move
    const BodyRecord& record;
    const Mat3& rotation;
  };
  void add(const JointRecord& joint, const Side& a, const Side& b);

  [[nodiscard]] bool empty() const { return links_.empty(); }

  /// Whether any joints are solved here.
  [[nodiscard]] bool has_own() const { return !joints_.empty(); }

  /// Once all are added: forms groups. Returns the joints, in the order of adding, that are left to
  /// a net.
  std::span<const std::uint32_t> plan(std::uint32_t first_without_contacts);

  /// Then, before contacts are prepared: bodies as heavy to turn as the step needs.
  void begin(const JointRun& run);

  /// After the last substep: spins as they are kept.
  void end(const JointRun& run);

  /// Number of clusters, without joints that are left to a net. No two share a body that is pushed:
  /// the functions below take a range of clusters, and ranges may be worked at side by side.
  [[nodiscard]] std::uint32_t cluster_count() const {
    return static_cast<std::uint32_t>(clusters_.size());
  }

  /// Once contacts are prepared: rows and factors; bodies that drift freely go half a substep.
  void prepare(const JointRun& run, std::size_t first, std::size_t end);

  /// At the beginning of a substep, after forces: the impulses of the last one again.
  void warm_start(const JointRun& run, std::size_t first, std::size_t end);

  /// Before positions move: drives, limits, and locks such that they hold afterwards.
  void solve(const JointRun& run, std::size_t first, std::size_t end);

  /// After positions moved: locks and limits such that they do not open.
  void relax(const JointRun& run, std::size_t first, std::size_t end);

  /// Writes where they are to `places`, each by itself.
  void place(const JointRun& run, std::size_t first, std::size_t end) const;

  /// Moves the jointed bodies, as the contact solver moves those without joints: each by itself, in
  /// the order in which joints first named them.
  void move(const JointRun& run, std::size_t first, std::size_t end);
  [[nodiscard]] std::uint32_t body_count() const {
    return static_cast<std::uint32_t>(bodies_.size());
  }

  /// Impulses back to a record, in the order of adding; not of those in a net.
  void store(std::size_t added, JointRecord& joint) const;

  // The problem of an island's contacts has the joints' locks and limits too (`ProximalSolver`).

  /// The number of the joint that was added so; k_in_net of one that is left to a net.
  static constexpr std::uint32_t k_in_net = 0xffffffff;
  [[nodiscard]] std::uint32_t number_of(std::size_t added) const { return links_[added].joint; }
  [[nodiscard]] IslandJoint island_joint(std::uint32_t joint) const;
  /// Before `begin`: the problem has the joint, and gravity acts on its bodies as on those with
  /// contacts.
  void put_among_contacts(std::uint32_t joint);
  [[nodiscard]] std::span<const JointRow> rows(std::uint32_t joint) const {
    return joints_[joint].rows.rows.first(joints_[joint].rows.count);
  }
  /// As a row sees it, m/s, Q50.
  [[nodiscard]] std::int64_t speed(const JointRun& run, std::uint32_t joint,
                                   std::size_t row) const {
    return speed(run, joints_[joint], joints_[joint].rows.rows[row]);
  }
  /// The speed at which the rest of the way to a limit may be gone, or, before positions move, at
  /// which it is pushed back; Q50.
  [[nodiscard]] std::int64_t limit_speed(const JointRow& row, bool positions) const;
  /// The impulse of a limit so far, ≥ 0, Q50.
  [[nodiscard]] std::int64_t limit_impulse(std::uint32_t joint, std::size_t row) const;
  /// Adds impulses, by row, which the next substep begins with.
  using RowImpulses = std::array<std::int64_t, k_max_joint_rows>;
  void give(const JointRun& run, std::uint32_t joint, const RowImpulses& impulses);

  /// The spin that a body of the world with this surface velocity has by its own inertia, which
  /// `spin` need not be: a body may be taken to be heavier to turn.
  [[nodiscard]] Vec3<Velocity> own_spin(std::uint32_t body, const Vec3<Velocity>& spin,
                                        const Vec3<Velocity>& surface) const;

  /// Where a body of the world is now; null when no joint holds it.
  [[nodiscard]] const JointPose* find(std::uint32_t body) const;

  /// Times that a cluster gave back energy.
  [[nodiscard]] std::uint32_t energy_limits() const { return energy_limits_; }

  /// Pivots left out and values clamped.
  [[nodiscard]] std::uint32_t clamps() const { return clamps_; }

 private:
  struct Body {
    JointPose pose;
    const BodyRecord* record = nullptr;
    std::int64_t least_inertia = 0;  // Q30: moments are taken to be at least this
    PrincipalInverse principal{};    // if it has such
    bool has_principal = false;
    InverseInertia inverse_inertia{};
    InverseInertia inertia_ahead{};  // half a substep on, as far as is known
    std::uint32_t solver = 0;
    int scale = 0;              // exponent
    lanes::RowBody unpushed{};  // as the stage at hand found it
    lanes::RowBody saved_row{};
    lanes::RowBody start{};  // of the substep
    Vec3<Position> start_position{};
    std::int64_t start_turning = 0;  // twice the energy for each mass
    BlockFloat mass{};               // as a part of that of its cluster's heaviest body
    lanes::RowBody looked{};         // its velocity on the way to its pose in `after_`
    bool has_looked = false;
    bool pushed = false;
    bool touches = false;            // has contacts
    bool is_among_contacts = false;  // its joints are in the problem of its island's contacts
    std::int64_t lever_inertia = 0;  // Q30, besides its own
    bool pulled = false;             // an eighth as hard as needs more inertia
    bool centred = false;            // half kick, drift, half kick
    bool free = false;               // half drift, kick, half drift
    RoundDivisor rate{};             // 1 / the time that it drifts for
    bool in_net = false;
    std::uint32_t first_joint = 0;  // in by_body_
    std::uint32_t joint_count = 0;
    std::uint32_t local = 0;  // in its group
  };

  // A joint as groups are found.
  struct Link {
    const JointRecord* record = nullptr;
    std::uint32_t a = 0, b = 0;  // bodies of this solver
    std::uint32_t order = 0;     // within its group
    std::uint32_t joint = 0;     // in joints_, or k_in_net
  };
  // A part of an inverse mass as mantissa · 2^-shift.
  struct Share {
    std::uint32_t mantissa = 0;
    int shift = 1;
  };
  // The data of a limit or drive besides its Jacobians.
  struct Solved {
    std::int64_t inverse = 0;  // of its response to itself: mantissa · 2^-shift
    int shift = 1;
  };
  // The impulse of a spring before positions move, or after it, with its damping a.
  struct SpringPart {
    std::int64_t stiffness = 0;  // 1/s, Q40, per 1 + a
    std::int32_t forgets = 0;    // Q30, 1 / (1 + a)
    std::int32_t share = 0;      // of its bound, Q30
  };
  struct Drive {
    std::int64_t bound = 0;  // Q50; 0: none
    SpringPart before, after;

    [[nodiscard]] bool is_spring() const { return before.share != 0; }
  };
  struct Joint {
    const JointRecord* record = nullptr;
    JointRows rows;
    JointFrames frames;
    std::array<Solved, k_max_joint_rows> solved{};
    std::array<Drive, k_joint_axes> drives{};
    std::array<std::int64_t, k_joint_axes> locks{};    // impulses by axis, Q50; limits too
    std::array<std::int64_t, k_joint_axes> relaxed{};  // of locks, after positions moved
    std::array<std::int64_t, k_joint_axes> carried{};  // `relaxed` of the substep before, or
                                                       // saved where the cluster does not drift
    std::array<std::int64_t, k_joint_axes> saved{};    // locks
    std::array<std::int64_t, k_joint_axes> driven{};
    std::array<std::int64_t, k_joint_axes> driven_later{};  // after positions moved, as `relaxed`
    std::array<std::int64_t, k_joint_axes> left_open{};     // of locks, by row: too far to close in
                                                            // the substep, m, Q32
    std::uint32_t a = 0, b = 0;                             // bodies of this solver
    Share share_a, share_b;
    BlockFloat inverse_mass{};              // of the pair
    std::int64_t lever_a = 0, lever_b = 0;  // to the anchors, m, Q20: sums of their components
    std::uint64_t factored = 0;             // rows that the factor has, as `row_list`
    int exponent = 0;
    std::uint32_t left_out = 0;  // rows, a bit each, without impulses from the factor of loops
    std::array<std::int8_t, k_joint_axes> scales{};  // of its locks in the factor, exponents
    std::uint8_t far = 0;        // axes whose limits have no rows in this tick, a bit each
    bool holds_a_point = false;  // and nothing else has rows in this tick
  };
  struct Group {
    std::uint32_t first = 0;  // in order_ and in group_bodies_, and its column in the factor
    std::uint32_t count = 0;
    std::uint32_t first_body = 0;
    std::uint32_t body_count = 0;
    std::uint32_t column = 0;
    bool exact = false;
    bool drifts = false;
    bool is_plain = false;  // neither limits nor drives
    bool is_factored = false;
    bool is_fresh = false;    // and so for the rows at hand
    bool turns_fast = false;  // in this tick a factor of earlier rows did not serve
    bool is_rough = false;    // a step of this tick did not hold the joints
    int exponent = 0;         // least of its rows
    int fresh_solves = 0;     // of hold_speeds, with a factor of the rows at hand
    std::uint32_t loops = ProximalLocks::k_too_large;  // its number there, if it is solved there
    std::int64_t rate = 0;                             // 1 / the time that its bodies drift for
    std::int64_t speed = 0;  // of its locks, as hold_speed last found it, Q50
  };
  // Locks that are open by less, m, Q32, are closed: 1 µm.
  static constexpr std::int64_t k_closed = 1 << 12;

  // Connected joints, by index: one group with a direct solve, or a group for each joint.
  struct Cluster {
    std::uint32_t first_joint = 0;
    std::uint32_t joint_count = 0;
    std::uint32_t first_group = 0;
    std::uint32_t group_count = 0;
    std::uint32_t first_body = 0;  // in group_bodies_
    std::uint32_t body_count = 0;
    std::int32_t substep = 0;
    bool free = false;
    bool is_driven = false;   // by springs or motors
    bool is_passive = false;  // only gravity and forces give it energy
    bool knows_energy = false;
    BlockFloat unit{};        // inverse mass of its heaviest body
    std::int64_t gained = 0;  // besides, in this tick: twice the energy by that mass
    std::int64_t energy = 0;  // as the last substep ended, if that is known
  };

  std::uint32_t take_up(const Side& side);
  void link_bodies();
  void find_group(std::uint32_t root);
  void plan_group(Group group);
  void add_cluster(const Group& group, std::uint32_t first_group);
  void plan_singles(const Group& group);
  [[nodiscard]] static bool has_solved_loops(const Group& group) {
    return group.loops != ProximalLocks::k_too_large;
  }
  [[nodiscard]] bool has_loops(const Group& group) const;
  [[nodiscard]] bool has_motors(const Group& group) const;
  [[nodiscard]] bool is_pressed(const Group& group) const;
  [[nodiscard]] bool plan_loops(Group& group);
  void factor_loops(Group& group, bool ahead);
  void factor(const JointRun& run, Group& group, bool ahead);
  [[nodiscard]] bool has_factor(const Group& group) const;
  [[nodiscard]] std::uint32_t rows_left_out(const JointRun& run, const Joint& joint) const;
  void solve_loops(const JointRun& run, Group& group, bool positions);
  void forget_impulses(const Cluster& cluster);
  [[nodiscard]] bool mark_left_out(const JointRun& run, const Group& group);
  [[nodiscard]] std::int64_t motor_error(const JointRun& run, const Group& group) const;
  [[nodiscard]] bool hold_motors(const JointRun& run, const Group& group, bool positions);
  void add_loop_speeds(const JointRun& run, const Group& group, int sign);
  [[nodiscard]] std::int64_t motor_impulse(const Group& group, std::uint32_t joint, std::size_t row,
                                           bool positions);
  void find_loop_errors(const JointRun& run, const Group& group, bool positions);
  void push_loops(const JointRun& run, const Group& group, bool positions);
  [[nodiscard]] static std::int64_t& loop_impulse(Joint& joint, const JointRow& row,
                                                  bool positions);
  [[nodiscard]] std::int64_t* errors_at(const Group& group, std::uint32_t joint);
  [[nodiscard]] bool fits_net(const Link& link) const;
  void add_to_net(Link& link);
  void make_joint(Link& link);
  [[nodiscard]] static std::uint32_t most_locks(const JointRecord& joint);
  void set_drives(Joint& joint) const;
  void set_spring(const Joint& joint, const JointAxisRecord& axis, Drive& drive) const;
  void load_impulses(Joint& joint, int shift) const;
  [[nodiscard]] JointPlace place_of(const Joint& joint, const JointPose& a,
                                    const JointPose& b) const;
  void add_pull(std::uint32_t body, std::int64_t jump, std::int64_t lever);
  [[nodiscard]] bool can_drift(const Cluster& cluster);
  [[nodiscard]] static bool is_plain(const Joint& joint);
  void set_rate(const Cluster& cluster, std::int64_t rate);
  void drift(JointRun run, Cluster& cluster);
  void stay(Cluster& cluster);
  void move(const JointRun& run, std::uint32_t body);
  void add_pulls(std::span<const Joint> joints, bool free);
  void add_pulls(const Link& link);
  void find_pulled();
  [[nodiscard]] static std::int64_t swung_inertia(const Body& body);
  [[nodiscard]] std::int64_t lever_inertia(std::uint32_t body) const;
  void resist_pull(const JointRun& run, std::uint32_t body);
  void set_inertia(const JointRun& run, Body& body, std::int64_t least);
  static void set_principal(Body& body);
  [[nodiscard]] static InverseInertia inverse_inertia_of(const Body& body, const Mat3& rotation);
  void linearize(Joint& joint) const;
  void linearize(const Cluster& cluster);
  static void hold(const Body& body, RawVec3& linear);
  void respond(Joint& joint, std::size_t rows, bool ahead) const;
  void scale_locks(Joint& joint) const;
  void factor_group(Group& group);
  void fill_block(const Joint& p, const Joint& q, std::int64_t* block) const;
  void add_shared(const Joint& p, bool a_of_p, const Joint& q, bool a_of_q,
                  std::int64_t* block) const;
  [[nodiscard]] std::int64_t speed(const JointRun& run, const Joint& joint,
                                   const JointRow& row) const;
  void push(const JointRun& run, const Joint& joint, std::size_t row, std::int64_t impulse);
  void push(const JointRun& run, const Joint& joint, std::size_t first, std::size_t end,
            const RowImpulses& impulses);
  [[nodiscard]] JointPose pose_after(const JointRun& run, Body& body) const;
  void begin_pushes(const JointRun& run, const Cluster& cluster);
  void end_pushes(const JointRun& run, std::span<const std::uint32_t> bodies);
  void warm_start(const JointRun& run, Joint& joint);
  void solve(const JointRun& run, const Cluster& cluster);
  void relax(const JointRun& run, const Cluster& cluster);
  void hold_speeds(const JointRun& run, const Cluster& cluster);
  void hold_speed(const JointRun& run, Group& group, int solve);
  [[nodiscard]] static JointMotion motion_of(const Body& body, const lanes::RowBody& row);
  template <class Each>
  [[nodiscard]] std::int64_t sum_over(const Cluster& cluster, const Each& each) const;
  void open_account(Cluster& cluster);
  void begin_account(const JointRun& run, Cluster& cluster);
  // Twice a cluster's energy, and the terms of its change.
  struct Energies {
    std::int64_t first = 0, linear = 0, square = 0;
  };
  [[nodiscard]] Energies energies_between(const JointRun& run, const Cluster& cluster,
                                          const lanes::RowBody Body::*from) const;
  void go_part(const JointRun& run, const Cluster& cluster, const lanes::RowBody Body::*from,
               std::int32_t share);
  void limit_warm_start(const JointRun& run, const Cluster& cluster);
  void project_start(const JointRun& run, const Cluster& cluster);
  void settle_account(const JointRun& run, Cluster& cluster);
  void leave_out_far(const JointRun& run, Joint& joint) const;
  [[nodiscard]] bool is_far(const JointRun& run, const Joint& joint, const JointRow& row) const;
  bool solve_drives(const JointRun& run, Joint& joint, bool motors);
  void solve_springs_later(const JointRun& run, Joint& joint);
  [[nodiscard]] std::int64_t spring_impulse(const JointRun& run, const Joint& joint,
                                            std::size_t row, bool later) const;
  bool solve_limits(const JointRun& run, Joint& joint, bool positions);
  void solve_locks(const JointRun& run, Group& group, bool positions);
  void solve_positions(const JointRun& run, const Cluster& cluster, Group& group);
  [[nodiscard]] std::int64_t find_positions(const JointRun& run, Group& group);
  [[nodiscard]] std::int64_t close(const JointRun& run, Group& group, bool turn);
  void hold_roughly(const JointRun& run, const Cluster& cluster, Group& group);
  [[nodiscard]] bool closes_too_fast(const JointRun& run, const Cluster& cluster) const;
  void limit_closing(const JointRun& run, const Cluster& cluster);
  [[nodiscard]] bool is_stiff(const Group& group) const;
  void save(const JointRun& run, const Group& group);
  void restore(const JointRun& run, const Group& group);
  void look_ahead(const JointRun& run, Group& group, bool turn);
  std::int64_t set_position_errors(const Group& group);
  std::int64_t set_speed_errors(const JointRun& run, const Group& group, bool positions);
  [[nodiscard]] std::span<Joint> joints_of(const Cluster& cluster) {
    return std::span(joints_).subspan(cluster.first_joint, cluster.joint_count);
  }
  [[nodiscard]] std::span<Group> groups_of(const Cluster& cluster) {
    return std::span(groups_).subspan(cluster.first_group, cluster.group_count);
  }
  [[nodiscard]] std::span<const std::uint32_t> bodies_of(const Cluster& cluster) const {
    return std::span(group_bodies_).subspan(cluster.first_body, cluster.body_count);
  }
  [[nodiscard]] std::span<const std::uint32_t> joints_of(const Group& group) const {
    return std::span(order_).subspan(group.first, group.count);
  }
  [[nodiscard]] std::span<const std::uint32_t> joints_at(const Body& body) const {
    return std::span(by_body_).subspan(body.first_joint, body.joint_count);
  }

  TimeStep step_;
  std::vector<Body> bodies_;
  std::vector<std::uint32_t> place_;   // by body of the world: in bodies_, + 1
  std::vector<std::uint32_t> placed_;  // bodies of the world that have a place
  std::vector<Link> links_;
  std::vector<std::uint32_t> in_net_;        // links
  std::vector<Joint> joints_;                // cluster by cluster
  std::vector<JointRow> rows_;               // of those, as many as each can have; never shrinks
  std::size_t row_count_ = 0;                // of them taken
  std::vector<std::uint32_t> by_body_;       // links of each pushed body
  std::vector<std::uint32_t> order_;         // joints, group by group, as they are eliminated
  std::vector<std::uint32_t> group_bodies_;  // bodies, group by group
  std::vector<std::uint8_t> seen_;           // by link
  std::vector<std::uint8_t> visited_;        // by body
  std::vector<std::uint32_t> sorted_;        // links of the cluster at hand, by index
  std::vector<Group> groups_;
  std::vector<Cluster> clusters_;
  std::vector<std::int64_t> pulls_;  // by body: pulls of joints at levers, per mass and scale
  std::vector<JointPose> after_;     // by body: where it will be after the substep
  JointFactor factor_;
  std::unique_ptr<ProximalLocks> loops_;  // null unless it solves loops
  std::atomic<std::uint32_t> clamps_{0};
  std::atomic<std::uint32_t> energy_limits_{0};
};

}  // namespace lockstone
