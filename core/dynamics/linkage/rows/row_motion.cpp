#include "core/dynamics/linkage/rows/row_motion.h"

#include <type_traits>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

using lanes::BodyVelocity;

// As below, where a velocity leaves its bounds.
[[gnu::noinline, gnu::cold]] void add_bounded(BodyVelocity& body, const RawVec3& velocity,
                                              const RawVec3& spin) {
  const auto gained = [](std::int64_t x, std::int64_t by) {
    return bounded(bounded(x, k_row_bound) + bounded(by, 2 * k_row_bound), k_row_bound);
  };
  for (std::size_t axis = 0; axis < 3; ++axis) {
    body.velocity[axis] = gained(body.velocity[axis], velocity[axis]);
    body.spin[axis] = gained(body.spin[axis], spin[axis]);
  }
}

// Offset by the bound, a value out of bounds has bit 62 or 63 set.
inline std::uint64_t excess(std::int64_t x) {
  return static_cast<std::uint64_t>(x) + static_cast<std::uint64_t>(k_row_bound);
}

// Adds a change to a body's velocity, within ±k_row_bound.
[[gnu::always_inline]] inline void add_velocity(BodyVelocity& body, const RawVec3& velocity,
                                                const RawVec3& spin) {
  const auto sum = [](std::int64_t x, std::int64_t by) {
    return static_cast<std::int64_t>(static_cast<std::uint64_t>(x) +
                                     static_cast<std::uint64_t>(by));
  };
  RawVec3 next_velocity, next_spin;
  std::uint64_t beyond = 0;
  const auto add = [&](std::size_t axis) {
    next_velocity[axis] = sum(body.velocity[axis], velocity[axis]);
    next_spin[axis] = sum(body.spin[axis], spin[axis]);
    beyond |= excess(body.velocity[axis]) | excess(next_velocity[axis]);
    beyond |= excess(body.spin[axis]) | excess(next_spin[axis]);
  };
  add(0), add(1), add(2);
  if (beyond >> 62 != 0) [[unlikely]]
    return add_bounded(body, velocity, spin);
  body.velocity = next_velocity;
  body.spin = next_spin;
}

// The change between velocities clamped to bounds; contacts may push velocities out of them.
inline std::int64_t gain(std::int64_t before, std::int64_t after) {
  if ((excess(before) | excess(after)) >> 62 == 0) [[likely]]
    return after - before;
  return bounded(after, k_row_bound) - bounded(before, k_row_bound);
}

// The Jacobians of one side of a row.
struct SideA {
  static constexpr std::int64_t k_sign = -1;  // of a row along an axis of the world
  static const RawVec3& linear(const JointRow& row) { return row.linear_a; }
  static const RawVec3& angular(const JointRow& row) { return row.angular_a; }
};
struct SideB {
  static constexpr std::int64_t k_sign = 1;
  static const RawVec3& linear(const JointRow& row) { return row.linear_b; }
  static const RawVec3& angular(const JointRow& row) { return row.angular_b; }
};

struct RowRange {
  std::size_t first, end;
};

// The changes by jumps of the rows of a joint that locks the axes of the world: of the first three,
// row i is along axis i, and its lever is across; others turn the bodies alone.
template <class Side>
void add_point(Side side, std::span<const JointRow> rows, const RowImpulses& jumps, std::size_t end,
               RawVec3& velocity, RawVec3& spin) {
  LKS_ASSERT(end >= 3 && end <= rows.size());
  const RawVec3 &x = side.angular(rows[0]), &y = side.angular(rows[1]), &z = side.angular(rows[2]);
  ProductSum about_x, about_y, about_z;
  about_x.add(y[0], jumps[1]), about_x.add(z[0], jumps[2]);
  about_y.add(z[1], jumps[2]), about_y.add(x[1], jumps[0]);
  about_z.add(x[2], jumps[0]), about_z.add(y[2], jumps[1]);
  const auto move_along = [&](std::size_t i) {
    const std::int64_t along = side.linear(rows[i])[i];
    LKS_ASSERT(along == 0 || along == Side::k_sign * k_one);
    velocity[i] = along == 0 ? 0 : Side::k_sign * jumps[i];  // 0 along a locked axis
  };
  move_along(0), move_along(1), move_along(2);
  for (std::size_t r = 3; r < end; ++r) {
    if (jumps[r] == 0) continue;
    const RawVec3& axis = side.angular(rows[r]);
    about_x.add(axis[0], jumps[r]);
    about_y.add(axis[1], jumps[r]);
    about_z.add(axis[2], jumps[r]);
  }
  spin = {about_x.rounded(30), about_y.rounded(30), about_z.rounded(30)};
}

template <class Side>
[[gnu::noinline]] void add_rows(Side side, std::span<const JointRow> rows, const RowImpulses& jumps,
                                const RowRange& range, RawVec3& velocity, RawVec3& spin) {
  LKS_ASSERT(range.first <= range.end && range.end <= rows.size());
  std::array<ProductSum, 3> along, about;
  for (std::size_t r = range.first; r < range.end; ++r) {
    if (jumps[r] == 0) continue;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (has_linear_parts(rows[r])) along[axis].add(side.linear(rows[r])[axis], jumps[r]);
      about[axis].add(side.angular(rows[r])[axis], jumps[r]);
    }
  }
  for (std::size_t axis = 0; axis < 3; ++axis) {
    velocity[axis] = along[axis].rounded(30);
    spin[axis] = about[axis].rounded(30);
  }
}

}  // namespace

std::int64_t row_speed(const JointRun& run, const LinkedJoint& joint, const JointRow& row) {
  LKS_ASSERT(row.axis < k_joint_axes);
  const BodyVelocity& a = run.rows[joint.solver_a];
  const BodyVelocity& b = run.rows[joint.solver_b];
  ProductSum sum;
  for (std::size_t i = 0; i < 3; ++i) {
    sum.add(row.response_a[i], a.spin[i]);
    sum.add(row.response_b[i], b.spin[i]);
  }
  if (joint.rows.is_point && row.axis < 3) {
    sum.add(row.linear_a[row.axis], a.velocity[row.axis]);
    sum.add(row.linear_b[row.axis], b.velocity[row.axis]);
  } else if (has_linear_parts(row)) {
    for (std::size_t i = 0; i < 3; ++i) {
      sum.add(row.linear_a[i], a.velocity[i]);
      sum.add(row.linear_b[i], b.velocity[i]);
    }
  }
  const std::int64_t speed = sum.rounded(30);
  if (row.kind != RowKind::lock || row.speed == 0) return speed;
  return bounded(speed - bounded(row.speed, k_row_bound), k_row_bound);
}

[[gnu::noinline]] void push(const JointRun& run, const LinkedJoint& joint, std::size_t row,
                            std::int64_t impulse) {
  if (impulse == 0) return;
  RowImpulses impulses;
  impulses[row] = impulse;
  push(run, joint, row, row + 1, impulses);
}

namespace {

template <class Side>
void push_side(const JointRun& run, const LinkedJoint& joint, const RowRange& range,
               const RowImpulses& impulses, std::uint32_t solver, const MassShare& share,
               Side side) {
  LKS_ASSERT(range.first <= range.end && range.end <= joint.rows.rows.size());
  if (share.mantissa == 0) return;
  RowImpulses jumps;  // of the body's own velocity
  const auto find_jumps = [&](auto shift) {
    for (std::size_t r = range.first; r < range.end; ++r)
      jumps[r] = product_rounded(impulses[r], share.mantissa, shift);
  };
  if (share.shift == MassShare::k_shift) [[likely]]
    find_jumps(std::integral_constant<int, MassShare::k_shift>{});
  else
    find_jumps(share.shift);
  RawVec3 velocity, spin;
  if (joint.rows.is_point && range.first == 0 && range.end >= 3)
    add_point(side, joint.rows.rows, jumps, range.end, velocity, spin);
  else
    add_rows(side, joint.rows.rows, jumps, range, velocity, spin);
  add_velocity(run.rows[solver], velocity, spin);
}

}  // namespace

void push(const JointRun& run, const LinkedJoint& joint, std::size_t first, std::size_t end,
          const RowImpulses& impulses) {
  LKS_ASSERT(first <= end && end <= joint.rows.count);
  const RowRange range{first, end};
  push_side(run, joint, range, impulses, joint.solver_a, joint.share_a, SideA{});
  push_side(run, joint, range, impulses, joint.solver_b, joint.share_b, SideB{});
}

void begin_pushes(const JointRun& run, JointSystem& system, std::span<const std::uint32_t> bodies) {
  for (const std::uint32_t index : bodies) {
    LinkedBody& body = system.bodies[index];
    LKS_ASSERT(body.solver < run.rows.size());
    body.unpushed = run.rows[body.solver];
  }
}

void end_pushes(const JointRun& run, const JointSystem& system,
                std::span<const std::uint32_t> bodies) {
  if (run.before.empty()) return;
  LKS_ASSERT(run.before.size() == run.rows.size());
  for (const std::uint32_t index : bodies) {
    const LinkedBody& body = system.bodies[index];
    if (!body.pushed) continue;
    const BodyVelocity& row = run.rows[body.solver];
    RawVec3 velocity, spin;
    for (std::size_t axis = 0; axis < 3; ++axis) {
      velocity[axis] = gain(body.unpushed.velocity[axis], row.velocity[axis]);
      spin[axis] = gain(body.unpushed.spin[axis], row.spin[axis]);
    }
    add_velocity(run.before[body.solver], velocity, spin);
  }
}

}  // namespace lockstone
