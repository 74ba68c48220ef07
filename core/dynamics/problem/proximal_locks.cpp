#include "core/dynamics/problem/proximal_locks.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"

namespace lockstone {
namespace {

// γ, of a row's response to itself: the factor's least eigenvalue, so that rows are its terms as
// they are.
constexpr int k_lock_give_bits = BodyFactor::k_least_bits;

// Right-hand sides are below 2^27 units at first; where the solution does not fit in 31 bits, units
// are coarser.
constexpr int k_first_bits = 27, k_fewer_bits = 4, k_least_bits = 7;
constexpr int k_finest_bits = 44;

// Of a group: sums of the factor have room for the rows of this many.
constexpr std::uint32_t k_most_joints = 512;

// Q30, of vectors that are within ±2^31: |row| ≤ 1, so the sum fits.
std::int64_t row_dot(const RowSide& j, const BodyVector& u) {
  std::int64_t sum = 0;
  for (std::size_t i = 0; i < 6; ++i)
    sum += j[i] * u[i];
  return sum;
}

bool is_heavier(BlockFloat x, BlockFloat y) {
  return x.exponent != y.exponent ? x.exponent < y.exponent : x.mantissa < y.mantissa;
}

}  // namespace

ProximalLocks::ProximalLocks(std::size_t body_capacity, std::size_t joint_capacity)
    : factor_(body_capacity, joint_capacity) {
  groups_.reserve(joint_capacity);
  joints_.reserve(joint_capacity);
  pairs_.reserve(joint_capacity);
  roots_.resize(body_capacity);
  changes_.resize(body_capacity);
}

void ProximalLocks::clear() {
  groups_.clear();
  joints_.clear();
  factor_.clear();
}

void ProximalLocks::begin_group() {
  groups_.emplace_back().first_joint = static_cast<std::uint32_t>(joints_.size());
  pairs_.clear();
}

void ProximalLocks::add_joint(const End& a, const End& b) {
  Group& group = groups_.back();
  Joint& joint = joints_.emplace_back();
  LKS_ASSERT(a.body != b.body);
  ++group.joints;
  joint.a = a.body;
  joint.b = b.body;
  const BlockFloat inverse_a = a.body == End::k_unpushed ? BlockFloat{} : a.inverse_mass;
  const BlockFloat inverse_b = b.body == End::k_unpushed ? BlockFloat{} : b.inverse_mass;
  joint.inverse_mass = lockstone::add(a.inverse_mass, b.inverse_mass);
  if (inverse_a.mantissa != 0) joint.part_a = part_of(ratio(inverse_a, b.inverse_mass).raw);
  if (inverse_b.mantissa != 0) joint.part_b = part_of(ratio(inverse_b, a.inverse_mass).raw);
  if (a.body != End::k_unpushed && b.body != End::k_unpushed) pairs_.emplace_back(a.body, b.body);
  if (group.unit.mantissa == 0 || is_heavier(joint.inverse_mass, group.unit))
    group.unit = joint.inverse_mass;
}

std::uint32_t ProximalLocks::end_group(std::uint32_t bodies) {
  Group& group = groups_.back();
  if (group.unit.mantissa != 0 && group.joints <= k_most_joints &&
      factor_.plan(bodies, pairs_, group.plan))
    return static_cast<std::uint32_t>(groups_.size() - 1);
  joints_.resize(group.first_joint);
  groups_.pop_back();
  return k_too_large;
}

void ProximalLocks::set_inertia(std::uint32_t group, std::uint32_t body,
                                const InverseInertia& inertia) {
  roots_[groups_[group].plan.first_column + body] = inertia_root(inertia);
}

void ProximalLocks::set_rows(std::uint32_t index, std::uint32_t place,
                             std::span<const JointRow> rows, std::uint32_t left_out) {
  static constexpr InertiaRoot k_none{};
  const Group& group = groups_[index];
  Joint& joint = joints_[group.first_joint + place];
  const auto root_of = [&](std::uint32_t body) -> const InertiaRoot& {
    return body == End::k_unpushed ? k_none : roots_[group.plan.first_column + body];
  };
  const ProximalJoint pair{root_of(joint.a), root_of(joint.b), joint.part_a, joint.part_b,
                           mass_scale(group.unit, joint.inverse_mass)};
  LKS_ASSERT(rows.size() <= joint.rows.size());
  joint.count = static_cast<std::uint32_t>(rows.size());
  joint.used = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ProximalLock& lock = joint.rows[i];
    if ((left_out >> i & 1) != 0 || !find_proximal_lock(rows[i], pair, lock)) continue;
    joint.used |= 1U << i;
    joint.own[i] = (lock.to_speed * lock.to_impulse).reciprocal();
  }
}

void ProximalLocks::add_to_factor(const Group& group, const Joint& joint) {
  LKS_ASSERT(joint.count <= joint.rows.size());
  const bool has_a = joint.a != End::k_unpushed, has_b = joint.b != End::k_unpushed;
  const BodyFactor::Place place =
      has_a && has_b ? factor_.find(group.plan, joint.a, joint.b) : BodyFactor::Place{};
  BodyFactor::Rows a, b;
  const auto add = [&] {
    if (has_a) factor_.add(factor_.diagonal(group.plan, joint.a), a, a);
    if (has_b) factor_.add(factor_.diagonal(group.plan, joint.b), b, b);
    if (has_a && has_b) factor_.add(place.block, place.a_is_row ? a : b, place.a_is_row ? b : a);
    a.count = b.count = 0;
  };
  for (std::size_t i = 0; i < joint.count; ++i) {
    if (!joint.uses(i)) continue;
    a.rows[a.count++] = &joint.rows[i].a;
    b.rows[b.count++] = &joint.rows[i].b;
    if (a.count == BodyFactor::k_most_rows) add();
  }
  add();
}

void ProximalLocks::factor(std::uint32_t index) {
  LKS_ASSERT(index < groups_.size());
  const Group& group = groups_[index];
  factor_.reset(group.plan);
  for (const Joint& joint : joints_of(group))
    add_to_factor(group, joint);
  factor_.factor(group.plan);
}

void ProximalLocks::give(std::uint32_t group, std::uint32_t joint, std::size_t row,
                         std::int64_t impulse) {
  Joint& on = joints_[groups_[group].first_joint + joint];
  if (impulse != 0 && on.uses(row))
    on.errors[row] += bounded(on.own[row].times(impulse, k_lock_give_bits), k_row_bound);
}

// −Jᵀ·r/γ, times 2^-14. Errors are below 2^27 units, so sums of a joint's rows fit.
void ProximalLocks::add_changes(const Group& group, Joint& joint, int bits) {
  LKS_ASSERT(joint.count <= joint.rows.size());
  std::array<std::int64_t, 6> a{}, b{};
  for (std::size_t i = 0; i < joint.count; ++i) {
    if (!joint.uses(i)) continue;
    ProximalLock& lock = joint.rows[i];
    const std::int64_t x = lock.to_speed.times(joint.errors[i], 50 - bits);
    lock.impulse = x;  // the error, for set_impulses
    for (std::size_t k = 0; k < 6; ++k) {
      a[k] -= lock.a[k] * x;
      b[k] -= lock.b[k] * x;
    }
  }
  const auto add = [&](std::uint32_t body, const std::array<std::int64_t, 6>& sums) {
    if (body == End::k_unpushed) return;
    BodyVector& change = changes_[group.plan.first_column + body];
    for (std::size_t k = 0; k < 6; ++k)
      change[k] += raw::round_shift(sums[k], 30);
  };
  add(joint.a, a);
  add(joint.b, b);
}

bool ProximalLocks::try_solve(const Group& group, int bits) {
  const std::span<BodyVector> x =
      std::span(changes_).subspan(group.plan.first_column, group.plan.bodies);
  for (BodyVector& each : x)
    each = {};
  for (Joint& joint : joints_of(group))
    add_changes(group, joint, bits);
  return factor_.solve(group.plan, x);
}

// −(r + J·x)/γ.
void ProximalLocks::set_impulses(const Group& group, Joint& joint, int bits) const {
  for (std::size_t i = 0; i < joint.count; ++i) {
    ProximalLock& lock = joint.rows[i];
    LKS_ASSERT(i < joint.rows.size());
    const std::int64_t error = std::exchange(lock.impulse, 0);
    if (!joint.uses(i)) continue;
    std::int64_t left = error * k_one;
    if (joint.a != End::k_unpushed)
      left += row_dot(lock.a, changes_[group.plan.first_column + joint.a]);
    if (joint.b != End::k_unpushed)
      left += row_dot(lock.b, changes_[group.plan.first_column + joint.b]);
    const std::int64_t impulse = -raw::round_shift(left, 30 - k_lock_give_bits);
    lock.impulse = bounded(lock.to_impulse.times(impulse, bits - 50), k_row_bound);
  }
}

// Fraction bits of units in which every error is below 1, at most k_finest_bits.
int ProximalLocks::coarsest_bits(const Group& group) {
  LKS_ASSERT(group.joints != 0);
  int most = 50 - k_finest_bits;
  for (const Joint& joint : joints_of(group))
    for (std::size_t i = 0; i < joint.count; ++i)
      if (joint.uses(i))
        most = std::max(most, static_cast<int>(std::bit_width(magnitude(joint.errors[i]))) + 31 -
                                  joint.rows[i].to_speed.shift);
  return 50 - most;
}

void ProximalLocks::solve(std::uint32_t index) {
  const Group& group = groups_[index];
  const int coarsest = coarsest_bits(group);
  int bits = k_first_bits;
  while (!try_solve(group, coarsest + bits) && bits > k_least_bits)
    bits -= k_fewer_bits;
  for (Joint& joint : joints_of(group))
    set_impulses(group, joint, coarsest + bits);
}

}  // namespace lockstone
