#include "core/dynamics/linkage/rows/joint_drives.h"

#include <algorithm>
#include <cstdlib>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/rows/row_motion.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

// A limit is far if the joint stays farther from it than k_near within a tick, at k_haste times its
// present speed: m, Q32, of an angle in radians.
constexpr std::int64_t k_near = std::int64_t{1} << 29;
constexpr int k_haste = 4;

// The number of joints at one of the two bodies, whichever has more.
std::int64_t joints_at_a_body(const JointSystem& system, const LinkedJoint& joint) {
  const auto count = [&](std::uint32_t index) {
    const LinkedBody& body = system.bodies[index];
    return body.pushed ? std::int64_t{body.joint_count} : 0;
  };
  return std::max(count(joint.a), count(joint.b));
}

// A spring of x'' = −ω²·x − 2ζω·x' that the substep resolves pushes half before positions move and
// half after it (Verlet's step, which keeps an undamped amplitude), such that it swings at ω:
// 2 − 2·cos(hω) in place of (hω)². One that it does not resolve pushes by where it will be, before
// positions move (E. Catto, "Soft Constraints", 2011). `soft` blends both; all joints of a body may
// be springs that act together.
void set_spring(std::int64_t rate, std::int64_t joints, const JointAxisRecord& axis,
                JointDrive& drive) {
  LKS_ASSERT(rate > 0 && axis.hertz.raw > 0 && axis.damping_ratio.raw >= 0);
  const std::int64_t hertz = std::min(std::int64_t{axis.hertz.raw}, rate << 18);
  const std::int64_t turn = raw::round_divide(hertz * k_two_pi_q28, rate << 18);  // hω, Q30
  const std::int64_t square = product_rounded(turn, turn, 30);
  const std::int64_t acting = square * std::min<std::int64_t>(joints, 1 << 20);
  const std::int64_t excess = std::clamp((4 * acting - k_one) / 3, std::int64_t{0}, k_one);
  const std::int64_t soft = product_rounded(excess, excess, 30);
  const std::int64_t kept = product_rounded(square, k_one - soft, 30);
  const std::int64_t stiffness = product_rounded(product_rounded(turn, turn, 16), k_one - kept / 12,
                                                 30);  // Q44, of mass per square of time
  const std::int64_t damping = product_rounded(turn, axis.damping_ratio.raw, 19);  // 2ζhω, Q30
  const auto part = [&](std::int64_t share, std::int64_t implicit) -> SpringPart {
    LKS_ASSERT(share >= 0 && share <= k_one);
    const std::int64_t a = product_rounded(damping, share, 30) + implicit;
    const std::int64_t forgets = raw::round_divide(k_one << 24, (k_one + a) >> 6);
    const std::int64_t pushes = product_rounded(product_rounded(stiffness, share, 30), forgets, 30);
    return {product_rounded(pushes, rate, 4), static_cast<std::int32_t>(forgets),
            static_cast<std::int32_t>(share)};
  };
  const std::int64_t later = (k_one - soft) / 2;
  drive.before = part(k_one - later, product_rounded(square, soft, 30));
  drive.after = part(later, 0);
}

bool is_far(const JointRun& run, const TimeStep& step, const LinkedJoint& joint,
            const JointRow& row) {
  const std::int64_t near = row.axis < 3 ? k_near : raw::scale_binary(k_near, joint.exponent);
  if (row.kind != RowKind::limit || row.error <= near) return false;
  const std::int64_t allowed = closing_speed(row.error - near, step.substep_rate());
  return std::abs(row_speed(run, joint, row)) <= allowed / (k_haste * step.substeps);
}

// x times the inverse response of a row.
std::int64_t impulse_for(std::int64_t x, const InverseResponse& inverse) {
  return product_rounded(x, inverse.mantissa, inverse.shift);
}

// The speed that a row's drive asks for, less that which it has.
std::int64_t missing_speed(const JointRun& run, const LinkedJoint& joint, const JointRow& row) {
  LKS_ASSERT(row.kind == RowKind::drive);
  return bounded(row.speed, k_row_bound) - row_speed(run, joint, row);
}

// The change of a spring's impulse.
std::int64_t spring_impulse(const JointRun& run, const LinkedJoint& joint, std::size_t i,
                            bool later) {
  const JointRow& row = joint.rows.rows[i];
  const JointDrive& drive = joint.drives[row.axis];
  const SpringPart& part = later ? drive.after : drive.before;
  LKS_ASSERT(part.forgets >= 0 && part.forgets <= k_one);
  const std::int64_t wanted =
      bounded(product_rounded(missing_speed(run, joint, row), k_one - part.forgets, 30) -
                  bounded(product_rounded(row.error, part.stiffness, 22), k_row_bound),
              k_row_bound);
  const std::int64_t total = later ? joint.driven_later[row.axis] : joint.driven[row.axis];
  return impulse_for(wanted, joint.inverse_responses[i]) - product_rounded(total, part.forgets, 30);
}

}  // namespace

void set_drives(const JointSystem& system, LinkedJoint& joint) {
  const std::int64_t rate = system.step.substep_rate();
  LKS_ASSERT(rate > 0);
  for (std::size_t i = 0; i < k_joint_axes; ++i) {
    const JointAxisRecord& axis = joint.record->axes[i];
    JointDrive& drive = joint.drives[i];
    if (axis.max_effort > 0) {
      const std::int64_t effort = raw::round_divide(axis.max_effort * 64, rate);  // Q26
      const std::int64_t bound =
          scale_saturating(effort, joint.inverse_mass, 24 - (i < 3 ? 0 : joint.exponent));
      drive.bound = std::clamp(bound, std::int64_t{1}, k_row_bound);
    }
    if (axis.is_spring()) set_spring(rate, joints_at_a_body(system, joint), axis, drive);
  }
}

void leave_out_far_limits(const JointRun& run, const TimeStep& step, LinkedJoint& joint) {
  JointRows& rows = joint.rows;
  std::size_t kept = rows.locks;
  for (std::size_t i = rows.locks; i < rows.count; ++i) {
    const JointRow& row = rows.rows[i];
    if (is_far(run, step, joint, row)) {
      joint.far = static_cast<std::uint8_t>(joint.far | 1U << row.axis);
      joint.locks[row.axis] = 0;
      continue;
    }
    if (kept != i) {
      rows.rows[kept] = row;
      joint.inverse_responses[kept] = joint.inverse_responses[i];
    }
    ++kept;
  }
  LKS_ASSERT(kept >= rows.locks && kept <= rows.count);
  rows.count = static_cast<std::uint8_t>(kept);
  joint.holds_a_point = holds_a_point(*joint.record, joint.far);
}

bool solve_drives(const JointRun& run, LinkedJoint& joint, bool motors) {
  bool pushed = false;
  for (std::size_t i = joint.rows.locks; i < joint.rows.count; ++i) {
    const JointRow& row = joint.rows.rows[i];
    if (row.kind != RowKind::drive) continue;
    const JointDrive& drive = joint.drives[row.axis];
    if (!motors && !drive.is_spring()) continue;
    std::int64_t change = 0, bound = drive.bound == 0 ? k_row_bound : drive.bound;
    if (drive.is_spring()) {
      change = spring_impulse(run, joint, i, false);
      bound = product_rounded(bound, drive.before.share, 30);
    } else {
      change = impulse_for(missing_speed(run, joint, row), joint.inverse_responses[i]);
    }
    std::int64_t& total = joint.driven[row.axis];
    LKS_ASSERT(bound >= 0);
    const std::int64_t after = bounded(total + bounded(change, k_row_bound), bound);
    push(run, joint, i, after - total);
    pushed = pushed || after != total;
    total = after;
  }
  return pushed;
}

void solve_springs_later(const JointRun& run, LinkedJoint& joint) {
  for (std::size_t i = joint.rows.locks; i < joint.rows.count; ++i) {
    const JointRow& row = joint.rows.rows[i];
    const JointDrive& drive = joint.drives[row.axis];
    if (row.kind != RowKind::drive || !drive.is_spring()) continue;
    std::int64_t& total = joint.driven_later[row.axis];
    total = 0;
    if (drive.after.share == 0) continue;
    LKS_ASSERT(drive.after.share > 0 && drive.after.share <= 1 << 30);
    const std::int64_t bound = drive.bound == 0 ? k_row_bound : drive.bound;
    total =
        bounded(spring_impulse(run, joint, i, true), product_rounded(bound, drive.after.share, 30));
    push(run, joint, i, total);
  }
}

// A limit that is `error` away may be closed at error / substep; beyond it, it is pushed back.
std::int64_t limit_speed(const TimeStep& step, const JointRow& row, bool positions) {
  LKS_ASSERT(row.kind != RowKind::drive);
  std::int64_t bias = closing_speed(row.error, step.substep_rate());
  if (row.error < 0) bias = positions ? std::max(bias / 4, -k_close_speed / 2) : 0;
  return bounded(bias, k_row_bound);
}

bool solve_limits(const JointRun& run, const TimeStep& step, LinkedJoint& joint, bool positions) {
  bool pushed = false;
  for (std::size_t i = joint.rows.locks; i < joint.rows.count; ++i) {
    const JointRow& row = joint.rows.rows[i];
    if (row.kind != RowKind::limit) continue;
    std::int64_t& stored = joint.locks[row.axis];
    const std::int64_t total = row.flipped ? -stored : stored;
    const std::int64_t miss = row_speed(run, joint, row) + limit_speed(step, row, positions);
    LKS_ASSERT(joint.inverse_responses[i].mantissa >= 0);
    const std::int64_t change = impulse_for(-miss, joint.inverse_responses[i]);
    const std::int64_t after =
        std::clamp(total + bounded(change, k_row_bound), std::int64_t{0}, k_row_bound);
    push(run, joint, i, after - total);
    pushed = pushed || after != total;
    stored = row.flipped ? -after : after;
  }
  return pushed;
}

}  // namespace lockstone
