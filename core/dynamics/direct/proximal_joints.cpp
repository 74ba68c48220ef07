// The joints among an island's contacts. Locks are rows that may pull, limits are rows that push;
// both are read again in each phase, where the joint solver has them. Their impulses go to the
// joint solver, which repeats those of locks in the next substep, and a phase finds their changes.
// Springs and motors act in between, one by one; then the joint solver closes the openings that
// second-order terms leave.

#include <algorithm>

#include "core/dynamics/contact/block_words.h"
#include "core/dynamics/direct/proximal_solver.h"
#include "core/dynamics/problem/proximal_words.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {
namespace {

using namespace proximal;

// γ of locks and limits over a row's response to itself, 2^-14: the factor's least eigenvalue.
constexpr std::int64_t k_lock_give = std::int64_t{1} << (30 - BodyFactor::k_least_bits);

// A change of speed is none below this, m/s, Q50.
constexpr std::int64_t k_least_joint_change = (std::int64_t{1} << 50) / 10000;

// √(m/m₀)·(v, Cᵀ·spin), in units of kept quantities.
BodyVector motion_of(const lanes::RowBody& row, const InertiaRoot& root, const RowScale& mass) {
  constexpr int k_down = lanes::k_velocity_bits - k_row_unit_bits;
  BodyVector u{};
  for (std::size_t i = 0; i < 3; ++i) {
    u[i] = mass.times(row.velocity[i], k_down);
    ProductSum turn;
    for (std::size_t k = i; k < 3; ++k)
      turn.add(root.c[k][i], row.spin[k]);
    u[3 + i] = mass.times(turn.rounded(30 - root.shift), k_down);
  }
  return u;
}

}  // namespace

// How bodies move now, as all rows see it. Contacts' rows stay for the tick, and so does the
// inertia of the bodies that have any.
void ProximalSolver::see_bodies(const ContactRun& run, const Island& island) {
  const std::span<BodyVector> motions = of(changes_, island);
  for (std::uint32_t k = 0; k < island.bodies; ++k) {
    const std::uint32_t body = bodies_[island.first_body + k];
    InertiaRoot& root = roots_[island.first_vector + k];
    if (body >= first_free_) root = inertia_root(run.bodies[body].inverse_inertia);
    motions[k] =
        motion_of(run.rows[body], root, mass_scale(island.unit, run.bodies[body].inverse_mass));
  }
  motions[island.bodies] = {};
}

// The speed of a contact's row by the motion of the bodies that impulses move.
std::int64_t ProximalSolver::seen_speed(const Island& island, const Problem& problem,
                                        std::size_t row) {
  const std::span<const BodyVector> motions = of(changes_, island);
  const BodyVector &a = motions[problem.a], &b = motions[problem.b];
  ProductSum sum;
  for (std::size_t i = 0; i < lanes::k_body_words; ++i) {
    sum.add(low_word(problem.by_row[row][i]), a[i]);
    sum.add(high_word(problem.by_row[row][i]), b[i]);
  }
  return sum.rounded(30);
}

// Joints may hold bodies where they overlap, and then no impulses part them: they would grow
// without limit. The deeper a point overlaps, the softer its row, and the more of its impulse it
// forgets.
void ProximalSolver::soften(std::int64_t overlap, const ProximalRow& row, std::size_t i,
                            Problem& problem) {
  constexpr std::int64_t k_firm = (std::int64_t{1} << 24) / 4000, k_soft = 16 * k_firm;  // m, Q24
  constexpr std::int64_t k_most_give = k_whole >> 3;
  constexpr std::int64_t k_width = k_soft - k_firm;
  const std::int64_t beyond = std::clamp<std::int64_t>(overlap - k_firm, 0, k_width);
  const std::int64_t more = std::max<std::int64_t>(k_most_give - row.give, 0);
  set_give(row.give + raw::round_divide(more * beyond, k_width), i, problem);
  problem.held_centre[i] -= raw::round_divide(problem.held[i] / 2, k_width) * beyond;
}

// The rest of the rows' speeds, which kinematic bodies give them.
void ProximalSolver::find_carried_speeds(const ContactRun& run, const Island& island) {
  see_bodies(run, island);
  for (std::uint32_t i = 0; i < island.contacts; ++i) {
    ProximalContact& contact = contacts_[island.first_contact + i];
    const Problem& problem = problems_[island.first_problem + i];
    for (std::size_t r = 0; r < contact.rows; ++r)
      contact.all[r].carried = within_row(problem.moved[r] - seen_speed(island, problem, r));
  }
}

// Joints have pushed the bodies since the last phase, and turn with them.
void ProximalSolver::see_joints(const ContactRun& run, const JointAccess& joints, Island& island,
                                bool pushes_out) {
  see_bodies(run, island);
  for (std::uint32_t i = 0; i < island.contacts; ++i) {
    const ProximalContact& contact = contacts_[island.first_contact + i];
    Problem& problem = problems_[island.first_problem + i];
    for (std::size_t r = 0; r < contact.rows; ++r)
      problem.moving[r] = within_row(contact.all[r].carried + seen_speed(island, problem, r));
  }
  for (std::uint32_t i = 0; i < island.joints; ++i)
    see_joint(joints, island, joints_[island.first_joint + i],
              problems_[island.first_problem + island.contacts + i], pushes_out);
  island.is_factored = island.was_factored = false;
}

void ProximalSolver::see_joint(const JointAccess& access, const Island& island, IslandJoint& joint,
                               Problem& problem, bool pushes_out) {
  const std::uint32_t a = problem.a, b = problem.b;
  problem = {};
  problem.a = a;
  problem.b = b;
  problem.has_locks = true;
  const ProximalJoint pair{roots_[island.first_vector + a], roots_[island.first_vector + b],
                           joint.share_a, joint.share_b,
                           mass_scale(island.unit, joint.inverse_mass)};
  const std::span<const JointRow> rows = access.joints.rows(joint.joint);
  const auto add = [&](std::size_t r, bool is_limit) {
    ProximalLock lock;
    if (problem.rows == k_contact_rows || !find_proximal_lock(rows[r], pair, lock)) return;
    const std::size_t lane = problem.rows++;
    joint.rows[lane] = static_cast<std::uint8_t>(r);
    joint.to_impulse[lane] = lock.to_impulse;
    set_lock(lock, lane, problem);
    const auto in_units = [&](std::int64_t speed) {
      return within_row(lock.to_speed.times(speed, 50 - k_row_unit_bits));
    };
    problem.moving[lane] = in_units(access.joints.speed(access.run, joint.joint, r));
    problem.least_change[lane] = in_units(k_least_joint_change);
    if (!is_limit) return;
    problem.normal[lane] = -1;
    problem.bias[lane] = in_units(access.joints.limit_speed(rows[r], pushes_out));
    const std::int64_t held = access.joints.limit_impulse(joint.joint, r);
    problem.held[lane] = problem.held_centre[lane] =
        within_row(lock.to_impulse.reciprocal().times(held, 50 - k_row_unit_bits));
    ++problem.points;
  };
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (rows[r].kind == RowKind::limit) add(r, true);
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (rows[r].kind == RowKind::lock) add(r, false);
  lanes::proximal_kernels().couple(problem);
}

void ProximalSolver::set_lock(const ProximalLock& lock, std::size_t lane, Problem& problem) {
  for (std::size_t i = 0; i < lanes::k_body_words; ++i)
    problem.sides[i][lane] = problem.by_row[lane][i] = lanes::scalar::pack(lock.a[i], lock.b[i]);
  problem.give[lane] = k_lock_give;
  problem.own_part[lane] = raw::round_divide(k_whole << 30, k_whole + k_lock_give);
  problem.weight[lane] = k_whole;
}

void ProximalSolver::give_joints(const JointAccess& access, const Island& island) {
  for (std::uint32_t i = 0; i < island.joints; ++i) {
    const IslandJoint& joint = joints_[island.first_joint + i];
    const Problem& problem = problems_[island.first_problem + island.contacts + i];
    JointSolver::RowImpulses impulses{};
    for (std::size_t lane = 0; lane < problem.rows; ++lane)
      impulses[joint.rows[lane]] = joint.to_impulse[lane].times(
          problem.impulse[lane] - problem.start[lane], island.bits - 50);
    access.joints.give(access.run, joint.joint, impulses);
  }
}

}  // namespace lockstone
