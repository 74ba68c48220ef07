#include "core/dynamics/linkage/cluster/cluster_stages.h"

#include <algorithm>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/rows/cluster_energy.h"
#include "core/dynamics/linkage/rows/joint_drives.h"
#include "core/dynamics/linkage/rows/pulled_links.h"
#include "core/dynamics/linkage/rows/row_motion.h"
#include "core/dynamics/linkage/rows/row_responses.h"

namespace lockstone {
namespace {

// Of iterations over drives and limits before positions move.
constexpr int k_drive_passes = 2;

// A group whose bodies turn by more than 2^-this rad in a substep does not begin with an earlier
// factor; does not go half a substep first, since its energy needs the account.
constexpr int k_stale_turn = 7, k_wild_turn = 3;

// Repeats the impulses of the last substep. Those after it went into the velocities already.
void repeat_impulses(const JointRun& run, LinkedJoint& joint) {
  RowImpulses impulses;
  joint.carried = joint.relaxed;
  for (std::size_t i = 0; i < joint.rows.count; ++i) {
    const JointRow& row = joint.rows.rows[i];
    LKS_ASSERT(row.axis < k_joint_axes);
    if (row.kind == RowKind::drive) {
      impulses[i] = joint.driven[row.axis];
      continue;
    }
    std::int64_t& impulse = joint.locks[row.axis];
    joint.relaxed[row.axis] = 0;
    if (row.kind == RowKind::limit && (row.flipped ? impulse > 0 : impulse < 0)) impulse = 0;
    impulses[i] = row.flipped ? -impulse : impulse;
  }
  std::size_t end = joint.rows.count;
  while (end > 0 && impulses[end - 1] == 0)
    --end;
  if (end > 0) push(run, joint, 0, std::max<std::size_t>(end, joint.rows.locks), impulses);
}

// Whether a body of the group turns by more than 2^-shift rad in a substep.
bool turns_fast(const JointRun& run, const JointSystem& system, const JointGroup& group,
                int shift) {
  LKS_ASSERT(shift > 0 && shift < 32);
  const std::int64_t most = std::int64_t{system.step.substep_rate()} << (32 - shift);  // rad/s, Q32
  return std::ranges::any_of(system.bodies_of(group), [&](std::uint32_t index) {
    const LinkedBody& body = system.bodies[index];
    LKS_ASSERT(body.pushed);
    const Vec3<Velocity> surface = motion_of(body, run.rows[body.solver]).surface;
    std::uint64_t size = 0;
    for (int i = 0; i < 3; ++i)
      size |= magnitude(surface[i].raw);
    return static_cast<std::int64_t>(size) > raw::scale_saturating(most, body.scale);
  });
}

}  // namespace

void ClusterStages::begin(JointCluster& cluster) {
  LKS_ASSERT(!system_.joints_of(cluster).empty());
  const bool only_locks = std::ranges::all_of(
      system_.joints_of(cluster),
      [](const LinkedJoint& joint) { return lockstone::only_locks(*joint.record); });
  for (JointGroup& group : system_.groups_of(cluster))
    group.only_locks = only_locks;
  cluster.moves_first = can_move_first(cluster);
  for (const std::uint32_t index : system_.bodies_of(cluster)) {
    LinkedBody& body = system_.bodies[index];
    body.moves_first = cluster.moves_first;
    body.after = body.pose;
  }
}

void ClusterStages::prepare(const JointRun& run, JointCluster& cluster) {
  LKS_ASSERT(cluster.group_count > 0);
  linearize(system_, cluster);
  for (JointGroup& group : system_.groups_of(cluster))
    group.turns_fast = turns_fast(run, system_, group, k_stale_turn);
  for (LinkedJoint& joint : system_.joints_of(cluster))
    leave_out_far_limits(run, system_.step, joint);
  if (cluster.moves_first && turns_fast(run, system_, system_.groups_of(cluster)[0], k_wild_turn))
    stay(cluster);
  if (cluster.moves_first) move_first(run, cluster);
  account_.open(cluster);
}

void ClusterStages::warm_start(const JointRun& run, JointCluster& cluster) {
  const std::span<const std::uint32_t> bodies = system_.bodies_of(cluster);
  const bool is_last = ++cluster.substep == system_.step.substeps;
  LKS_ASSERT(cluster.substep <= system_.step.substeps);
  if (cluster.moves_first)
    set_rate(cluster, std::int64_t{system_.step.substep_rate()} * (is_last ? 2 : 1));
  account_.begin(run, cluster);
  begin_pushes(run, system_, bodies);
  LoopLocks::forget_impulses(system_.groups_of(cluster)[0], system_.joints_of(cluster));
  for (LinkedJoint& joint : system_.joints_of(cluster))
    repeat_impulses(run, joint);
  account_.limit_warm_start(run, cluster);
  end_pushes(run, system_, bodies);
}

void ClusterStages::solve(const JointRun& run, const JointCluster& cluster) {
  LKS_ASSERT(!system_.groups_of(cluster).empty());
  begin_pushes(run, system_, system_.bodies_of(cluster));
  bool is_solved = false;
  for (int pass = 0; pass < k_drive_passes; ++pass) {
    const bool pushed = push_drives(run, cluster);
    if (is_solved && !pushed) break;
    is_solved = solve_locks(run, cluster, pushed && pass + 1 < k_drive_passes);
  }
  end_pushes(run, system_, system_.bodies_of(cluster));
}

// Returns whether any drive or limit pushed.
bool ClusterStages::push_drives(const JointRun& run, const JointCluster& cluster) {
  const bool motors = !system_.groups_of(cluster)[0].has_solved_loops();
  bool pushed = false;
  for (LinkedJoint& joint : system_.joints_of(cluster)) {
    pushed = solve_drives(run, joint, motors) || pushed;
    pushed = solve_limits(run, system_.step, joint, true) || pushed;
  }
  return pushed;
}

// `again`: drives and limits will push once more. Returns whether locks hold until they do.
bool ClusterStages::solve_locks(const JointRun& run, const JointCluster& cluster, bool again) {
  bool is_solved = false;
  for (JointGroup& group : system_.groups_of(cluster)) {
    is_solved = false;
    LKS_ASSERT(group.count > 0);
    if (!group.is_direct) {
      locks_.close_a_quarter(run, group);
    } else if (again && !system_.is_stiff(group)) {
      locks_.step_positions(run, cluster, group);
    } else {
      locks_.solve_positions(run, cluster, group);
      is_solved = true;
    }
  }
  return is_solved;
}

void ClusterStages::relax(const JointRun& run, const JointCluster& cluster) {
  const std::span<const std::uint32_t> bodies = system_.bodies_of(cluster);
  resist_pulls(run, system_, cluster);
  linearize(system_, cluster);
  begin_pushes(run, system_, bodies);
  for (LinkedJoint& joint : system_.joints_of(cluster))
    solve_springs_later(run, joint);
  locks_.lock_speeds(run, cluster);
  end_pushes(run, system_, bodies);
}

}  // namespace lockstone
