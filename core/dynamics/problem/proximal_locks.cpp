#include "core/dynamics/problem/proximal_locks.h"

#include <algorithm>
#include <bit>
#include <utility>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/math/wide/scalar_lanes.h"

namespace lockstone {
namespace {

// γ, of a row's response to itself: the factor's least eigenvalue, so that rows are its terms as
// they are.
constexpr int k_lock_give_bits = BodyFactor::k_least_bits;

// In further solves the impulses so far count with 2^-this of γ, so that each brings them nearer to
// those of so much less compliance.
constexpr int k_less_give_bits = 6;

// Right-hand sides are below 2^27 units at first; where the solution does not fit in 31 bits, units
// are coarser.
constexpr int k_first_bits = 27, k_fewer_bits = 4, k_least_bits = 7;
constexpr int k_finest_bits = 44;

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
  if (group.unit.mantissa == 0 || is_less(joint.inverse_mass, group.unit))
    group.unit = joint.inverse_mass;
}

std::uint32_t ProximalLocks::end_group(std::uint32_t bodies) {
  Group& group = groups_.back();
  LKS_ASSERT(may_fit(bodies, group.joints));
  if (group.unit.mantissa != 0 && factor_.plan(bodies, pairs_, group.plan)) {
    for (Joint& joint : joints_of(group))
      joint.mass = mass_scale(group.unit, joint.inverse_mass);
    return static_cast<std::uint32_t>(groups_.size() - 1);
  }
  joints_.resize(group.first_joint);
  groups_.pop_back();
  return k_too_large;
}

void ProximalLocks::set_inertia(std::uint32_t group, std::uint32_t body,
                                const InverseInertia& inertia) {
  roots_[groups_[group].plan.first_column + body] = inertia_root(inertia);
}

void ProximalLocks::Joint::set_row(std::size_t row, const ProximalLock& lock) {
  LKS_ASSERT(row < rows.size() && lock.row[6] == 0 && lock.row[7] == 0);
  const auto word_of = [](const RowScale& scale) {
    return lanes::scalar::pack(scale.mantissa, scale.shift);
  };
  rows[row] = lock.row;
  rows[row][6] = word_of(lock.to_speed);
  rows[row][7] = word_of(lock.to_impulse);
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
                           joint.mass};
  LKS_ASSERT(rows.size() <= joint.rows.size());
  joint.count = static_cast<std::uint32_t>(rows.size());
  joint.used = 0;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ProximalLock lock;
    if ((left_out >> i & 1) != 0 || !find_proximal_lock(rows[i], pair, lock)) continue;
    joint.used |= 1U << i;
    joint.set_row(i, lock);
    joint.own[i] = (lock.to_speed * lock.to_impulse).reciprocal();
  }
}

void ProximalLocks::add_to_factor(const Group& group, const Joint& joint) {
  LKS_ASSERT(joint.count <= joint.rows.size());
  const auto diagonal = [&](std::uint32_t body) {
    return body == End::k_unpushed ? nullptr : &factor_.block(factor_.diagonal(group.plan, body));
  };
  lanes::MatrixPlaces places{diagonal(joint.a), diagonal(joint.b), nullptr, false};
  if (places.a != nullptr && places.b != nullptr) {
    const BodyFactor::Place both = factor_.find(group.plan, joint.a, joint.b);
    places.both = &factor_.block(both.block);
    places.a_is_row = both.a_is_row;
  }
  lanes::proximal_kernels().add_rows(joint.rows.data(), joint.used, places);
}

void ProximalLocks::factor(std::uint32_t index) {
  LKS_ASSERT(index < groups_.size());
  const Group& group = groups_[index];
  factor_.reset(group.plan);
  for (const Joint& joint : joints_of(group))
    add_to_factor(group, joint);
  factor_.factor(group.plan);
}

void ProximalLocks::give(std::uint32_t group, std::uint32_t joint,
                         std::span<const std::int64_t> impulses) {
  Joint& on = joints_[groups_[group].first_joint + joint];
  LKS_ASSERT(impulses.size() >= on.count);
  for (std::size_t i = 0; i < on.count; ++i)
    if (impulses[i] != 0 && on.uses(i))
      on.errors[i] += on.own[i].times(impulses[i], k_lock_give_bits + k_less_give_bits);
}

// −Jᵀ·r/γ, times 2^-14. Errors are below 2^27 units, so sums of a joint's rows fit.
void ProximalLocks::add_changes(const Group& group, Joint& joint, int bits) {
  LKS_ASSERT(joint.count <= joint.rows.size());
  for (std::size_t i = 0; i < joint.count; ++i)
    if (joint.uses(i))  // the error, for set_impulses
      joint.impulses[i] = joint.to_speed(i).times(joint.errors[i], 50 - bits);
  BodyVector unmoved{};
  lanes::proximal_kernels().subtract_rows(joint.rows.data(), joint.used, joint.impulses.data(),
                                          change_of(group, joint.a, unmoved),
                                          change_of(group, joint.b, unmoved));
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
void ProximalLocks::set_impulses(const Group& group, Joint& joint, int bits) {
  LKS_ASSERT(joint.count <= joint.rows.size());
  ByRow<std::int64_t> products;  // of rows in use
  BodyVector unmoved{};
  lanes::proximal_kernels().row_products(joint.rows.data(), joint.used,
                                         change_of(group, joint.a, unmoved),
                                         change_of(group, joint.b, unmoved), products.data());
  for (std::size_t i = 0; i < joint.count; ++i) {
    const std::int64_t error = std::exchange(joint.impulses[i], 0);
    if (!joint.uses(i)) continue;
    const std::int64_t left = error * k_one + products[i];
    const std::int64_t impulse = -raw::round_shift(left, 30 - k_lock_give_bits);
    joint.impulses[i] = joint.to_impulse(i).times(impulse, bits - 50);
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
                                  joint.to_speed(i).shift);
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
