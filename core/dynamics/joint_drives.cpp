// Springs, motors and limits of joints: one by one.

#include <algorithm>
#include <cstdlib>

#include "core/dynamics/joint_numbers.h"
#include "core/dynamics/joint_solver.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

// A limit is far if the joint stays farther from it than k_near within a tick, at k_haste times its
// present speed: m, Q32, of an angle in radians.
constexpr std::int64_t k_near = std::int64_t{1} << 29;
constexpr int k_haste = 4;

}  // namespace

// With ω = 2π·hertz: a1 = 2ζ + hω, bias rate = ω/a1, keep = hω·a1 / (1 + hω·a1). E. Catto, "Soft
// Constraints", GDC 2011.
void JointSolver::set_drives(Joint& joint) const {
  const std::int64_t rate = step_.substep_rate();
  for (std::size_t i = 0; i < k_joint_axes; ++i) {
    const JointAxisRecord& axis = joint.record->axes[i];
    Drive& drive = joint.drives[i];
    if (axis.max_effort > 0) {
      const std::int64_t effort = raw::round_divide(axis.max_effort * 64, rate);  // Q26
      const std::int64_t bound =
          scale_saturating(effort, joint.inverse_mass, 24 - (i < 3 ? 0 : joint.exponent));
      drive.bound = std::clamp(bound, std::int64_t{1}, k_row_bound);
    }
    drive.is_spring = axis.is_spring();
    if (!drive.is_spring) continue;
    const std::int64_t hertz = std::min(std::int64_t{axis.hertz.raw}, rate << 18);
    const std::int64_t turn = raw::round_divide(hertz * k_two_pi_q28, rate << 20);  // hω, Q28
    const std::int64_t a1 = (std::int64_t{axis.damping_ratio.raw} << 9) + turn;
    const std::int64_t a2 = product_rounded(turn, a1, 28);
    const std::int64_t one = std::int64_t{1} << 28;
    drive.keep = static_cast<std::int32_t>(raw::round_divide(a2 << 22, (one + a2) >> 8));
    // rate · hω / a1
    drive.bias_rate = raw::saturate<std::int32_t>(
        raw::round_divide(product_rounded(turn, rate << 20, 1) * 2, std::max<std::int64_t>(a1, 1)));
  }
}

bool JointSolver::is_far(const JointRun& run, const Joint& joint, const JointRow& row) const {
  const std::int64_t near = row.axis < 3 ? k_near : raw::scale_binary(k_near, joint.exponent);
  if (row.kind != RowKind::limit || row.error <= near) return false;
  const std::int64_t allowed = closing_speed(row.error - near, step_.substep_rate());
  return std::abs(speed(run, joint, row)) <= allowed / (k_haste * step_.substeps);
}

// At a tick's beginning: limits that cannot be reached in it push nothing and need no rows.
void JointSolver::leave_out_far(const JointRun& run, Joint& joint) const {
  JointRows& rows = joint.rows;
  std::size_t kept = rows.locks;
  for (std::size_t i = rows.locks; i < rows.count; ++i) {
    const JointRow& row = rows.rows[i];
    if (is_far(run, joint, row)) {
      joint.far = static_cast<std::uint8_t>(joint.far | 1U << row.axis);
      joint.locks[row.axis] = 0;
      continue;
    }
    if (kept != i) rows.rows[kept] = row, joint.solved[kept] = joint.solved[i];
    ++kept;
  }
  rows.count = kept;
  joint.holds_a_point = lockstone::holds_a_point(*joint.record, joint.far);
}

// Returns whether any impulse changed.
bool JointSolver::solve_drives(const JointRun& run, Joint& joint, bool motors) {
  bool pushed = false;
  for (std::size_t i = joint.rows.locks; i < joint.rows.count; ++i) {
    const JointRow& row = joint.rows.rows[i];
    if (row.kind != RowKind::drive) continue;
    const Drive& drive = joint.drives[row.axis];
    if (!motors && !drive.is_spring) continue;
    const Solved& solved = joint.solved[i];
    std::int64_t& total = joint.driven[row.axis];
    std::int64_t target = row.speed;
    if (drive.is_spring) {
      target -= bounded(product_rounded(row.error, drive.bias_rate, 2), k_row_bound);
    }
    const std::int64_t miss = bounded(target, k_row_bound) - speed(run, joint, row);
    std::int64_t change = product_rounded(miss, solved.inverse, solved.shift);
    if (drive.is_spring) {
      const std::int64_t one = std::int64_t{1} << 30;
      change =
          product_rounded(change, drive.keep, 30) - product_rounded(total, one - drive.keep, 30);
    }
    const std::int64_t bound = drive.bound == 0 ? k_row_bound : drive.bound;
    const std::int64_t after = bounded(total + bounded(change, k_row_bound), bound);
    push(run, joint, i, after - total);
    pushed = pushed || after != total;
    total = after;
  }
  return pushed;
}

// A limit that is `error` away may be closed at error / substep; beyond it, it is pushed back.
bool JointSolver::solve_limits(const JointRun& run, Joint& joint, bool positions) {
  bool pushed = false;
  for (std::size_t i = joint.rows.locks; i < joint.rows.count; ++i) {
    const JointRow& row = joint.rows.rows[i];
    if (row.kind != RowKind::limit) continue;
    const Solved& solved = joint.solved[i];
    std::int64_t bias = closing_speed(row.error, step_.substep_rate());
    if (row.error < 0) bias = positions ? std::max(bias / 4, -k_close_speed / 2) : 0;
    std::int64_t& stored = joint.locks[row.axis];
    const std::int64_t total = row.flipped ? -stored : stored;
    const std::int64_t miss = speed(run, joint, row) + bounded(bias, k_row_bound);
    const std::int64_t change = product_rounded(-miss, solved.inverse, solved.shift);
    const std::int64_t after =
        std::clamp(total + bounded(change, k_row_bound), std::int64_t{0}, k_row_bound);
    push(run, joint, i, after - total);
    pushed = pushed || after != total;
    stored = row.flipped ? -after : after;
  }
  return pushed;
}

}  // namespace lockstone
