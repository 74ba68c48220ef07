#include "core/dynamics/linkage/rows/row_responses.h"

#include <algorithm>
#include <bit>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/joint/joint_path.h"
#include "core/math/product_sum.h"
#include "core/math/reciprocal.h"

namespace lockstone {
namespace {

// 1/x of a response in Q30, to multiply a velocity with; 0 of one that is hardly there.
InverseResponse inverse_response(std::int64_t response) {
  if (response < 16) return {};
  const int zeros = std::countl_zero(static_cast<std::uint64_t>(response));
  const std::uint64_t mantissa = reciprocal_q124(static_cast<std::uint64_t>(response) << zeros);
  LKS_ASSERT(mantissa >> 63 == 0);
  return {static_cast<std::int64_t>(mantissa), 60 + 64 - zeros - 30};
}

[[gnu::noinline, gnu::cold]] RawVec3 wide_response_of(const InverseInertia& m, const RawVec3& j) {
  LKS_ASSERT(m.exponent >= 0 && m.exponent < 30);
  const auto row = [&](std::int64_t a, std::int64_t b, std::int64_t c) {
    ProductSum sum;
    sum.add(a, j[0]);
    sum.add(b, j[1]);
    sum.add(c, j[2]);
    return sum.rounded(30 - m.exponent);
  };
  return {row(m.xx, m.xy, m.xz), row(m.xy, m.yy, m.yz), row(m.xz, m.yz, m.zz)};
}

// M·j for a Jacobian.
inline RawVec3 response_of(const InverseInertia& m, const RawVec3& j) {
  LKS_ASSERT(m.xx >= 0 && m.yy >= 0 && m.zz >= 0 && m.exponent >= 0);
  // With |entries| ≤ 2^30 and levers below 2^31 the sums stay below 3·2^61.
  if (((magnitude(j[0]) | magnitude(j[1]) | magnitude(j[2])) >> 31) != 0) [[unlikely]]
    return wide_response_of(m, j);
  const auto row = [&](std::int64_t a, std::int64_t b, std::int64_t c) {
    return raw::round_shift(a * j[0] + b * j[1] + c * j[2], 30 - m.exponent);
  };
  return {row(m.xx, m.xy, m.xz), row(m.xy, m.yy, m.yz), row(m.xz, m.yz, m.zz)};
}

// Along an axis that is locked a body neither moves nor responds.
void clear_locked_axes(const LinkedBody& body, RawVec3& linear) {
  if (!body.pushed || (body.record->locks & k_lock_moving) == 0) return;
  for (int axis = 0; axis < 3; ++axis)
    if (body.record->is_locked(axis)) linear[static_cast<std::size_t>(axis)] = 0;
}

JointPlace place_of(const JointSystem& system, const LinkedJoint& joint, const JointFrames& frames,
                    JointPose LinkedBody::*pose) {
  LKS_ASSERT(joint.a < system.bodies.size() && joint.b < system.bodies.size());
  return {*joint.record,
          frames,
          system.bodies[joint.a].*pose,
          system.bodies[joint.b].*pose,
          system.bodies[joint.a].scale,
          system.bodies[joint.b].scale,
          joint.exponent,
          joint.far,
          joint.holds_a_point,
          joint.turns_locks,
          curve_of(*joint.record, system.assets)};
}

}  // namespace

JointPlace place_now(const JointSystem& system, const LinkedJoint& joint) {
  return place_of(system, joint, joint.frames, &LinkedBody::pose);
}

JointPlace place_ahead(const JointSystem& system, const LinkedJoint& joint, JointFrames& room) {
  if (!joint.turns_locks) return place_of(system, joint, joint.frames, &LinkedBody::after);
  room = frames_of(*joint.record, system.step, std::max(joint.substeps_left - 1, 0));
  return place_of(system, joint, room, &LinkedBody::after);
}

void linearize(const JointSystem& system, LinkedJoint& joint) {
  fill_rows(place_now(system, joint), RowParts::all, joint.rows);
  find_responses(system, joint, joint.rows.count, false);
  const std::int64_t most = raw::round_divide(k_close_way, system.step.substep_rate());
  LKS_ASSERT(joint.rows.locks <= joint.rows.count && most > 0);
  for (std::size_t r = 0; r < joint.rows.locks; ++r) {
    const std::int64_t open = joint.rows.rows[r].error;
    joint.left_open[r] = open - bounded(open, most);
  }
}

void linearize(JointSystem& system, const JointCluster& cluster) {
  LKS_ASSERT(cluster.substep >= 0 && cluster.substep <= system.step.substeps);
  for (LinkedJoint& joint : system.joints_of(cluster)) {
    joint.substeps_left = static_cast<std::uint8_t>(system.step.substeps - cluster.substep);
    if (joint.turns_locks)
      joint.frames = frames_of(*joint.record, system.step, joint.substeps_left);
    linearize(system, joint);
  }
  for (JointGroup& group : system.groups_of(cluster)) {
    group.is_fresh = false;
    group.is_factored = group.is_factored && group.is_direct;
  }
}

void find_responses(const JointSystem& system, LinkedJoint& joint, std::size_t rows, bool ahead) {
  LKS_ASSERT(rows <= joint.rows.count);
  const LinkedBody& a = system.bodies[joint.a];
  const LinkedBody& b = system.bodies[joint.b];
  const InverseInertia& inertia_a = ahead ? a.inertia_ahead : a.inverse_inertia;
  const InverseInertia& inertia_b = ahead ? b.inertia_ahead : b.inverse_inertia;
  for (std::size_t i = 0; i < rows; ++i) {
    JointRow& row = joint.rows.rows[i];
    clear_locked_axes(a, row.linear_a);
    clear_locked_axes(b, row.linear_b);
    row.response_a = response_of(inertia_a, row.angular_a);
    row.response_b = response_of(inertia_b, row.angular_b);
    if (row.kind == RowKind::lock) continue;  // solved by the factor
    std::int64_t response = 0;
    const auto add_side = [&](const LinkedBody& body, const MassShare& share, std::int64_t self) {
      if (body.pushed) response += product_rounded(self, share.mantissa, share.shift);
    };
    add_side(a, joint.share_a, self_response(row.linear_a, row.angular_a, row.response_a));
    add_side(b, joint.share_b, self_response(row.linear_b, row.angular_b, row.response_b));
    joint.inverse_responses[i] = inverse_response(std::min(response, k_product_bound));
  }
}

std::int64_t self_response(const RawVec3& linear, const RawVec3& angular, const RawVec3& response) {
  ProductSum sum;
  for (std::size_t i = 0; i < 3; ++i) {
    sum.add(linear[i], linear[i]);
    sum.add(angular[i], response[i]);
  }
  return sum.rounded(30);
}

}  // namespace lockstone
