#include "core/dynamics/linkage/rows/pulled_links.h"

#include <algorithm>
#include <array>
#include <bit>

#include <lockstone/assert.h>

#include "core/dynamics/body/mass_share.h"
#include "core/dynamics/joint/joint_numbers.h"
#include "core/math/product_sum.h"
#include "core/math/roots.h"

namespace lockstone {
namespace {

// Links are taken to be at most so heavy to turn, m·s².
constexpr std::int64_t k_most_inertia = k_one << 8;

// `jump`: change of the body's velocity by joints at the lever (m, Q20), m/s, Q30.
void add_pull(LinkedBody& body, std::int64_t jump, std::int64_t lever) {
  LKS_ASSERT(jump >= 0 && lever >= 0);
  body.pull = bounded(body.pull + product_rounded(jump, lever, 20 + 2 * body.scale), k_row_bound);
}

// Adds half of a substep's impulses: the other half is that of `relaxed`, or goes before it.
void add_pull(JointSystem& system, const LinkedJoint& joint, bool moves_first) {
  const auto total = [&](std::size_t i) {
    return moves_first ? (joint.locks[i] + joint.carried[i]) / 2
                       : joint.locks[i] + joint.relaxed[i];
  };
  const auto pull =
      static_cast<std::int64_t>(norm(total(0) >> 20, total(1) >> 20, total(2) >> 20));  // Q30
  LKS_ASSERT(pull >= 0);
  const auto add = [&](std::uint32_t body, const MassShare& share, std::int64_t lever) {
    if (share.mantissa == 0) return;
    add_pull(system.bodies[body], product_rounded(pull, share.mantissa, share.shift), lever);
  };
  add(joint.a, joint.share_a, joint.lever_a);
  add(joint.b, joint.share_b, joint.lever_b);
}

// The impulses that the last tick ended with, Q30.
std::int64_t last_pull(const JointRecord& record) {
  const auto part = [&](std::size_t i) {
    return std::int64_t{record.axes[i].impulse.raw} * (1 << 10);
  };
  return static_cast<std::int64_t>(norm(part(0), part(1), part(2)));
}

void add_last_pull(JointSystem& system, const AddedJoint& joint) {
  LinkedBody &a = system.bodies[joint.a], &b = system.bodies[joint.b];
  const std::int32_t share_b =
      share_of_b(a.record->inverse_mass_value(), b.record->inverse_mass_value());
  LKS_ASSERT(share_b >= 0 && share_b <= k_one);
  const auto add = [&](LinkedBody& body, std::int64_t share, const Vec3<Length>& anchor) {
    if (body.pushed) add_pull(body, product_rounded(joint.last_pull, share, 30), size_of(anchor));
  };
  add(a, k_one - share_b, joint.record->anchor_a);
  add(b, share_b, joint.record->anchor_b);
}

// The least inertia with which the step resolves the swing. Some of it grows with the number of
// links that swing against each other.
std::int64_t needed_inertia(const JointSystem& system, const LinkedBody& body) {
  LKS_ASSERT(body.pull >= 0);
  return 2 * raw::round_divide(body.pull, system.step.substep_rate());
}

// The least inertia with which a link swings.
std::int64_t swung_inertia(const LinkedBody& body) {
  const auto& own = body.record->inertia;
  LKS_ASSERT(body.lever_inertia >= 0);
  return min(own.x, min(own.y, own.z)).raw + body.lever_inertia;
}

void resist_pull(const JointRun& run, const JointSystem& system, LinkedBody& body) {
  if (!body.pushed || !body.record->rotates()) return;
  const std::int64_t least = needed_inertia(system, body);
  LKS_ASSERT(least >= 0);
  const std::uint64_t rounded = std::bit_ceil(static_cast<std::uint64_t>(least));
  const std::int64_t swung = swung_inertia(body);
  body.pulled = least > swung / 8;
  set_least_inertia(
      run, body,
      least <= swung ? 0
                     : std::min<std::int64_t>(static_cast<std::int64_t>(rounded), k_most_inertia));
}

void forget_pulls(JointSystem& system) {
  for (LinkedBody& body : system.bodies)
    body.pull = 0;
}

}  // namespace

void note_last_pull(JointSystem& system, AddedJoint& joint) {
  joint.last_pull = last_pull(*joint.record);
  if (joint.last_pull != 0) add_last_pull(system, joint);
}

void find_pulled_links(JointSystem& system) {
  for (std::uint32_t i = 0; i < system.bodies.size(); ++i) {
    LinkedBody& body = system.bodies[i];
    body.lever_inertia = lever_inertia(system, i);
    LKS_ASSERT(body.lever_inertia >= 0);
    body.pulled = body.pushed && body.record->rotates() &&
                  needed_inertia(system, body) > swung_inertia(body) / 8;
  }
}

void resist_pulls(const JointRun& run, JointSystem& system) {
  LKS_ASSERT(system.joints.size() <= system.added.size());
  if (!system.joints.empty()) {  // else all pulls are as they were planned with
    forget_pulls(system);
    for (const LinkedJoint& joint : system.joints)
      add_pull(system, joint, false);
    for (const AddedJoint& joint : system.added)
      if (joint.joint == AddedJoint::k_in_balls) add_last_pull(system, joint);
  }
  for (LinkedBody& body : system.bodies)
    resist_pull(run, system, body);
}

void resist_pulls(const JointRun& run, JointSystem& system, const JointCluster& cluster) {
  for (const std::uint32_t body : system.bodies_of(cluster))
    system.bodies[body].pull = 0;
  for (const LinkedJoint& joint : system.joints_of(cluster))
    add_pull(system, joint, cluster.moves_first);
  for (const std::uint32_t body : system.bodies_of(cluster)) {
    if (system.bodies[body].centred && !cluster.moves_first)
      resist_pull(run, system, system.bodies[body]);
  }
}

std::int64_t lever_inertia(const JointSystem& system, std::uint32_t index) {
  const LinkedBody& body = system.bodies[index];
  if (!body.pushed || body.joint_count < 1 || body.joint_count > 2) return 0;
  std::array<std::int64_t, 3> sum{};
  for (const std::uint32_t i : system.joints_at(body)) {
    const AddedJoint& joint = system.added[i];
    if (!has_world_axes(*joint.record)) return 0;
    const Vec3<Length>& anchor = joint.a == index ? joint.record->anchor_a : joint.record->anchor_b;
    for (int axis = 0; axis < 3; ++axis)
      sum[static_cast<std::size_t>(axis)] += anchor[axis].raw;
  }
  const auto square = [](std::int64_t x) {  // of at most 1024 m
    const std::int64_t within = bounded(x, std::int64_t{1} << 30);
    return within * within;
  };
  const std::int64_t whole = square(sum[0]) + square(sum[1]) + square(sum[2]);  // m², Q40
  LKS_ASSERT(whole >= 0);
  const int shift = Length::frac_bits * 2 - 30 + 2 * body.record->scale_exponent;
  const auto scaled = [&](std::int64_t x, int by) {
    return by >= 0 ? raw::round_shift(x, by) : std::min(x, k_product_bound >> -by) << -by;
  };
  if (body.joint_count == 2) return scaled(whole, shift + 2);
  const AddedJoint& joint = system.added[system.joints_at(body)[0]];
  const bool is_a = joint.a == index;
  const LinkedBody& other = system.bodies[is_a ? joint.b : joint.a];
  if (!other.pushed) return scaled(whole, shift);
  if ((is_a ? joint.record->anchor_b : joint.record->anchor_a) != Vec3<Length>{}) return 0;
  const std::int32_t own =
      share_of_b(other.record->inverse_mass_value(), body.record->inverse_mass_value());
  return product_rounded(scaled(whole, shift), own, 30);
}

}  // namespace lockstone
