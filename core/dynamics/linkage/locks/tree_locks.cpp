#include "core/dynamics/linkage/locks/tree_locks.h"

#include <algorithm>
#include <bit>

#include <lockstone/assert.h>

#include "core/dynamics/joint/joint_numbers.h"
#include "core/dynamics/linkage/rows/row_motion.h"
#include "core/dynamics/linkage/rows/row_responses.h"
#include "core/math/product_sum.h"

namespace lockstone {
namespace {

[[gnu::noinline, gnu::cold]] std::int64_t scaled_wide_response(std::int64_t response,
                                                               std::int32_t inverse_mass,
                                                               int shift) {
  return product_rounded(response, inverse_mass, std::max(shift, 1));
}

// response · inverse mass · 2^-shift, at most 2^-1
inline std::int64_t scaled_response(std::int64_t response, std::int32_t inverse_mass, int shift) {
  if (shift >= 2 && shift <= 62 && magnitude(response) >> 32 == 0) [[likely]]
    return raw::round_shift_any(response * inverse_mass, shift);
  return scaled_wide_response(response, inverse_mass, shift);
}

// x · mass · 2^shift within ±k_row_bound
std::int64_t times_mass(std::int64_t x, BlockFloat mass, int shift) {
  const int right = -shift - mass.exponent;
  if (right >= 1 && right <= 125) return product_rounded(x, mass.mantissa, right);
  return bounded(scale_saturating(x, mass, shift), k_row_bound);
}

std::uint32_t most_locks(const JointRecord& joint) {
  if (has_own_equation(static_cast<JointKind>(joint.kind)) || joint.is(JointKind::distance)) {
    return 1;
  }
  std::uint32_t count = 0;
  for (std::size_t i = 0; i < k_joint_axes; ++i) {
    const JointAxisRecord& axis = joint.axes[i];
    const bool rigid = joint.mode(i) == AxisMode::locked && !axis.is_spring();
    const bool closed = joint.mode(i) == AxisMode::limited && axis.lower == axis.upper;
    count += rigid || closed ? 1 : 0;
  }
  return count;
}

// Finds the powers of two that scale the locks in a factor.
void scale_locks(const JointSystem& system, LinkedJoint& joint) {
  for (std::size_t r = 0; r < joint.rows.locks; ++r) {
    const JointRow& row = joint.rows.rows[r];
    LKS_ASSERT(row.kind == RowKind::lock);
    int most = -250;  // below all: a byte holds half of it
    const auto add_side = [&](const LinkedBody& body, std::int64_t self) {
      if (!body.pushed) return;
      const int width = static_cast<int>(std::bit_width(static_cast<std::uint64_t>(self)));
      most = std::max(most, width + 1 + body.record->inverse_mass_exponent);
    };
    add_side(system.bodies[joint.a], self_response(row.linear_a, row.angular_a, row.response_a));
    add_side(system.bodies[joint.b], self_response(row.linear_b, row.angular_b, row.response_b));
    LKS_ASSERT(most <= 250);
    joint.scales[r] = static_cast<std::int8_t>((most + 2) >> 1);
  }
}

// A pair of joints that share a body: which side of each it is.
struct SharedBody {
  const LinkedBody& body;
  bool is_a_of_p, is_a_of_q;
};

// The responses of the locks of p to impulses on those of q through one body: sums of products of
// Jacobians and responses, scaled as rows of the matrix.
struct SharedRows {
  explicit SharedRows(const SharedBody& shared)
      : inverse_mass(shared.body.record->inverse_mass),
        excess(30 - k_matrix_bits - shared.body.record->inverse_mass_exponent),
        linear_x(shared.is_a_of_p ? &JointRow::linear_a : &JointRow::linear_b),
        linear_y(shared.is_a_of_q ? &JointRow::linear_a : &JointRow::linear_b),
        angular_x(shared.is_a_of_p ? &JointRow::angular_a : &JointRow::angular_b),
        response_y(shared.is_a_of_q ? &JointRow::response_a : &JointRow::response_b) {}

  // Where a row moves bodies so little that its scale leaves no shift, the sum keeps more bits.
  [[nodiscard]] std::int64_t scaled(const ProductSum& sum, int scales) const {
    const int shift = scales + excess;
    if (shift >= 1 && shift <= 120) [[likely]]
      return scaled_response(sum.rounded(30), inverse_mass, shift);
    if (shift > 120) return 0;
    const int more = std::clamp(1 - shift, 0, 29);
    return scaled_response(sum.rounded(30 - more), inverse_mass, shift + more);
  }

  std::int32_t inverse_mass;
  int excess;
  RawVec3 JointDirections::*linear_x;
  RawVec3 JointDirections::*linear_y;
  RawVec3 JointDirections::*angular_x;
  RawVec3 JointRow::*response_y;
};

// Both lock the axes of the world: row i of the first three is along axis i, its lever across;
// others turn the bodies alone. `is_lower`: only as far as the diagonal.
void add_shared_points(const LinkedJoint& p, const LinkedJoint& q, const SharedRows& shared,
                       bool is_lower, std::int64_t* block) {
  const std::size_t columns = q.rows.locks;
  LKS_ASSERT(p.rows.locks >= 3 && columns >= 3);
  for (std::size_t r = 0; r < p.rows.locks; ++r) {
    const JointRow& x = p.rows.rows[r];
    const RawVec3& lever = x.*shared.angular_x;
    const std::size_t i = r % 3, j = (r + 1) % 3, k = (r + 2) % 3;
    LKS_ASSERT(r >= 3 || lever[r] == 0);
    for (std::size_t s = 0; s < (is_lower ? r + 1 : columns); ++s) {
      const JointRow& y = q.rows.rows[s];
      const RawVec3& response = y.*shared.response_y;
      ProductSum sum;
      sum.add(lever[j], response[j]);
      sum.add(lever[k], response[k]);
      if (r >= 3)
        sum.add(lever[i], response[i]);
      else if (r == s)
        sum.add((x.*shared.linear_x)[r], (y.*shared.linear_y)[r]);
      block[r * columns + s] += shared.scaled(sum, p.scales[r] + q.scales[s]);
    }
  }
}

void add_shared(const LinkedJoint& p, const LinkedJoint& q, const SharedBody& body,
                std::int64_t* block) {
  if (!body.body.pushed) return;
  const SharedRows shared(body);
  const bool is_diagonal = &p == &q;
  if (p.rows.is_point && q.rows.is_point)
    return add_shared_points(p, q, shared, is_diagonal, block);
  const std::size_t columns = q.rows.locks;
  LKS_ASSERT(p.rows.locks <= k_joint_axes && columns <= k_joint_axes);
  for (std::size_t r = 0; r < p.rows.locks; ++r) {
    const JointRow& x = p.rows.rows[r];
    for (std::size_t s = 0; s < (is_diagonal ? r + 1 : columns); ++s) {
      const JointRow& y = q.rows.rows[s];
      ProductSum sum;
      for (std::size_t i = 0; i < 3; ++i) {
        sum.add((x.*shared.linear_x)[i], (y.*shared.linear_y)[i]);
        sum.add((x.*shared.angular_x)[i], (y.*shared.response_y)[i]);
      }
      block[r * columns + s] += shared.scaled(sum, p.scales[r] + q.scales[s]);
    }
  }
}

}  // namespace

TreeLocks::TreeLocks(JointSystem& system, std::size_t joint_capacity)
    : system_(system), factor_(joint_capacity) {}

bool TreeLocks::plan(JointGroup& group) {
  const std::span<const std::uint32_t> joints = system_.joints_of(group);
  const auto neighbours = [&](std::uint32_t k, const auto& emit) {
    const AddedJoint& joint = system_.added[joints[k]];
    LKS_ASSERT(joint.place == k);
    for (const std::uint32_t body : {joint.a, joint.b}) {
      if (!system_.bodies[body].pushed) continue;
      for (const std::uint32_t other : system_.joints_at(system_.bodies[body]))
        emit(system_.added[other].place);
    }
  };
  const auto rows = [&](std::uint32_t k) { return most_locks(*system_.added[joints[k]].record); };
  if (!factor_.plan(group.count, neighbours, rows)) return false;
  group.column = factor_.first();
  return true;
}

void TreeLocks::plan_single(JointGroup& group) {
  LKS_ASSERT(group.count == 1);
  const AddedJoint& joint = system_.added[system_.joints_of(group)[0]];
  const auto rows = [&](std::uint32_t) { return most_locks(*joint.record); };
  const bool planned = factor_.plan(
      1, [](std::uint32_t, const auto&) {}, rows);
  LKS_CHECK(planned);
  group.column = factor_.first();
}

// The responses of the locks of p to impulses on those of q, through the bodies that both connect.
void TreeLocks::fill_block(const LinkedJoint& p, const LinkedJoint& q, std::int64_t* block) const {
  const std::span<const LinkedBody> bodies = system_.bodies;
  LKS_ASSERT(p.rows.locks <= k_joint_axes && q.rows.locks <= k_joint_axes);
  std::fill_n(block, p.rows.locks * q.rows.locks, 0);
  if (p.a == q.a) add_shared(p, q, {bodies[p.a], true, true}, block);
  if (p.a == q.b) add_shared(p, q, {bodies[p.a], true, false}, block);
  if (p.b == q.a) add_shared(p, q, {bodies[p.b], false, true}, block);
  if (p.b == q.b) add_shared(p, q, {bodies[p.b], false, false}, block);
  for (std::size_t i = 0; i < p.rows.locks * q.rows.locks; ++i)
    block[i] = bounded(block[i], std::int64_t{1} << k_matrix_bits);
}

void TreeLocks::factor(JointGroup& group) {
  const std::span<JointFactor::Column> columns = factor_.columns(group.column, group.count);
  const std::span<const std::uint32_t> joints = system_.joints_of(group);
  group.exponent = 1000;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    LinkedJoint& joint = system_.joints[joints[k]];
    columns[k].count = static_cast<std::uint32_t>(joint.rows.locks);
    LKS_ASSERT(columns[k].count <= columns[k].rows);
    scale_locks(system_, joint);
    for (std::size_t r = 0; r < joint.rows.locks; ++r)
      group.exponent = std::min<int>(group.exponent, joint.scales[r]);
  }
  factor_.fill_blocks(group.column, group.count,
                      [&](std::uint32_t j, std::uint32_t k, std::int64_t* block) {
                        fill_block(system_.joints[joints[j]], system_.joints[joints[k]], block);
                      });
  (void)factor_.factor(group.column, group.count);
  system_.note_factor(group);
}

// From speeds to the right-hand side of the scaled matrix, of which 46 bits are fraction.
void TreeLocks::scale_errors(const JointGroup& group) {
  for (std::uint32_t k = 0; k < group.count; ++k) {
    const LinkedJoint& joint = system_.joints[system_.joints_of(group)[k]];
    const std::span<std::int64_t> rhs = errors(group, k);
    for (std::size_t r = 0; r < joint.rows.locks; ++r) {
      const int shift = 4 + joint.scales[r] - group.exponent;
      LKS_ASSERT(shift >= 4);
      rhs[r] = raw::round_shift(-rhs[r], std::min(shift, 62));
    }
  }
}

void TreeLocks::solve(const JointRun& run, JointGroup& group, bool positions) {
  if (!system_.has_factor(group)) factor(group);
  scale_errors(group);
  const int lost = factor_.solve(group.column, group.count);
  // Impulses so great that their solution did not fit: light bodies stay within the bounds of
  // velocities when all joints push a little at a time.
  const int pieces = lost / 3;
  for (int i = 0; i < 1 << pieces; ++i)
    apply(run, group, positions, lost - pieces);
}

// The solution, times 2^`shift`.
void TreeLocks::apply(const JointRun& run, const JointGroup& group, bool positions, int shift) {
  const bool later = group.is_direct && !positions;
  for (std::uint32_t k = 0; k < group.count; ++k) {
    LinkedJoint& joint = system_.joints[system_.joints_of(group)[k]];
    const std::span<const std::int64_t> solution = errors(group, k);
    LKS_ASSERT(solution.size() >= joint.rows.locks);
    RowImpulses impulses;
    for (std::size_t r = 0; r < joint.rows.locks; ++r) {
      impulses[r] =
          times_mass(solution[r], joint.inverse_mass, 4 + shift - joint.scales[r] - group.exponent);
      const std::uint8_t axis = joint.rows.rows[r].axis;
      std::int64_t& total = later ? joint.relaxed[axis] : joint.locks[axis];
      total = bounded(total + impulses[r], k_product_bound);
    }
    push(run, joint, 0, joint.rows.locks, impulses);
  }
}

}  // namespace lockstone
