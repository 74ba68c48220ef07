#include "core/dynamics/direct/joint_phases.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/contact/block_words.h"
#include "core/dynamics/problem/proximal_words.h"

namespace lockstone::joint_phases {
namespace {

using namespace proximal;
using lanes::ProximalBlock;
using Problem = lanes::ProximalBlock;

// γ of locks and limits over a row's response to itself, 2^-14: the factor's least eigenvalue.
constexpr std::int64_t k_lock_give = std::int64_t{1} << (30 - BodyFactor::k_least_bits);

// A change of speed is none below this, m/s, Q50.
constexpr std::int64_t k_least_joint_change = (std::int64_t{1} << 50) / 10000;

// Rows that have turned by less stay as they were read: 2^-7, Q30.
constexpr std::uint64_t k_far_turned = std::uint64_t{1} << 23;

// Whether the rows of a joint are others than those that were read last, or along other directions.
bool has_turned(const IslandJoint& joint, const ProximalBlock& problem,
                std::span<const JointRow> rows) {
  if (joint.row_count != rows.size()) return true;
  LKS_ASSERT(problem.rows <= k_contact_rows && joint.row_count <= k_max_joint_rows);
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
    problem.sides[i][lane] = lock.row[i];
  problem.by_row[lane] = lock.row;
  problem.give[lane] = k_lock_give;
  problem.own_part[lane] = raw::round_divide(k_whole << 30, k_whole + k_lock_give);
  problem.weight[lane] = k_whole;
}

// Reads the rows of a joint: those of its limits, then those of its locks.
void read_joint(std::span<const JointRow> rows, const ProximalJoint& pair, IslandJoint& joint,
                ProximalBlock& problem) {
  LKS_ASSERT(rows.size() <= k_max_joint_rows);
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
  LKS_ASSERT(problem.points <= problem.rows && problem.rows <= k_contact_rows);
  lanes::proximal_kernels().couple(problem);
}

// The speeds of a joint's rows, and how far its limits are.
void measure_joint(const JointAccess& access, const IslandJoint& joint, ProximalBlock& problem,
                   bool pushes_out) {
  const std::span<const JointRow> rows = access.joints.rows(joint.joint);
  for (std::size_t lane = 0; lane < problem.rows; ++lane) {
    const auto in_units = [&](std::int64_t speed) {
      return within_row(joint.to_speed[lane].times(speed, 50 - k_row_unit_bits));
    };
    const std::size_t r = joint.rows[lane];
    LKS_ASSERT(r < rows.size());
    problem.moving[lane] = in_units(access.joints.speed(access.run, joint.joint, r));
    if (lane >= problem.points) continue;
    problem.bias[lane] = in_units(access.joints.limit_speed(rows[r], pushes_out));
    LKS_ASSERT(rows[r].kind == RowKind::limit);
    const std::int64_t held = access.joints.limit_impulse(joint.joint, r);
    problem.held[lane] = problem.held_centre[lane] =
        within_row(joint.to_impulse[lane].reciprocal().times(held, 50 - k_row_unit_bits));
  }
}

// Contacts' rows stay for the tick, and so does the inertia of the bodies that have any.
void find_free_roots(const ContactRun& run, const IslandView& island, std::uint32_t first_free) {
  for (std::size_t k = 0; k < island.bodies.size(); ++k) {
    const std::uint32_t body = island.bodies[k];
    if (body >= first_free) island.roots[k] = inertia_root(run.bodies[body].inverse_inertia);
  }
}

}  // namespace

void update(const ContactRun& run, const JointAccess& access, const IslandView& island,
            std::uint32_t first_free, bool pushes_out) {
  const std::span<IslandJoint> joints = island.joints;
  const std::span<Problem> problems = island.joint_problems();
  LKS_ASSERT(problems.size() == joints.size());
  bool reads = false;
  for (std::size_t i = 0; i < joints.size() && !reads; ++i)
    reads = has_turned(joints[i], problems[i], access.joints.rows(joints[i].joint));
  if (reads) find_free_roots(run, island, first_free);
  for (std::size_t i = 0; i < joints.size(); ++i) {
    if (reads) {
      const ProximalJoint pair{island.roots[problems[i].a], island.roots[problems[i].b],
                               joints[i].part_a, joints[i].part_b, joints[i].mass};
      read_joint(access.joints.rows(joints[i].joint), pair, joints[i], problems[i]);
    }
    measure_joint(access, joints[i], problems[i], pushes_out);
  }
  if (reads) island.state.drop_factor();
}

void give(const JointAccess& access, const IslandView& island) {
  const std::span<const Problem> problems = island.joint_problems();
  LKS_ASSERT(problems.size() == island.joints.size());
  for (std::size_t i = 0; i < island.joints.size(); ++i) {
    const IslandJoint& joint = island.joints[i];
    const Problem& problem = problems[i];
    RowImpulses impulses{};
    for (std::size_t lane = 0; lane < problem.rows; ++lane)
      impulses[joint.rows[lane]] = joint.to_impulse[lane].times(
          problem.impulse[lane] - problem.start[lane], island.state.bits - 50);
    access.joints.give(access.run, joint.joint, impulses);
  }
}

}  // namespace lockstone::joint_phases
