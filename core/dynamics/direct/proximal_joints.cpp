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
using lanes::ProximalBlock;

// γ of locks and limits over a row's response to itself, 2^-14: the factor's least eigenvalue.
constexpr std::int64_t k_lock_give = std::int64_t{1} << (30 - BodyFactor::k_least_bits);

// A change of speed is none below this, m/s, Q50.
constexpr std::int64_t k_least_joint_change = (std::int64_t{1} << 50) / 10000;

// Rows that have turned by less stay as they were read: 2^-7, Q30.
constexpr std::uint64_t k_far_turned = std::uint64_t{1} << 23;

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

// Whether the rows of a joint are others than those that were read last, or along other directions.
bool has_turned(const IslandJoint& joint, const ProximalBlock& problem,
                std::span<const JointRow> rows) {
  if (joint.row_count != rows.size()) return true;
  for (std::size_t lane = 0; lane < problem.rows; ++lane) {
    const JointDirections &now = rows[joint.rows[lane]], &then = joint.read[lane];
    if (now.kind != then.kind || now.axis != then.axis || now.flipped != then.flipped) return true;
    std::uint64_t turned = 0;
    const auto compare = [&](const RawVec3& x, const RawVec3& y) {
      for (std::size_t i = 0; i < 3; ++i)
        turned |= magnitude(x[i] - y[i]);
    };
    compare(now.linear_a, then.linear_a);
    compare(now.linear_b, then.linear_b);
    compare(now.angular_a, then.angular_a);
    compare(now.angular_b, then.angular_b);
    if (turned >= k_far_turned) return true;
  }
  return false;
}

void set_lock(const ProximalLock& lock, std::size_t lane, ProximalBlock& problem) {
  for (std::size_t i = 0; i < lanes::k_body_words; ++i)
    problem.sides[i][lane] = problem.by_row[lane][i] = lanes::scalar::pack(lock.a[i], lock.b[i]);
  problem.give[lane] = k_lock_give;
  problem.own_part[lane] = raw::round_divide(k_whole << 30, k_whole + k_lock_give);
  problem.weight[lane] = k_whole;
}

// Reads the rows of a joint: those of its limits, then those of its locks.
void read_joint(std::span<const JointRow> rows, const ProximalJoint& pair, IslandJoint& joint,
                ProximalBlock& problem) {
  const std::uint32_t a = problem.a, b = problem.b;
  problem = {};
  problem.a = a;
  problem.b = b;
  problem.has_locks = true;
  joint.row_count = rows.size();
  const auto add = [&](std::size_t r) {
    ProximalLock lock;
    if (problem.rows == k_contact_rows || !find_proximal_lock(rows[r], pair, lock)) return;
    const std::size_t lane = problem.rows++;
    joint.rows[lane] = static_cast<std::uint8_t>(r);
    joint.read[lane] = rows[r];
    joint.to_speed[lane] = lock.to_speed;
    joint.to_impulse[lane] = lock.to_impulse;
    set_lock(lock, lane, problem);
    problem.least_change[lane] =
        within_row(lock.to_speed.times(k_least_joint_change, 50 - k_row_unit_bits));
    if (rows[r].kind != RowKind::limit) return;
    problem.normal[lane] = -1;
    ++problem.points;
  };
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (rows[r].kind == RowKind::limit) add(r);
  for (std::size_t r = 0; r < rows.size(); ++r)
    if (rows[r].kind == RowKind::lock) add(r);
  lanes::proximal_kernels().couple(problem);
}

// The speeds of a joint's rows, and how far its limits are.
void see_joint(const JointAccess& access, const IslandJoint& joint, ProximalBlock& problem,
               bool pushes_out) {
  const std::span<const JointRow> rows = access.joints.rows(joint.joint);
  for (std::size_t lane = 0; lane < problem.rows; ++lane) {
    const auto in_units = [&](std::int64_t speed) {
      return within_row(joint.to_speed[lane].times(speed, 50 - k_row_unit_bits));
    };
    const std::size_t r = joint.rows[lane];
    problem.moving[lane] = in_units(access.joints.speed(access.run, joint.joint, r));
    if (lane >= problem.points) continue;
    problem.bias[lane] = in_units(access.joints.limit_speed(rows[r], pushes_out));
    const std::int64_t held = access.joints.limit_impulse(joint.joint, r);
    problem.held[lane] = problem.held_centre[lane] =
        within_row(joint.to_impulse[lane].reciprocal().times(held, 50 - k_row_unit_bits));
  }
}

}  // namespace

// Contacts' rows stay for the tick, and so does the inertia of the bodies that have any.
void ProximalSolver::see_inertia(const ContactRun& run, const Island& island) {
  for (std::uint32_t k = 0; k < island.bodies; ++k) {
    const std::uint32_t body = bodies_[island.first_body + k];
    if (body >= first_free_)
      roots_[island.first_vector + k] = inertia_root(run.bodies[body].inverse_inertia);
  }
}

// How bodies move now, as all rows see it.
void ProximalSolver::see_bodies(const ContactRun& run, const Island& island) {
  const std::span<BodyVector> motions = of(changes_, island);
  for (std::uint32_t k = 0; k < island.bodies; ++k) {
    const std::uint32_t body = bodies_[island.first_body + k];
    motions[k] = motion_of(run.rows[body], roots_[island.first_vector + k],
                           mass_scale(island.unit, run.bodies[body].inverse_mass));
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

// Joints have pushed the bodies since the last phase, and turn with them. Rows and factor are kept
// while no joint's rows have turned far.
void ProximalSolver::see_joints(const ContactRun& run, const JointAccess& joints, Island& island,
                                bool pushes_out) {
  const std::span<IslandJoint> all = std::span(joints_).subspan(island.first_joint, island.joints);
  const std::span<Problem> problems = problems_of(island).subspan(island.contacts);
  const bool reads = std::ranges::any_of(all, [&](const IslandJoint& joint) {
    return has_turned(joint, problems[static_cast<std::size_t>(&joint - all.data())],
                      joints.joints.rows(joint.joint));
  });
  if (reads) see_inertia(run, island);
  see_bodies(run, island);
  for (std::uint32_t i = 0; i < island.contacts; ++i) {
    const ProximalContact& contact = contacts_[island.first_contact + i];
    Problem& problem = problems_[island.first_problem + i];
    for (std::size_t r = 0; r < contact.rows; ++r)
      problem.moving[r] = within_row(contact.all[r].carried + seen_speed(island, problem, r));
  }
  for (std::uint32_t i = 0; i < island.joints; ++i) {
    if (reads) {
      const ProximalJoint pair{roots_[island.first_vector + problems[i].a],
                               roots_[island.first_vector + problems[i].b], all[i].part_a,
                               all[i].part_b, mass_scale(island.unit, all[i].inverse_mass)};
      read_joint(joints.joints.rows(all[i].joint), pair, all[i], problems[i]);
    }
    see_joint(joints, all[i], problems[i], pushes_out);
  }
  if (reads) island.is_factored = island.was_factored = false;
}

void ProximalSolver::give_joints(const JointAccess& access, const Island& island) {
  for (std::uint32_t i = 0; i < island.joints; ++i) {
    const IslandJoint& joint = joints_[island.first_joint + i];
    const Problem& problem = problems_[island.first_problem + island.contacts + i];
    RowImpulses impulses{};
    for (std::size_t lane = 0; lane < problem.rows; ++lane)
      impulses[joint.rows[lane]] = joint.to_impulse[lane].times(
          problem.impulse[lane] - problem.start[lane], island.bits - 50);
    access.joints.give(access.run, joint.joint, impulses);
  }
}

}  // namespace lockstone
